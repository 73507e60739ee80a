//! What a picture shows beside colour: the surface in each of its pixels, and pictures of its properties.

mod quantity;
mod redrawn;
mod surfaces;

pub use quantity::{Quantity, QuantityImage, QuantityValues, take_quantities};
pub(crate) use surfaces::world_from_model;
pub use surfaces::{SurfacePoint, Surfaces, pick};

//! The surface in each pixel of a picture, and pictures of its properties.

mod quantity;
mod redrawn;
mod surfaces;

use bevy_ecs::prelude::World;
use halfway_frame::error::RenderError;

pub use quantity::{Quantity, QuantityImage, QuantityValues, take_quantities};
pub(crate) use surfaces::{SeenPlane, no_camera, world_from_model};
pub use surfaces::{SurfacePoint, Surfaces, pick};

/// How much of the background is seen in each pixel of the newest frame, row by row from the top.
///
/// # Errors
/// Those of [`Surfaces::take`].
pub(crate) fn background_shares(world: &mut World) -> Result<Vec<f32>, RenderError> {
    let drawn = redrawn::draw(world, redrawn::Shows::Background, redrawn::Taken::InOneFrame)?;
    Ok(drawn.pixels().map(|pixel| pixel.0[0]).collect())
}

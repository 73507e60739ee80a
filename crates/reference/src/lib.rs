//! The judge: the scene that a renderer draws, drawn in f64 on the CPU, and how far a picture is from it.
//!
//! [`Oracle`] takes the entities of a world (meshes, lights, materials, one camera) and says what each pixel should be.
//! It shares components and the equations of `halfway_lighting` with a renderer, and none of its shading code.

// Powers and the functions of angles only by the door in `halfway_lighting::equations`: see clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod image;
mod interpolation;
pub mod metrics;
mod oracle;
mod surface;

pub use image::Image;
pub use interpolation::{Interpolation, PolygonCorner};
pub use oracle::{ColorRange, Mode, Nearest, Oracle, OracleError, Possible, Seen, Stopped};

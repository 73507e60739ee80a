#![doc = include_str!("../README.md")]
// Powers and the functions of angles are called only through `halfway_lighting::equations`: see clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod explain;
mod image;
mod interpolation;
pub mod marking;
pub mod metrics;
pub mod mistakes;
mod oracle;
mod surface;

pub use image::Image;
pub use interpolation::{Interpolation, PolygonCorner};
pub use oracle::{ColorRange, Mode, Nearest, Oracle, OracleError, Possible, Probe, Shows, Stopped};

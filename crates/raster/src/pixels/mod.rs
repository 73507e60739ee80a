//! Pixels that triangles cover.

pub(crate) mod clip;
pub(crate) mod cover;
pub(crate) mod four;
pub(crate) mod hidden;
pub(crate) mod look;
pub(crate) mod mapped_pixels;

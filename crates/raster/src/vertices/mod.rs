//! Vertices, placed on the picture.

pub(crate) mod lane_triangles;
pub(crate) mod placed;
pub(crate) mod screen;
pub(crate) mod transform;

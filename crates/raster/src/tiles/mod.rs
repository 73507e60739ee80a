//! Tiles of the picture, and the triangles that each has.

pub(crate) mod bands;
pub(crate) mod bins;
pub(crate) mod draw;

//! Triangles, set up for coverage and interpolation.

pub(crate) mod faces;
pub(crate) mod mapped;
pub(crate) mod mapped_vertices;
pub(crate) mod planes;
pub(crate) mod samples;
pub(crate) mod setup;

//! Meshes as they are drawn: in patches, which are culled one by one, have light lists of their own, and may be coarser
//! than the mesh.

pub(crate) mod meshes;
pub(crate) mod outlines;
pub(crate) mod patches;
pub(crate) mod shape;
pub(crate) mod workshop;

//! Meshes as they are drawn: in patches, which are culled one by one, have light lists of their own, and may be coarser
//! than the mesh.

pub mod meshes;
pub mod outlines;
pub mod patches;
pub mod shape;
pub mod workshop;

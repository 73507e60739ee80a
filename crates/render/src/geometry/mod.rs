//! Meshes as they are drawn: in patches, which are culled one by one and have light lists of their own.

pub(crate) mod meshes;
pub(crate) mod outlines;
pub(crate) mod patches;
pub(crate) mod shape;

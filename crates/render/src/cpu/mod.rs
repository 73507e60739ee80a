//! How the CPU draws batches: meshes are cut into pieces, the frame's records become a pass, and the pass is drawn.

pub(crate) mod draw;
pub(crate) mod meshes;
pub(crate) mod pass;

//! How wgpu draws batches: what draws read is uploaded, and the pass is encoded, submitted and presented.

pub(crate) mod flat;
pub(crate) mod maps;
pub(crate) mod meshes;
pub(crate) mod pass;
pub(crate) mod placings;
pub(crate) mod surroundings;
pub(crate) mod upload;

//! Draws batches with wgpu: uploads the data of draws, and encodes, submits and presents the passes.

pub(crate) mod flat;
pub(crate) mod maps;
pub(crate) mod meshes;
pub(crate) mod pass;
pub(crate) mod placings;
pub(crate) mod surroundings;
pub(crate) mod upload;

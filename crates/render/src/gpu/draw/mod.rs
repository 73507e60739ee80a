//! The data of draws, uploaded to the GPU: buffers, images and the environment.

pub(crate) mod flat;
pub(crate) mod maps;
pub(crate) mod meshes;
pub(crate) mod placings;
pub(crate) mod surroundings;
pub(crate) mod upload;

//! Visible objects become draws: patches with their materials and light lists, sorted, instanced, and put together.

pub mod backend;
pub mod batches;
pub mod drawn_meshes;
pub mod draws;
pub mod ignored;
pub mod key;
pub(crate) mod lit_looks;
pub mod lit_patches;
pub mod lit_runs;
pub mod object;
pub mod shown_objects;
pub mod table;
mod twins;

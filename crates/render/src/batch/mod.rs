//! Visible objects become draws: patches with their materials and light lists, sorted, instanced, and put together.

pub(crate) mod backend;
pub(crate) mod batches;
pub(crate) mod drawn_meshes;
pub(crate) mod draws;
pub(crate) mod ignored;
pub(crate) mod key;
pub(crate) mod lit_patches;
pub(crate) mod lit_runs;
pub(crate) mod object;
mod shown_objects;
pub(crate) mod table;

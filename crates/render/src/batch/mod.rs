//! What is seen becomes draws: patches with their materials and light lists, sorted, instanced, and put together.

pub(crate) mod backend;
pub(crate) mod batches;
pub(crate) mod choosers;
mod clusters;
pub(crate) mod drawn_meshes;
pub(crate) mod draws;
pub(crate) mod false_colors;
pub(crate) mod ignored;
pub(crate) mod key;
mod listed;
pub(crate) mod lit_object;
pub(crate) mod lit_patches;
pub(crate) mod lit_runs;
pub(crate) mod object;
pub(crate) mod painted;
mod pays;
mod shown_objects;
pub(crate) mod sources;
pub(crate) mod table;
mod unlisted;

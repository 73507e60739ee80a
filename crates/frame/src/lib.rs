//! The frame: a world of entities becomes plain data that anything can draw.
//!
//! Systems validate the camera, select what the frustum sees, compose matrices, lay meshes out in patches, gather the
//! lights and list those of each patch, and sort everything into draws. The result is [`LitPatches`](batch::lit_patches::LitPatches) and
//! [`Batches`](batch::batches::Batches). Nothing here knows wgpu, a rasterizer or a target: a drawer implements
//! [`Backend`](batch::backend::Backend), and `halfway_render` has two.

pub mod batch;
pub mod error;
pub mod geometry;
pub mod lights;
pub mod mean;
pub mod passes;
mod phases;
mod plugin;
pub mod report;
pub mod sets;
pub mod times;
pub mod values;
pub mod view;
pub mod why_empty;

pub use plugin::{FramePlugin, ReadCamera, add_backend};

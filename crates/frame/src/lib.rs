#![doc = include_str!("../README.md")]
//!
//! Systems validate the camera, select what the frustum sees, compose matrices, lay meshes out in patches, gather the
//! lights, list those of each patch, and sort everything into draws: [`LitPatches`](batch::lit_patches::LitPatches) and
//! [`Batches`](batch::batches::Batches). A drawer implements [`Backend`](batch::backend::Backend); `halfway_render` has
//! two.

pub mod batch;
mod camera_frame;
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

pub use camera_frame::CameraFrame;
pub use plugin::{FramePlugin, FurtherCamera, ReadCamera, add_backend, add_further_camera};

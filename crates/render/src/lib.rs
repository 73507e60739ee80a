//! How halfway draws: WGSL, pipelines, passes and targets on wgpu.
//!
//! [`RenderPlugin`] adds the way of a frame, [`RenderSet`] by [`RenderSet`], to a schedule of any
//! `bevy_app` App. The target is a texture ([`Headless`]) unless a window brings a surface
//! ([`SurfaceTarget`]). [`FrameReport`] counts what a frame did and holds what it could not do;
//! [`FrameTimes`] says where its time went on the CPU, and [`GpuTimer`] how much of it the GPU took.

mod batch;
mod compile;
mod detail;
mod draw;
mod draws;
mod error;
mod flat;
mod geometry;
mod gpu;
mod lights;
mod lists;
mod matrices;
mod object;
mod patches;
mod picture;
mod pipeline;
mod pipelines;
mod plugin;
mod records;
mod report;
mod shader;
mod table;
mod target;
mod terms;
mod timing;
mod upload;
mod view;
mod workshop;

pub use compile::Compile;
pub use detail::LevelsOfDetail;
pub use error::RenderError;
pub use gpu::Gpu;
pub use lights::Lights;
pub use matrices::{ModelView, NormalMatrix, Visible, normal_matrix};
pub use picture::{PendingPicture, Picture, render_picture};
pub use plugin::{RenderPlugin, RenderSet};
pub use report::FrameReport;
pub use target::{Headless, Pixels, SurfaceLost, SurfaceTarget};
pub use terms::Chosen;
pub use timing::{FrameTimes, GpuTimer, SetTimes};
pub use view::{Projection, View};
/// The wgpu that the renderer speaks; surfaces are made with it.
pub use wgpu;

//! How halfway draws: batches, and what draws them, wgpu by its shaders or the CPU without a driver.
//!
//! [`RenderPlugin`] adds the way of a frame, [`RenderSet`] by [`RenderSet`], to a schedule of any
//! `bevy_app` App. The target is a texture ([`Headless`]) unless a window brings a surface
//! ([`SurfaceTarget`]) or an engine a texture of its own ([`TextureTarget`]). [`FrameReport`] counts what a frame did
//! and holds what it could not do;
//! [`FrameTimes`] says where its time went on the CPU, and [`GpuTimer`] how much of it the GPU took.

mod batch;
mod cpu;
mod device;
mod draw;
mod error;
mod frame;
mod geometry;
mod lights;
mod pipelines;
mod plugin;
mod shaders;
mod target;
mod view;

pub use device::adapter::Adapter;
pub use device::choice::AdapterChoice;
pub use device::cpu::Cpu;
pub use device::gpu::Gpu;
pub use device::gpu_timer::GpuTimer;
pub use draw::pass::encode_frame;
pub use error::RenderError;
pub use frame::report::FrameReport;
pub use frame::sets::RenderSet;
pub use frame::times::{FrameTimes, SetTimes};
pub use lights::gather::Lights;
pub use lights::terms::Chosen;
pub use pipelines::compile::Compile;
pub use plugin::RenderPlugin;
pub use target::canvas::{Canvas, CanvasTarget};
pub use target::format::{Picture, Pixels};
pub use target::frame::Headless;
pub use target::picture::{PendingPicture, render_picture};
pub use target::surface::{SurfaceLost, SurfaceTarget};
pub use target::texture::TextureTarget;
pub use view::camera::View;
pub use view::matrices::{ModelView, NormalMatrix, Visible, normal_matrix};
/// The wgpu that the renderer speaks; surfaces are made with it.
pub use wgpu;

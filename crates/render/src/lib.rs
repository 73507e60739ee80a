#![doc = include_str!("../README.md")]
//!
//! [`RenderPlugin`] adds the stages of a frame, [`RenderSet`] by [`RenderSet`], to a schedule of any `bevy_app` App.
//! The target is a texture ([`Headless`]) unless a window brings a surface ([`SurfaceTarget`]) or an engine a texture
//! of its own ([`TextureTarget`]). [`FrameReport`] counts the work of a frame and holds its errors; [`FrameTimes`] has
//! its CPU times, and [`GpuTimer`] its GPU time.

mod adapter;
mod background;
mod choice;
mod cpu;
mod drawers;
mod finished_window;
#[cfg(feature = "wgpu")]
mod gpu;
mod has_lines;
mod headless;
mod jitter;
mod legend;
mod lines;
mod logged;
mod pending;
mod picture;
mod plugin;
mod quantities;
mod replaced;
mod taken;
mod views;
mod window_picture;

pub use adapter::Adapter;
pub use background::{draw_background, draw_kept};
pub use choice::AdapterChoice;
pub use cpu::canvas::{Canvas, CanvasTarget};
pub use cpu::device::Cpu;
#[cfg(feature = "wgpu")]
pub use gpu::device::Gpu;
#[cfg(feature = "wgpu")]
pub use gpu::passes::encode::encode_frame;
#[cfg(feature = "wgpu")]
pub use gpu::passes::over::{AddOverPass, OverPass, OverTarget, OverView};
#[cfg(feature = "wgpu")]
pub use gpu::pipelines::compile::Compile;
#[cfg(feature = "wgpu")]
pub use gpu::surface::{SurfaceLost, SurfaceTarget};
#[cfg(feature = "wgpu")]
pub use gpu::texture::TextureTarget;
#[cfg(feature = "wgpu")]
pub use gpu::timer::GpuTimer;
#[cfg(feature = "wgpu")]
pub use gpu::window_pass::{DrawOverWindow, WindowPass};
pub use halfway_frame::error::RenderError;
pub use halfway_frame::lights::gather::Lights;
pub use halfway_frame::passes::{Pass, PassCounts, Phase};
pub use halfway_frame::report::FrameReport;
pub use halfway_frame::sets::RenderSet;
pub use halfway_frame::times::{FrameTimes, SetTimes};
pub use halfway_frame::values::DrawsOnce;
pub use halfway_frame::view::camera::View;
pub use halfway_frame::view::matrices::{ModelView, NormalMatrix, normal_matrix};
pub use halfway_frame::view::select::Visible;
pub use halfway_frame::why_empty::{EmptyReason, why_empty};
pub use halfway_lighting::{Legend, Load};
pub use has_lines::has_lines;
pub use headless::Headless;
pub use legend::draw_legend;
pub use lines::draw_lines;
pub use pending::PendingPicture;
pub use picture::{Picture, Pixels};
pub use plugin::RenderPlugin;
pub use quantities::{Quantity, QuantityImage, QuantityValues, SurfacePoint, Surfaces, pick, take_quantities};
pub use taken::{render_picture, take_picture};
/// The renderer's version of wgpu, which surfaces have to use.
#[cfg(feature = "wgpu")]
pub use wgpu;
pub use window_picture::WindowPicture;

#![doc = include_str!("../README.md")]

mod buffer;
mod display;
mod error;
mod input;
mod keys;
mod open;
mod orbit;
mod orbit_camera;
mod overlay;
mod plugin;
mod problems;
mod runner;
mod short_numbers;
mod title;
mod viewer_keys;

pub use display::has_display;
pub use open::WinitWindow;
pub use orbit::{Orbit, PITCH_LIMIT};
pub use orbit_camera::{DragArea, OrbitCamera, OrbitCameraPlugin, Pointer};
pub use overlay::{Overlay, WindowOverlay};
pub use plugin::WindowPlugin;
pub use title::{FrameTime, WindowTitle};
pub use viewer_keys::ViewerKeysPlugin;
/// The winit that opens the window.
pub use winit;

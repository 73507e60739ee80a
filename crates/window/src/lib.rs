//! halfway in a window: winit runner, input and orbit camera.
//!
//! [`WindowPlugin`] runs an App in a window that the renderer draws in; the same App without it
//! draws headless. It brings along, and each works alone in any App with `bevy_input`:
//!
//! - [`OrbitCameraPlugin`]: mouse and keys move every [`OrbitCamera`] around its target.
//! - [`ViewerKeysPlugin`]: 1, 2 and 3 choose flat, Gouraud and Phong shading, B the reflectance,
//!   I the intensity policy, Escape and Q close.
//!
//! ```no_run
//! use bevy_app::{App, AppExit, Startup};
//! use bevy_ecs::prelude::*;
//! use bevy_math::Vec3;
//! use bevy_transform::TransformPlugin;
//! use halfway_lighting::Camera;
//! use halfway_render::RenderPlugin;
//! use halfway_window::{OrbitCamera, WindowPlugin, WindowTitle};
//!
//! fn main() -> AppExit {
//!     App::new()
//!         .add_plugins((TransformPlugin, RenderPlugin::default(), WindowPlugin::default()))
//!         .insert_resource(WindowTitle("nothing yet".into()))
//!         .add_systems(Startup, |mut commands: Commands| {
//!             commands.spawn((Camera::default(), OrbitCamera::looking_at(Vec3::new(0.0, 2.0, 6.0), Vec3::ZERO)));
//!         })
//!         .run()
//! }
//! ```

mod buffer;
mod display;
mod error;
mod input;
mod keys;
mod open;
mod orbit;
mod orbit_camera;
mod plugin;
mod problems;
mod runner;
mod short_numbers;
mod title;
mod viewer_keys;

pub use display::has_display;
pub use open::WinitWindow;
pub use orbit::{Orbit, PITCH_LIMIT};
pub use orbit_camera::{DragArea, OrbitCamera, OrbitCameraPlugin};
pub use plugin::WindowPlugin;
pub use title::{FrameTime, WindowTitle};
pub use viewer_keys::ViewerKeysPlugin;
/// The winit that opens the window.
pub use winit;

//! Things that are drawn over the picture of a window, such as panels.

use bevy_ecs::prelude::World;
use bevy_math::UVec2;
use winit::event::WindowEvent;
use winit::window::Window;

/// Draws over the picture of a window, and takes input before the App does: panels, handles, text.
///
/// Insert it as a [`WindowOverlay`] before the App runs. On wgpu it is drawn by a
/// [`WindowPass`](halfway_render::WindowPass) that the overlay inserts itself.
pub trait Overlay: 'static {
    /// Takes an event of the window. `true` keeps it from the App: from `bevy_input`, the orbit camera and the keys.
    fn event(&mut self, window: &Window, event: &WindowEvent, world: &mut World) -> bool;

    /// Prepares what the next frame shows, before the App's update.
    fn frame(&mut self, window: &Window, world: &mut World);

    /// Draws over the finished picture of the CPU: a pixel is 0x00RRGGBB, row by row from the top.
    fn paint(&mut self, pixels: &mut [u32], size: UVec2);
}

/// The overlay of the App's window, which the runner takes when it starts. A resource that is not `Send`: windows belong
/// to the main thread.
pub struct WindowOverlay(pub Box<dyn Overlay>);

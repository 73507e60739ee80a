//! Opens the window, and the adapter or CPU buffer that draws in it.

use crate::buffer::WindowBuffer;
use crate::error::{WindowError, reason};
use crate::input::Forward;
use crate::orbit_camera::{DragArea, Pointer};
use crate::overlay::Overlay;
use bevy_ecs::prelude::*;
use bevy_math::{UVec2, Vec2};
use halfway_render::{Adapter, AdapterChoice, Canvas, CanvasTarget, Gpu, SurfaceLost, SurfaceTarget, wgpu};
use std::sync::Arc;
use std::time::Duration;
use winit::dpi::LogicalSize;
use winit::event_loop::{ActiveEventLoop, OwnedDisplayHandle};
use winit::window::Window;

/// The open window, on an entity of its own while [`WindowPlugin`](crate::WindowPlugin)'s runner runs; for features
/// that the plugin does not cover, such as full screen or the pointer's shape.
#[derive(Component, Clone, Debug)]
pub struct WinitWindow(pub Arc<Window>);

/// A surface or device that is lost again this many times without a picture in between is given up.
const MOST_LOSSES: u32 = 10;

/// The window of a running App.
pub(crate) struct Open {
    /// The buffer that the CPU draws into; dropped before the window.
    buffer: Option<WindowBuffer>,
    pub(crate) window: Arc<Window>,
    display: OwnedDisplayHandle,
    pub(crate) input: Forward,
    entity: Entity,
    /// In physical pixels; 0 along an axis if the window system minimises that way.
    pub(crate) size: UVec2,
    losses: u32,
}

impl Open {
    /// Opens a window and an adapter for it, and inserts both into `world`.
    pub(crate) fn new(
        event_loop: &ActiveEventLoop,
        title: &str,
        size: UVec2,
        world: &mut World,
    ) -> Result<Self, WindowError> {
        let UVec2 { x: width, y: height } = size.max(UVec2::ONE);
        let attributes =
            Window::default_attributes().with_title(title).with_inner_size(LogicalSize::new(width, height));
        let window = event_loop.create_window(attributes).map_err(|error| WindowError::Window {
            width,
            height,
            reason: reason(&error),
        })?;
        let window = Arc::new(window);
        let display = event_loop.owned_display_handle();
        let buffer = open_adapter(&window, &display, world)?;
        let entity = world.spawn(WinitWindow(Arc::clone(&window))).id();
        let size = physical_size(&window);
        let mut open = Self { buffer, window, display, input: Forward::new(entity), entity, size, losses: 0 };
        open.follow_size(world);
        Ok(open)
    }

    /// The shortest time between frames: a little less than the display's interval, so that the display sets the pace
    /// if presenting waits for it, and this limit does otherwise.
    pub(crate) fn pace(&self) -> Duration {
        let refresh = self.window.current_monitor().and_then(|monitor| monitor.refresh_rate_millihertz());
        shortest_frame(refresh)
    }

    /// Gives the picture, the [`DragArea`] and the [`Pointer`] the window's size.
    pub(crate) fn follow_size(&mut self, world: &mut World) {
        let size = physical_size(&self.window);
        self.size = size;
        if let Some(mut target) = world.get_resource_mut::<SurfaceTarget>() {
            target.resize(size);
        }
        if let Some(mut target) = world.get_resource_mut::<CanvasTarget>() {
            target.size = size;
        }
        if size.min_element() > 0 {
            let logical = self.window.inner_size().to_logical::<f32>(self.window.scale_factor());
            world.insert_resource(DragArea(Vec2::new(logical.width, logical.height)));
            world.get_resource_or_init::<Pointer>().picture = size;
        }
    }

    /// Shows the CPU's picture, replaces a lost surface or device, and returns whether the newest frame reached the
    /// display.
    pub(crate) fn present(
        &mut self,
        world: &mut World,
        overlay: Option<&mut (dyn Overlay + 'static)>,
    ) -> Result<bool, WindowError> {
        if let Some(buffer) = &mut self.buffer {
            let Some((size, picture)) = world.get_resource::<Canvas>().and_then(Canvas::bytes) else {
                return Ok(false);
            };
            self.window.pre_present_notify();
            return buffer.show(size, picture, overlay).map(|()| true);
        }
        let surface_lost = world.remove_resource::<SurfaceLost>().is_some();
        let device_lost = world.get_resource::<Gpu>().is_some_and(Gpu::is_lost);
        if surface_lost || device_lost {
            self.losses += 1;
            if self.losses == MOST_LOSSES {
                return Err(WindowError::LostAgain(MOST_LOSSES));
            }
            // A window has one surface at a time.
            world.remove_resource::<SurfaceTarget>();
            let gpu = world.get_resource::<Gpu>().filter(|_| !device_lost).cloned();
            match gpu.as_ref().and_then(|gpu| Some((gpu, gpu.instance.as_ref()?))) {
                Some((gpu, instance)) => {
                    let surface = make_surface(instance, &self.window)?;
                    world.insert_resource(SurfaceTarget::new(gpu, surface, self.size)?);
                }
                None => self.buffer = open_adapter(&self.window, &self.display, world)?,
            }
            return Ok(false);
        }
        let presented = world.get_resource::<SurfaceTarget>().is_some_and(SurfaceTarget::acquired);
        if presented {
            self.losses = 0;
        }
        Ok(presented)
    }

    /// Drops the surface and then the window, while the display is still connected.
    pub(crate) fn close(self, world: &mut World) {
        world.remove_resource::<SurfaceTarget>();
        world.remove_resource::<CanvasTarget>();
        world.despawn(self.entity);
    }
}

/// Opens the renderer of the window and inserts it into `world`: an adapter with the window's surface, or the CPU,
/// which draws for the returned buffer.
fn open_adapter(
    window: &Arc<Window>,
    display: &OwnedDisplayHandle,
    world: &mut World,
) -> Result<Option<WindowBuffer>, WindowError> {
    let choice = world.get_resource_or_init::<AdapterChoice>().clone();
    let (adapter, surface) = choice.open_for(display, |instance| make_surface(instance, window))?;
    log::info!("drawing on {}", adapter.describe());
    let (Adapter::Gpu(gpu), Some(surface)) = (adapter.clone(), surface) else {
        let buffer = WindowBuffer::new(display, window)?;
        world.insert_resource(CanvasTarget { size: physical_size(window) });
        adapter.insert_into(world);
        return Ok(Some(buffer));
    };
    world.insert_resource(SurfaceTarget::new(&gpu, surface, physical_size(window))?);
    world.insert_resource(gpu);
    Ok(None)
}

/// Nine tenths of the display's interval; 60 Hz if the display does not report its rate.
fn shortest_frame(millihertz: Option<u32>) -> Duration {
    let millihertz = millihertz.filter(|rate| (20_000..=1_000_000).contains(rate)).unwrap_or(60_000);
    Duration::from_nanos(900_000_000_000 / u64::from(millihertz))
}

fn physical_size(window: &Window) -> UVec2 {
    let size = window.inner_size();
    UVec2::new(size.width, size.height)
}

fn make_surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>, WindowError> {
    instance.create_surface(Arc::clone(window)).map_err(|error| WindowError::Surface(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_a_little_shorter_than_the_display_s() {
        let rows = [
            ("60 Hz", Some(60_000), 15_000),
            ("144 Hz", Some(144_000), 6_250),
            ("not said", None, 15_000),
            ("nonsense", Some(0), 15_000),
            ("more nonsense", Some(u32::MAX), 15_000),
        ];
        for (name, millihertz, microseconds) in rows {
            assert_eq!(shortest_frame(millihertz), Duration::from_micros(microseconds), "{name}");
        }
    }
}

//! The plugin and the way of one frame.

use crate::choice::AdapterChoice;
use crate::cpu;
use crate::cpu::device::Cpu;
#[cfg(feature = "wgpu")]
use crate::gpu::{self, device::Gpu};
use crate::headless::{self, Headless};
use crate::replaced;
use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use halfway_frame::report::FrameReport;
use halfway_frame::sets::RenderSet;
use halfway_frame::{FramePlugin, ReadCamera};

/// Draws every entity with a [`Mesh3d`] through the world's [`Camera`](halfway_lighting::Camera), once a run of its
/// schedule.
///
/// Needs `GlobalTransform`s to be current: it runs after `TransformSystems::Propagate` where that set
/// is in the same schedule, and an App with a schedule of its own propagates before. Where nothing propagates them, the
/// frame is not drawn, and [`FrameReport::errors`] says so.
///
/// Brings [`FramePlugin`] and the plugins of meshes, lighting and textures. May be added before or after other plugins, and to an App that has
/// cameras, lights and objects already.
#[derive(Clone, Debug)]
pub struct RenderPlugin {
    /// The schedule that draws a frame. Default `PostUpdate`.
    pub schedule: InternedScheduleLabel,
}

impl Default for RenderPlugin {
    fn default() -> Self {
        Self { schedule: PostUpdate.intern() }
    }
}

impl Plugin for RenderPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(FramePlugin { schedule: self.schedule })
            .init_resource::<AdapterChoice>()
            .init_resource::<Headless>()
            .add_systems(
                self.schedule,
                (
                    headless::measure.in_set(RenderSet::View).before(ReadCamera),
                    (open, replaced::forget).chain().in_set(RenderSet::View).after(ReadCamera),
                ),
            );
        cpu::add(app, self.schedule);
        #[cfg(feature = "wgpu")]
        gpu::plugin::add(app, self.schedule);
    }
}

/// Opens an adapter for headless pictures unless one is open. What fails is in the report, every frame anew, so that an
/// adapter that appears later is found. A device that is lost is replaced once a report has said so.
fn open(world: &mut World) {
    #[cfg(feature = "wgpu")]
    if let Some(gpu) = world.get_resource::<Gpu>().cloned() {
        if !gpu.is_lost() {
            return;
        }
        if let Some(loss) = gpu.take_loss() {
            world.resource_mut::<FrameReport>().errors.push(loss);
            return;
        }
        open_anew(world);
        return;
    }
    if !world.contains_resource::<Cpu>() {
        open_anew(world);
    }
}

fn open_anew(world: &mut World) {
    match world.resource::<AdapterChoice>().open() {
        Ok(adapter) => {
            log::info!("drawing on {}", adapter.describe());
            adapter.insert_into(world);
        }
        Err(error) => world.resource_mut::<FrameReport>().errors.push(error),
    }
}

/// Whether the CPU draws.
pub(crate) fn cpu_draws(#[cfg(feature = "wgpu")] gpu: Option<Res<Gpu>>, cpu: Option<Res<Cpu>>) -> bool {
    #[cfg(feature = "wgpu")]
    if gpu.is_some() {
        return false;
    }
    cpu.is_some()
}

//! The stages of a frame.

use crate::choice::AdapterChoice;
use crate::cpu;
use crate::cpu::device::Cpu;
#[cfg(feature = "wgpu")]
use crate::gpu::{self, device::Gpu};
use crate::headless::{self, Headless};
use crate::replaced;
use crate::views::{self, Views};
use crate::window_picture::FinishedWindow;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use halfway_frame::report::FrameReport;
use halfway_frame::sets::RenderSet;
use halfway_frame::{FramePlugin, ReadCamera, add_further_camera};

/// Adds the stages of a frame, for both renderers.
pub(crate) fn add_drawers(app: &mut App, schedule: InternedScheduleLabel) {
    app.add_plugins(FramePlugin { schedule })
        .init_resource::<AdapterChoice>()
        .init_resource::<Headless>()
        .init_resource::<Views>()
        .init_resource::<FinishedWindow>()
        .add_systems(
            schedule,
            (
                headless::measure.in_set(RenderSet::View).before(views::begin),
                views::begin.in_set(RenderSet::View).before(ReadCamera),
                (make_further_cameras, views::draw_further).chain().in_set(RenderSet::Deliver).run_if(Views::are_there),
                (open, replaced::forget).chain().in_set(RenderSet::View).after(ReadCamera),
            ),
        );
    cpu::add(app, schedule);
    #[cfg(feature = "wgpu")]
    gpu::plugin::add(app, schedule);
}

/// Makes the schedules of the cameras after the first that are not there. Most Apps never need one.
fn make_further_cameras(views: Res<Views>, mut schedules: ResMut<Schedules>) {
    for camera in views.further() {
        if schedules.contains(camera) {
            continue;
        }
        let mut app = App::empty();
        add_further_camera(&mut app, camera);
        cpu::add_stages(&mut app, camera.intern());
        #[cfg(feature = "wgpu")]
        gpu::plugin::add_stages(&mut app, camera.intern());
        let made = app.world_mut().resource_mut::<Schedules>().remove(camera);
        made.and_then(|schedule| schedules.insert(schedule));
    }
}

/// Opens an adapter for headless pictures unless one is open. A failure is reported and retried in every frame, so that
/// an adapter that appears later is found. A lost device is replaced after its loss was reported.
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

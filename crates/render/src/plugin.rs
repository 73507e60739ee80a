//! The plugin and the stages of a frame.

use crate::choice::AdapterChoice;
use crate::cpu;
use crate::cpu::device::Cpu;
use crate::finished_window::{self, FinishedWindow};
#[cfg(feature = "wgpu")]
use crate::gpu::{self, device::Gpu};
use crate::headless::{self, Headless};
use crate::logged::{self, Logged};
use crate::pending::{DrawnIn, PictureAge};
use crate::replaced;
use crate::views::{self, Views};
use bevy_app::{App, First, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use halfway_frame::report::FrameReport;
use halfway_frame::sets::RenderSet;
use halfway_frame::{FramePlugin, FurtherCamera, ReadCamera, add_further_camera};

/// Draws every entity with a [`Mesh3d`](halfway_mesh::Mesh3d) through the world's [`Camera`](halfway_lighting::Camera), once a run of its
/// schedule.
///
/// Needs current `GlobalTransform`s: it runs after `TransformSystems::Propagate` if that set is in the same schedule,
/// and an App with a schedule of its own propagates before. If no system propagates them, the frame is not drawn, and
/// [`FrameReport::errors`] says so.
///
/// Each error of a frame is logged once by the `log` crate (target `halfway_render::errors`; a window says them
/// itself), and so is each warning: an opacity that is not shown without
/// [`AlphaMode::Blend`](halfway_lighting::AlphaMode::Blend), why a picture shows nothing
/// ([`why_empty`](crate::why_empty)), and that a picture is asked for that is a frame old
/// ([`PendingPicture::request`](crate::PendingPicture::request)).
///
/// Brings [`FramePlugin`] and the plugins of meshes, lighting and textures. May be added before or after other plugins,
/// and to an App that has
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
        add_drawers(app, self.schedule);
        app.insert_resource(DrawnIn(self.schedule))
            .init_resource::<Logged>()
            .init_resource::<PictureAge>()
            .add_systems(First, PictureAge::grow)
            .add_systems(
                self.schedule,
                (
                    PictureAge::renew.in_set(RenderSet::Deliver),
                    finished_window::ask.in_set(RenderSet::View).after(ReadCamera),
                    finished_window::finish
                        .in_set(RenderSet::Deliver)
                        .after(views::draw_further)
                        .run_if(finished_window::is_asked),
                    (
                        logged::log_errors,
                        logged::log_ineffective_opacity,
                        #[cfg(feature = "wgpu")]
                        logged::log_lines,
                        logged::log_why_empty.run_if(logged::may_be_empty),
                    )
                        .chain()
                        .after(RenderSet::Deliver),
                ),
            );
    }
}

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
                (make_further_camera, views::draw_further).chain().in_set(RenderSet::Deliver).run_if(Views::are_there),
                (open, replaced::forget).chain().in_set(RenderSet::View).after(ReadCamera),
            ),
        );
    cpu::add(app, schedule);
    #[cfg(feature = "wgpu")]
    gpu::plugin::add(app, schedule);
}

/// Makes the schedule of the cameras after the first, unless it is there. Most Apps never need it.
fn make_further_camera(mut schedules: ResMut<Schedules>) {
    if schedules.contains(FurtherCamera) {
        return;
    }
    let mut app = App::empty();
    add_further_camera(&mut app);
    cpu::add_stages(&mut app, FurtherCamera.intern());
    #[cfg(feature = "wgpu")]
    gpu::plugin::add_stages(&mut app, FurtherCamera.intern());
    let made = app.world_mut().resource_mut::<Schedules>().remove(FurtherCamera);
    made.and_then(|schedule| schedules.insert(schedule));
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

//! The plugin and the way of one frame.

use crate::cpu::draw as on_canvas;
use crate::cpu::meshes::{self as mesh_pieces, MeshPieces};
use crate::cpu::pass::{self as lists, PassLists};
use crate::device::choice::AdapterChoice;
use crate::device::cpu::Cpu;
use crate::device::gpu::Gpu;
use crate::draw::meshes::{self as mesh_buffers, MeshBuffers};
use crate::draw::upload::{self, Buffers};
use crate::draw::{pass, replaced};
use crate::pipelines::cache::{self, Pipelines};
use crate::target::canvas::Canvas;
use crate::target::frame::{self, Headless, Target};
use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use halfway_frame::batch::lit_patches;
use halfway_frame::report::FrameReport;
use halfway_frame::sets::RenderSet;
use halfway_frame::{FramePlugin, ReadCamera, add_backend};

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
            .init_resource::<Target>()
            .init_resource::<Canvas>()
            .init_resource::<MeshBuffers>()
            .init_resource::<Buffers>()
            .init_resource::<Pipelines>()
            .init_resource::<MeshPieces>()
            .init_resource::<PassLists>();
        self.add_systems(app);
    }
}

impl RenderPlugin {
    fn add_systems(&self, app: &mut App) {
        use RenderSet::{Deliver, Draw, Illuminate, Upload, View};
        add_backend::<Pipelines, _>(app, self.schedule, gpu_draws);
        add_backend::<Cpu, _>(app, self.schedule, cpu_draws);
        let on_gpu = (
            frame::prepare.in_set(View).after(replaced::forget),
            cache::begin.in_set(Illuminate).before(lit_patches::illuminate::<Pipelines>),
            (
                mesh_buffers::upload,
                upload::build_pipelines,
                upload::upload,
                upload::upload_maps,
                upload::upload_surroundings,
            )
                .chain()
                .in_set(Upload),
            pass::draw.in_set(Draw),
            pass::present.in_set(Deliver),
        );
        let on_cpu = (
            on_canvas::prepare.in_set(View).after(replaced::forget),
            (mesh_pieces::make_ready, lists::fill).chain().in_set(Upload),
            on_canvas::draw.in_set(Draw),
        );
        app.add_systems(
            self.schedule,
            (
                frame::measure.in_set(View).before(ReadCamera),
                (open, replaced::forget).chain().in_set(View).after(ReadCamera),
                on_gpu.run_if(gpu_draws),
                on_cpu.run_if(cpu_draws),
            ),
        );
    }
}

/// Opens what draws headless pictures unless there is something that can. What fails is in the report, every frame
/// anew, so that an adapter that appears later is found. A device that is lost is replaced once a report has said so.
fn open(world: &mut World) {
    let lost = match world.get_resource::<Gpu>() {
        Some(gpu) if !gpu.is_lost() => return,
        None if world.contains_resource::<Cpu>() => return,
        there => there.cloned(),
    };
    if let Some(loss) = lost.as_ref().and_then(Gpu::take_loss) {
        world.resource_mut::<FrameReport>().errors.push(loss);
        return;
    }
    match world.resource::<AdapterChoice>().open() {
        Ok(adapter) => {
            log::info!("drawing on {}", adapter.describe());
            adapter.insert_into(world);
        }
        Err(error) => world.resource_mut::<FrameReport>().errors.push(error),
    }
}

fn gpu_draws(gpu: Option<Res<Gpu>>) -> bool {
    gpu.is_some_and(|gpu| !gpu.is_lost())
}

fn cpu_draws(gpu: Option<Res<Gpu>>, cpu: Option<Res<Cpu>>) -> bool {
    gpu.is_none() && cpu.is_some()
}

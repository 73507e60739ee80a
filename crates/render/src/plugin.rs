//! The plugin and the way of one frame.

use crate::batch::batches::{self, Batches};
use crate::batch::lit_patches::{self, LitPatches};
use crate::cpu::draw as on_canvas;
use crate::cpu::meshes::{self as mesh_pieces, MeshPieces};
use crate::cpu::pass::{self as lists, PassLists};
use crate::device::choice::AdapterChoice;
use crate::device::cpu::Cpu;
use crate::device::gpu::Gpu;
use crate::draw::meshes::{self as mesh_buffers, MeshBuffers};
use crate::draw::upload::{self, Buffers};
use crate::draw::{pass, replaced};
use crate::frame::report::FrameReport;
use crate::frame::sets::RenderSet;
use crate::frame::times;
use crate::frame::told::{self, Told};
use crate::geometry::meshes::{self, Geometries};
use crate::geometry::workshop::Workshop;
use crate::lights::gather::{self, Lights};
use crate::lights::surroundings::{self, Surroundings};
use crate::lights::terms::{self, Chosen};
use crate::pipelines::cache::{self, Pipelines};
use crate::target::canvas::Canvas;
use crate::target::frame::{self, FrameValues, Headless, Target};
use crate::target::picture::DrawnIn;
use crate::view::camera::{self, PictureSize, View};
use crate::view::matrices::{self, ModelView, NormalMatrix, Visible};
use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_transform::TransformSystems;
use halfway_lighting::{LightingPlugin, Material};
use halfway_mesh::{Mesh3d, MeshPlugin};
use halfway_texture::TexturePlugin;

/// Draws every entity with a [`Mesh3d`] through the world's [`Camera`](halfway_lighting::Camera), once a run of its
/// schedule.
///
/// Needs `GlobalTransform`s to be current: it runs after `TransformSystems::Propagate` where that set
/// is in the same schedule, and an App with a schedule of its own propagates before. Where nothing propagates them, the
/// frame is not drawn, and [`FrameReport::errors`] says so.
///
/// Each error of a frame is logged once by the `log` crate (target `halfway_render::errors`; a window says them
/// itself), and so is each warning: an opacity that is not shown without
/// [`Blend`](halfway_lighting::Blend), and why a picture shows nothing ([`why_empty`](crate::why_empty)).
///
/// Brings [`MeshPlugin`] and [`LightingPlugin`]. May be added before or after other plugins, and to an App that has
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
        app.add_plugins((MeshPlugin, LightingPlugin, TexturePlugin))
            .insert_resource(DrawnIn(self.schedule))
            .init_resource::<AdapterChoice>()
            .init_resource::<Headless>()
            .init_resource::<FrameReport>()
            .init_resource::<Told>()
            .init_resource::<Target>()
            .init_resource::<Canvas>()
            .init_resource::<FrameValues>()
            .init_resource::<PictureSize>()
            .init_resource::<View>()
            .init_resource::<Visible>()
            .init_resource::<Lights>()
            .init_resource::<Surroundings>()
            .init_resource::<LitPatches>()
            .init_resource::<Batches>()
            .init_resource::<Workshop>()
            .init_resource::<Geometries>()
            .init_resource::<MeshBuffers>()
            .init_resource::<Buffers>()
            .init_resource::<Pipelines>()
            .init_resource::<MeshPieces>()
            .init_resource::<PassLists>();
        self.add_systems(app);
        self.require_components(app);
        times::add_clocks(app, self.schedule);
    }
}

impl RenderPlugin {
    /// Gives objects what they are drawn with. An app in which there were objects before this plugin takes no new
    /// requirements; it has a look for objects that lack something in each frame.
    fn require_components(&self, app: &mut App) {
        let world = app.world_mut();
        let required = [
            world.try_register_required_components::<Mesh3d, Material>(),
            world.try_register_required_components::<Mesh3d, ModelView>(),
            world.try_register_required_components::<Mesh3d, NormalMatrix>(),
            world.try_register_required_components::<Mesh3d, Chosen>(),
        ];
        if required.iter().any(Result::is_err) {
            app.add_systems(self.schedule, complete.in_set(RenderSet::View).before(frame::measure));
        }
    }

    fn add_systems(&self, app: &mut App) {
        use RenderSet::{Batch, Choose, Deliver, Draw, Illuminate, Matrices, Select, Upload, View};
        let order = (View, Select, Matrices, Choose, Illuminate, Batch, Upload, Draw, Deliver);
        app.configure_sets(self.schedule, order.chain().after(TransformSystems::Propagate)).add_systems(
            self.schedule,
            (
                (frame::measure, camera::update, camera::require_propagation, open, replaced::forget)
                    .chain()
                    .in_set(View),
                (matrices::select, surroundings::gather).in_set(Select),
                matrices::compute.in_set(Matrices),
                (terms::choose, meshes::forget_removed, meshes::lay_out).chain().in_set(Choose),
                gather::gather.in_set(Illuminate),
            ),
        );
        // What draws the batches: wgpu, or the CPU.
        let on_gpu = (
            frame::prepare.in_set(View).after(replaced::forget),
            (cache::begin, lit_patches::illuminate::<Pipelines>).chain().in_set(Illuminate).after(gather::gather),
            batches::batch::<Pipelines>.in_set(Batch),
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
            lit_patches::illuminate::<Cpu>.in_set(Illuminate).after(gather::gather),
            batches::batch::<Cpu>.in_set(Batch),
            (mesh_pieces::make_ready, lists::fill).chain().in_set(Upload),
            on_canvas::draw.in_set(Draw),
        );
        app.add_systems(self.schedule, (on_gpu.run_if(gpu_draws), on_cpu.run_if(cpu_draws)));
        let tell = (told::tell_errors, told::tell_of_opacity, told::tell_why_empty.run_if(told::may_be_empty));
        app.add_systems(self.schedule, tell.chain().after(Deliver));
    }
}

type Incomplete = (With<Mesh3d>, Or<(Without<Material>, Without<ModelView>, Without<NormalMatrix>, Without<Chosen>)>);

/// Gives objects what they lack.
fn complete(objects: Query<Entity, Incomplete>, mut commands: Commands) {
    for object in &objects {
        let all = (Material::default(), ModelView::default(), NormalMatrix::default(), Chosen::default());
        commands.entity(object).insert_if_new(all);
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

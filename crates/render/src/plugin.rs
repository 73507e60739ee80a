//! The plugin and the way of one frame.

use crate::batch::batches::{self, Batches};
use crate::batch::terms::{self, Chosen};
use crate::device::gpu::Gpu;
use crate::draw::pass;
use crate::draw::upload::{self, Buffers};
use crate::frame::report::FrameReport;
use crate::frame::sets::RenderSet;
use crate::frame::times;
use crate::geometry::detail::LevelsOfDetail;
use crate::geometry::meshes::{self, Geometries};
use crate::geometry::workshop::Workshop;
use crate::lights::gather::{self, Lights};
use crate::pipelines::cache::{self, Pipelines};
use crate::target::frame::{self, Headless, Target};
use crate::view::camera::{self, View};
use crate::view::matrices::{self, ModelView, NormalMatrix, Visible};
use bevy_app::{App, Plugin, PostUpdate};
use bevy_asset::{AssetApp, AssetEvent, AssetPlugin, Assets};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_transform::TransformSystems;
use halfway_lighting::{GlobalAmbient, Material};
use halfway_mesh::{Mesh, Mesh3d};

/// Draws every entity with a [`Mesh3d`] through the world's [`Camera`](halfway_lighting::Camera), once a run of its schedule.
///
/// Needs `GlobalTransform`s to be current: it runs after `TransformSystems::Propagate` where that set
/// is in the same schedule, and an App with a schedule of its own propagates before.
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
        if !app.is_plugin_added::<AssetPlugin>() {
            app.add_plugins(AssetPlugin::default());
        }
        if !app.world().contains_resource::<Assets<Mesh>>() {
            app.init_asset::<Mesh>();
        }
        app.init_resource::<Headless>()
            .init_resource::<FrameReport>()
            .init_resource::<GlobalAmbient>()
            .init_resource::<Target>()
            .init_resource::<View>()
            .init_resource::<Visible>()
            .init_resource::<Lights>()
            .init_resource::<Batches>()
            .init_resource::<LevelsOfDetail>()
            .init_resource::<Workshop>()
            .init_resource::<Geometries>()
            .init_resource::<Buffers>()
            .init_resource::<Pipelines>()
            .add_message::<AssetEvent<Mesh>>()
            .register_required_components::<Mesh3d, Material>()
            .register_required_components::<Mesh3d, ModelView>()
            .register_required_components::<Mesh3d, NormalMatrix>()
            .register_required_components::<Mesh3d, Chosen>();
        self.add_systems(app);
        times::add_clocks(app, self.schedule);
    }
}

impl RenderPlugin {
    fn add_systems(&self, app: &mut App) {
        use RenderSet::{Batch, Choose, Deliver, Draw, Illuminate, Matrices, Select, Upload, View};
        let order = (View, Select, Matrices, Illuminate, Choose, Batch, Upload, Draw, Deliver);
        app.configure_sets(self.schedule, order.chain().after(TransformSystems::Propagate)).add_systems(
            self.schedule,
            (
                (frame::measure, camera::update, open_gpu).chain().in_set(View),
                matrices::select.in_set(Select),
                matrices::compute.in_set(Matrices),
                gather::gather.in_set(Illuminate),
                terms::choose.in_set(Choose),
            ),
        );
        let on_gpu = (
            (frame::prepare, meshes::forget_removed, meshes::upload_visible, cache::begin, batches::batch)
                .chain()
                .in_set(Batch),
            (upload::build_pipelines, upload::upload).chain().in_set(Upload),
            pass::draw.in_set(Draw),
            pass::present.in_set(Deliver),
        );
        app.add_systems(self.schedule, on_gpu.run_if(resource_exists::<Gpu>));
    }
}

/// Opens an adapter for headless pictures unless a window has opened one. What fails is in the report,
/// every frame anew, so that an adapter that appears later is found.
fn open_gpu(world: &mut World) {
    if !world.contains_resource::<Gpu>() {
        match Gpu::open_headless() {
            Ok(gpu) => {
                log::info!("drawing on {}", gpu.describe());
                world.insert_resource(gpu);
            }
            Err(error) => {
                world.resource_mut::<FrameReport>().errors.push(error);
            }
        }
    }
}

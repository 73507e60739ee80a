//! The plugin and the way of one frame.

use crate::batch::{self, Batches};
use crate::detail::LevelsOfDetail;
use crate::draw;
use crate::geometry::{self, Geometries};
use crate::gpu::Gpu;
use crate::lights::{self, Lights};
use crate::matrices::{self, ModelView, NormalMatrix, Visible};
use crate::pipelines::{self, Pipelines};
use crate::report::FrameReport;
use crate::target::{self, Headless, Target};
use crate::terms::{self, Chosen};
use crate::timing;
use crate::upload::{self, Buffers};
use crate::view::{self, View};
use crate::workshop::Workshop;
use bevy_app::{App, Plugin, PostUpdate};
use bevy_asset::{AssetApp, AssetEvent, AssetPlugin, Assets};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_transform::TransformSystems;
use halfway_lighting::{GlobalAmbient, Material};
use halfway_mesh::{Mesh, Mesh3d};

/// The steps of a frame, in order. Each says what holds after it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RenderSet {
    /// The adapter is open, the camera is validated, and [`View`] holds its matrices and projection.
    View,
    /// [`Visible`] holds the objects that the frustum sees.
    Select,
    /// [`ModelView`] and [`NormalMatrix`] of every visible object are current.
    Matrices,
    /// [`Lights`] holds the lights in eye space.
    Illuminate,
    /// [`Chosen`] holds each visible object's shading frequencies.
    Choose,
    /// Draws are sorted, and equal ones are instanced.
    Batch,
    /// What changed is on the GPU, and so are the pipelines of the draws.
    Upload,
    /// The passes are encoded and submitted.
    Draw,
    /// The picture is presented on the surface, or readable from the headless target.
    Deliver,
}

impl RenderSet {
    /// All of them, in the order of a frame.
    pub const ALL: [Self; 9] = [
        Self::View,
        Self::Select,
        Self::Matrices,
        Self::Illuminate,
        Self::Choose,
        Self::Batch,
        Self::Upload,
        Self::Draw,
        Self::Deliver,
    ];

    /// Its name as it is written in code.
    pub const fn name(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Select => "Select",
            Self::Matrices => "Matrices",
            Self::Illuminate => "Illuminate",
            Self::Choose => "Choose",
            Self::Batch => "Batch",
            Self::Upload => "Upload",
            Self::Draw => "Draw",
            Self::Deliver => "Deliver",
        }
    }
}

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
        timing::add_clocks(app, self.schedule);
    }
}

impl RenderPlugin {
    fn add_systems(&self, app: &mut App) {
        use RenderSet::{Batch, Choose, Deliver, Draw, Illuminate, Matrices, Select, Upload, View};
        let order = (View, Select, Matrices, Illuminate, Choose, Batch, Upload, Draw, Deliver);
        app.configure_sets(self.schedule, order.chain().after(TransformSystems::Propagate)).add_systems(
            self.schedule,
            (
                (target::measure, view::update, open_gpu).chain().in_set(View),
                matrices::select.in_set(Select),
                matrices::compute.in_set(Matrices),
                lights::gather.in_set(Illuminate),
                terms::choose.in_set(Choose),
            ),
        );
        let on_gpu = (
            (target::prepare, geometry::forget_removed, geometry::upload_visible, pipelines::begin, batch::batch)
                .chain()
                .in_set(Batch),
            (upload::build_pipelines, upload::upload).chain().in_set(Upload),
            draw::draw.in_set(Draw),
            draw::present.in_set(Deliver),
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

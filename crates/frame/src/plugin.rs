//! The plugin, and the systems of a frame up to its draws.

use crate::batch::backend::Backend;
use crate::batch::batches::{self, Batches};
use crate::batch::lit_patches::{self, LitPatches};
use crate::geometry::meshes::{self, Geometries};
use crate::geometry::workshop::Workshop;
use crate::lights::gather::{self, Lights};
use crate::lights::surroundings::{self, Surroundings};
use crate::lights::terms;
use crate::passes::{self, Passes};
use crate::report::FrameReport;
use crate::sets::RenderSet;
use crate::times;
use crate::values::{DrawsOnce, FrameValues, WaitsForLevels};
use crate::view::camera::{self, Epoch, PictureSize, View};
use crate::view::looks::{self, Look, Looks};
use crate::view::matrices::{MatricesOf, ModelView, NormalMatrix};
use crate::view::select::{self, Representatives, Selected, Visible};
use bevy_app::{App, Plugin};
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, InternedSystemSet, ScheduleConfigs, ScheduleLabel};
use bevy_transform::TransformSystems;
use halfway_lighting::{CameraTurn, FrameOrigin, LightingPlugin, Material, place_by_origins};
use halfway_mesh::{Mesh3d, MeshPlugin};
use halfway_texture::TexturePlugin;

/// Turns the world into plain data once a run of a schedule: everything from [`RenderSet::View`] to
/// [`RenderSet::Batch`] that is the same for every drawer.
///
/// A drawer sets [`PictureSize`] before [`ReadCamera`], adds itself by [`add_backend`], and draws [`LitPatches`] and
/// [`Batches`] in [`RenderSet::Draw`].
#[derive(Clone, Debug)]
pub struct FramePlugin {
    /// The schedule that makes a frame.
    pub schedule: InternedScheduleLabel,
}

/// The systems of [`RenderSet::View`] that read the camera, whose view holds after them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ReadCamera;

impl Plugin for FramePlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((MeshPlugin, LightingPlugin, TexturePlugin))
            .init_resource::<FrameReport>()
            .init_resource::<FrameValues>()
            .init_resource::<WaitsForLevels>()
            .init_resource::<DrawsOnce>()
            .init_resource::<PictureSize>()
            .init_resource::<CameraTurn>()
            .init_resource::<FrameOrigin>()
            .init_resource::<Epoch>()
            .init_resource::<View>()
            .init_resource::<Visible>()
            .init_resource::<Representatives>()
            .init_resource::<MatricesOf>()
            .init_resource::<Selected>()
            .init_resource::<Lights>()
            .init_resource::<Surroundings>()
            .init_resource::<Looks>()
            .init_resource::<LitPatches>()
            .init_resource::<Batches>()
            .init_resource::<Passes>()
            .init_resource::<Workshop>()
            .init_resource::<Geometries>();
        let order = add_stages(app, self.schedule);
        app.configure_sets(self.schedule, order.after(TransformSystems::Propagate)).add_systems(
            self.schedule,
            (
                place_by_origins.in_set(ReadCamera).before(camera::update),
                camera::require_propagation.in_set(ReadCamera).after(camera::update),
                looks::forget_changed.in_set(RenderSet::Select).before(select::select),
                meshes::forget_removed.in_set(RenderSet::Choose).after(terms::check).before(meshes::lay_out),
            ),
        );
        self.require_components(app);
        times::add_clocks(app, self.schedule);
    }
}

/// The schedule that makes the frame of the camera with this number, from 1 on, where several share a picture. It has the
/// sets of that which makes the first one's; whoever runs it says whose [turn](CameraTurn) it is.
///
/// Each of these cameras has a schedule of its own, since a system looks for changes since it ran last.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FurtherCamera(pub u32);

/// Adds the systems that make a camera's frame.
fn add_stages(app: &mut App, schedule: InternedScheduleLabel) -> ScheduleConfigs<InternedSystemSet> {
    use RenderSet::{Batch, Choose, Deliver, Draw, Illuminate, Select, Upload, View};
    app.configure_sets(schedule, ReadCamera.in_set(View)).add_systems(
        schedule,
        (
            camera::update.in_set(ReadCamera),
            (select::select, surroundings::gather).in_set(Select),
            (terms::check, meshes::lay_out).chain().in_set(Choose),
            gather::gather.in_set(Illuminate),
        ),
    );
    (View, Select, Choose, Illuminate, Batch, Upload, Draw, Deliver).chain()
}

/// Adds the stages of a frame up to its draws to the schedule of a further camera.
pub fn add_further_camera(app: &mut App, camera: FurtherCamera) {
    let schedule = camera.intern();
    let order = add_stages(app, schedule);
    app.configure_sets(schedule, order);
    times::add_clocks_of_further_camera(app, schedule);
}

impl FramePlugin {
    /// Gives objects the components that a frame needs. An app in which there were objects before this plugin takes no
    /// new requirements; there, objects that lack some are looked for in each frame.
    fn require_components(&self, app: &mut App) {
        let world = app.world_mut();
        let required = [
            world.try_register_required_components::<Mesh3d, Material>(),
            world.try_register_required_components::<Mesh3d, ModelView>(),
            world.try_register_required_components::<Mesh3d, NormalMatrix>(),
            world.try_register_required_components::<Mesh3d, Look>(),
        ];
        if required.iter().any(Result::is_err) {
            app.add_systems(self.schedule, complete.in_set(RenderSet::View).before(ReadCamera));
        }
    }
}

/// Adds the systems that light patches and sort draws for a drawer, while `condition` holds.
pub fn add_backend<B: Backend + Resource<Mutability = Mutable>, M>(
    app: &mut App,
    schedule: InternedScheduleLabel,
    condition: impl SystemCondition<M>,
) {
    let illuminate = lit_patches::illuminate::<B>.in_set(RenderSet::Illuminate).after(gather::gather);
    let systems = (illuminate, (batches::batch::<B>, passes::list).chain().in_set(RenderSet::Batch));
    app.add_systems(schedule, systems.run_if(condition));
}

type Incomplete = (With<Mesh3d>, Or<(Without<Material>, Without<ModelView>, Without<NormalMatrix>, Without<Look>)>);

/// Gives objects the components that they lack.
fn complete(objects: Query<Entity, Incomplete>, mut commands: Commands) {
    for object in &objects {
        let all = (Material::default(), ModelView::default(), NormalMatrix::default(), Look::default());
        commands.entity(object).insert_if_new(all);
    }
}

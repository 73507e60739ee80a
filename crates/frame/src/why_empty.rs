//! Why a picture shows nothing.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::lights::LightQueries;
use halfway_lighting::{Camera, Faces, GlobalAmbient, Material, Shown};
use halfway_mesh::{Lines3d, Mesh, Mesh3d};
use halfway_texture::environment::EnvironmentLight;
use thiserror::Error;

use crate::error::label;
use crate::view::camera::View;

/// Why a picture shows nothing; its message says the remedy. [`why_empty`] finds it.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum EmptyReason {
    /// Nothing is looked through.
    #[error("there is no camera: spawn one with `(Camera::default(), Transform::from_xyz(0.0, 0.0, 5.0))`")]
    NoCamera,
    /// Nothing has a mesh.
    #[error("there is no object: spawn one with `(Mesh3d(meshes.add(Teapot::new(8))), Material::BRASS)`")]
    NoObject,
    /// No object's handle leads to a mesh.
    #[error("none of the {0} objects has its mesh in `Assets<Mesh>`: show what `Assets::add` returns")]
    NoMesh(usize),
    /// All objects are hidden.
    #[error("all {0} objects are hidden: remove `Visibility::Hidden` from them or from an entity above")]
    AllHidden(usize),
    /// All objects are behind the camera.
    #[error(
        "all {0} objects are behind the camera: turn it, by `Transform::looking_at` for example; a camera looks along \
         its -Z axis"
    )]
    AllBehind(usize),
    /// All objects are beside the view, or not between the near and the far plane.
    #[error(
        "all {0} objects are outside of the camera's view: move the camera back, aim it by `Transform::looking_at`, or \
         check `Camera::projection`"
    )]
    AllOutside(usize),
    /// All objects are points: their meshes or their transforms have no size.
    #[error("all {0} objects have no size: check the scale of their `Transform` and the positions of their meshes")]
    NoSize(usize),
    /// The objects in view turn only faces to the camera that are not drawn.
    #[error(
        "the {0} objects in view turn only faces to the camera that are not drawn: insert `Faces::Both`, or move the \
         camera to their other side"
    )]
    FacesAway(usize),
    /// Nothing lights the objects, and none shines by itself.
    #[error(
        "the {0} visible objects are black, since nothing lights them: spawn a light with `(PointLight::white(), \
         Transform::from_xyz(2.0, 3.0, 2.0))`"
    )]
    NoLight(usize),
    /// The camera is inside of the one object that it could see, whose back faces are culled.
    #[error(
        "the camera is inside of {entity}, whose back faces are not drawn: move the camera out, or insert `Faces::Both`"
    )]
    CameraInside {
        /// The object, by its `Name` where it has one.
        entity: String,
    },
}

/// Why the newest picture shows nothing, in the order in which the reasons are looked for: no camera, no object, no mesh,
/// all hidden, all without a size, all behind the camera, all outside of its view, no light, the camera inside of the only
/// object in view, all faces in view away from it.
/// `None` where none of these holds, and where there are lines or points and no other object: the picture then shows something, or holds only what its objects' materials and
/// masks make of them.
///
/// It is about the frame that was drawn last: [`View`] and transforms are read as they are.
/// The renderer logs the reason by itself, once, when a frame has no visible object or no
/// light.
///
/// ```
/// use bevy_app::{App, PostUpdate};
/// use bevy_ecs::schedule::ScheduleLabel;
/// use halfway_frame::FramePlugin;
/// use halfway_frame::why_empty::{EmptyReason, why_empty};
///
/// let mut app = App::new();
/// app.add_plugins(FramePlugin { schedule: PostUpdate.intern() });
/// assert_eq!(why_empty(app.world_mut()), Some(EmptyReason::NoCamera));
/// ```
pub fn why_empty(world: &mut World) -> Option<EmptyReason> {
    if world.query::<&Camera>().iter(world).next().is_none() {
        return Some(EmptyReason::NoCamera);
    }
    let has_lines = world.query::<&Lines3d>().iter(world).next().is_some();
    let mut state =
        SystemState::<(Objects, LightSources, Shown, Option<Res<Assets<Mesh>>>, Option<Res<View>>)>::new(world);
    let (objects, lights, shown, meshes, view) = state.get(world).ok()?;
    let (meshes, view) = (meshes?, view?);
    // A fault of the camera is an error of the frame.
    view.camera?;
    let all = objects.iter().count();
    if all == 0 && has_lines {
        return None;
    }
    if all == 0 {
        return Some(EmptyReason::NoObject);
    }
    let with_mesh: Vec<_> =
        objects.iter().filter_map(|object| Some((object, meshes.get(&object.1.0)?.bounds()))).collect();
    if with_mesh.is_empty() {
        return Some(EmptyReason::NoMesh(all));
    }
    let is_shown = shown.by_entity();
    let not_hidden: Vec<_> = with_mesh.into_iter().filter(|(object, _)| is_shown(object.0)).collect();
    if not_hidden.is_empty() {
        return Some(EmptyReason::AllHidden(all));
    }
    let in_eye = not_hidden.iter().map(|(object, bounds)| {
        let eye_from_model = view.eye_from_world * object.2.affine().as_daffine3();
        let center = eye_from_model.transform_point3(bounds.center().as_dvec3()).as_vec3();
        let stretch = object.2.affine().matrix3.to_cols_array().iter().map(|x| x * x).sum::<f32>().sqrt();
        (center, bounds.radius() * stretch)
    });
    let in_eye: Vec<(Vec3, f32)> = in_eye.collect();
    if in_eye.iter().all(|(_, radius)| *radius <= 0.0) {
        return Some(EmptyReason::NoSize(in_eye.len()));
    }
    if in_eye.iter().all(|(center, radius)| center.z - radius > 0.0) {
        return Some(EmptyReason::AllBehind(in_eye.len()));
    }
    let seen =
        || not_hidden.iter().zip(&in_eye).filter(|(_, (center, radius))| view.lens.sees(center.to_array(), *radius));
    let count = seen().count();
    if count == 0 {
        return Some(EmptyReason::AllOutside(in_eye.len()));
    }
    let is_black = |color: LinearRgba| [color.red, color.green, color.blue].iter().all(|&channel| channel <= 0.0);
    let shines = |material: Option<&Material>| material.is_some_and(|material| !is_black(material.emission));
    if !lights.any(is_black) && !seen().any(|((object, _), _)| shines(object.3)) {
        return Some(EmptyReason::NoLight(count));
    }
    if count == 1
        && let Some(((object, bounds), _)) = seen().next()
    {
        let (entity, _, transform, _, faces, name) = object;
        let model_from_eye = (view.eye_from_world * transform.affine().as_daffine3()).inverse();
        let eye = model_from_eye.translation.as_vec3();
        let is_inside = eye.cmpgt(bounds.min).all() && eye.cmplt(bounds.max).all();
        let culls_backs = faces.is_none_or(|faces| *faces == Faces::Front);
        if is_inside && culls_backs {
            return Some(EmptyReason::CameraInside { entity: label(*entity, *name) });
        }
    }
    let turns_away = |object: &Object| {
        let shown = object.4.copied().unwrap_or_default();
        meshes.get(&object.1.0).is_some_and(|mesh| !shows_a_face(mesh, object.2, shown, &view))
    };
    seen().all(|((object, _), _)| turns_away(object)).then_some(EmptyReason::FacesAway(count))
}

/// Whether one of the sides that are shown of a triangle is turned to the camera.
fn shows_a_face(mesh: &Mesh, transform: &GlobalTransform, shown: Faces, view: &View) -> bool {
    if shown == Faces::Both {
        return true;
    }
    let eye_from_model = view.eye_from_world * transform.affine().as_daffine3();
    let mirrors = eye_from_model.matrix3.determinant() < 0.0;
    let is_parallel = view.lens.is_parallel;
    mesh.triangles().any(|triangle| {
        let [a, b, c] = triangle.map(|i| eye_from_model.transform_point3(mesh.positions()[i as usize].as_dvec3()));
        let toward_eye = if is_parallel { DVec3::Z } else { -a };
        let turn = (b - a).cross(c - a).dot(toward_eye);
        if mirrors == (shown == Faces::Front) { turn < 0.0 } else { turn > 0.0 }
    })
}

type Object<'a> = (Entity, &'a Mesh3d, &'a GlobalTransform, Option<&'a Material>, Option<&'a Faces>, Option<&'a Name>);

type Objects<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Mesh3d,
        &'static GlobalTransform,
        Option<&'static Material>,
        Option<&'static Faces>,
        Option<&'static Name>,
    ),
>;

/// Everything that lights.
#[derive(bevy_ecs::system::SystemParam)]
struct LightSources<'w, 's> {
    lights: LightQueries<'w, 's>,
    environments: Query<'w, 's, &'static EnvironmentLight>,
    ambient: Option<Res<'w, GlobalAmbient>>,
}

impl LightSources<'_, '_> {
    fn any(&self, is_black: impl Fn(LinearRgba) -> bool) -> bool {
        let mut shine = false;
        self.lights.visit(|_, _, _, _| shine = true);
        shine || !self.environments.is_empty() || self.ambient.as_ref().is_some_and(|ambient| !is_black(ambient.0))
    }
}

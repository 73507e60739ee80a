//! Reads the entities of a world into a scene in eye space.

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::UVec2;
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_asset::Assets;
use halfway_lighting::equations::{self, Light, rgb, vector::add};
use halfway_lighting::lights::{LightFrame, LightQueries, LightSource};
use halfway_lighting::{
    AlphaMode, BackMaterial, Camera, Edges, Encoding, Faces, Fields, GlobalAmbient, Intensity, InvalidValue, Load,
    Material, Propagation, Reflectance, Samples, Shading, Shown, VertexColors, Viewport, current_camera,
    light_direction, light_position, light_up, propagation,
};
use halfway_mesh::{Mesh, Mesh3d, SpawnOrder};
use halfway_texture::{MapKind, Maps, Pyramid, SolidTexture, SurfaceMap, Texture};

use super::environment::OracleEnvironment;
use super::error::{ALWAYS, OracleError, label, plain_name};
use super::maps::MapSource;
use super::shows::Shows;
use super::solid::{Appearance, Color, Solid};
use super::view::{PictureView, affine};

/// The objects, lights and environment of a scene, in eye space.
#[derive(Clone, Debug)]
pub(super) struct OracleScene {
    pub(super) view: PictureView,
    pub(super) shows: Shows,
    pub(super) viewer: equations::Eye<f64>,
    pub(super) background: Color,
    pub(super) samples: Samples,
    pub(super) intensity: Intensity,
    pub(super) encoding: Encoding,
    /// Ga.
    pub(super) global_ambient: Color,
    /// Ga, and La of the lights that do not attenuate it.
    pub(super) ambient: Color,
    pub(super) lights: Vec<Light<f64>>,
    /// The entities and the names of the lights, in their order.
    pub(super) light_names: Vec<(Entity, String)>,
    pub(super) environment: Option<OracleEnvironment>,
    /// From the nearest to the farthest object between the near and the far plane.
    pub(super) depth_span: f64,
    /// In drawing order: opaque ones in spawn order, then blended ones, the farthest first.
    pub(super) solids: Vec<Solid>,
}

impl OracleScene {
    pub(super) fn from_world(world: &mut World, size: UVec2) -> Result<Self, OracleError> {
        require_propagation(world)?;
        let defaults = view_defaults(world, size)?;
        let SceneLights { global_ambient, ambient, lights, names: light_names } = lights(world, &defaults.view)?;
        let mut environment = OracleEnvironment::from_world(world, &defaults.view)?;
        if let (Load::Keep, Some(environment)) = (defaults.load, &mut environment) {
            environment.sky = None;
        }
        let solids = solids(world, &defaults)?;
        let depth_span = depth_span(&defaults.view, &solids);
        let viewer = defaults.camera.eye();
        let Camera { background, samples, intensity, encoding, .. } = defaults.camera;
        let background = rgb(background);
        Ok(Self {
            view: defaults.view,
            shows: Shows::Color,
            viewer,
            background,
            samples,
            intensity,
            encoding,
            global_ambient,
            ambient,
            lights,
            light_names,
            environment,
            depth_span,
            solids,
        })
    }
}

/// From the nearest to the farthest of all corners, as far as the near and the far plane leave them. Renderers take
/// spheres around the objects, which are larger: hence twice as much.
fn depth_span(view: &PictureView, solids: &[Solid]) -> f64 {
    let depths = || solids.iter().flat_map(|solid| &solid.corners).map(|corner| -corner.z);
    let nearest = depths().fold(f64::INFINITY, f64::min).max(view.near());
    let farthest = depths().fold(f64::NEG_INFINITY, f64::max).min(view.far());
    2.0 * (farthest - nearest).max(0.0)
}

fn require_propagation(world: &mut World) -> Result<(), OracleError> {
    let mut roots = world.query_filtered::<(Entity, &Transform, &GlobalTransform), Without<ChildOf>>();
    match propagation(roots.iter(world)) {
        Propagation::Missing(entity) => {
            Err(OracleError::NotPropagated { entity: label(entity, world.get::<Name>(entity)) })
        }
        Propagation::Works | Propagation::Unknown => Ok(()),
    }
}

/// The camera, and its defaults for objects without components of their own.
struct ViewDefaults {
    camera: Camera,
    view: PictureView,
    shading: Shading,
    reflectance: Reflectance,
    edges: Option<Edges>,
    load: Load,
}

/// The components that say how a camera draws.
type CameraComponents<'a> = (
    &'a Camera,
    &'a GlobalTransform,
    Option<&'a Shading>,
    Option<&'a Reflectance>,
    Option<&'a Viewport>,
    Option<&'a Edges>,
    Option<&'a Name>,
);

fn view_defaults(world: &mut World, size: UVec2) -> Result<ViewDefaults, OracleError> {
    let none = |count| if count == 0 { OracleError::NoCamera } else { OracleError::ManyCameras(count) };
    let entity = current_camera(world).map_err(none)?;
    let mut query = world.query::<CameraComponents>();
    let (camera, transform, shading, reflectance, viewport, edges, name) =
        query.get(world, entity).map_err(|_| OracleError::NoCamera)?;
    camera.validate().map_err(|source| OracleError::Invalid { entity: label(entity, name), source })?;
    Ok(ViewDefaults {
        camera: *camera,
        view: PictureView::new(camera, transform, size).ok_or_else(|| bad_transform(entity, name, transform))?,
        shading: shading.copied().unwrap_or_default(),
        reflectance: reflectance.copied().unwrap_or_default(),
        edges: edges.copied(),
        load: viewport.map_or(Load::Clear, |viewport| viewport.load),
    })
}

/// The lights of a scene and its ambient light: Ga, and the sum with La of the lights that do not attenuate it.
struct SceneLights {
    global_ambient: Color,
    ambient: Color,
    lights: Vec<Light<f64>>,
    names: Vec<(Entity, String)>,
}

fn lights(world: &mut World, view: &PictureView) -> Result<SceneLights, OracleError> {
    let global = world.get_resource::<GlobalAmbient>().copied().unwrap_or_default();
    global.validate().map_err(|source| OracleError::Invalid { entity: "resource".into(), source })?;

    let (mut lights, mut names, mut refused) = (Vec::new(), Vec::new(), None);
    let mut queries = SystemState::<LightQueries>::new(world);
    queries.get(world).expect(ALWAYS).visit(|entity, name, light, at| match light.placed(&InEyeSpace { view, at }) {
        Ok(light) => {
            lights.push(light);
            names.push((entity, plain_name(entity, name)));
        }
        Err(source) => {
            refused.get_or_insert_with(|| OracleError::Invalid { entity: label(entity, name), source });
        }
    });
    if let Some(error) = refused {
        return Err(error);
    }
    let ambient = lights.iter().fold(global.ga(), |sum, light| add(sum, light.steady_ambient()));
    Ok(SceneLights { global_ambient: global.ga(), ambient, lights, names })
}

/// The frame of a light's entity in eye space.
struct InEyeSpace<'a> {
    view: &'a PictureView,
    at: &'a GlobalTransform,
}

/// Each checks in f32 whether the position or axis exists; the axis itself is computed in f64.
impl LightFrame for InEyeSpace<'_> {
    fn position(&self) -> Result<[f64; 3], InvalidValue> {
        light_position(self.at).map(|p| self.view.eye_from_point(p.as_dvec3()).to_array())
    }

    fn forward(&self) -> Result<[f64; 3], InvalidValue> {
        light_direction(self.at).map(|_| self.view.eye_from_direction(-affine(self.at).matrix3.z_axis).to_array())
    }

    fn up(&self) -> Result<[f64; 3], InvalidValue> {
        light_up(self.at).map(|_| self.view.eye_from_direction(affine(self.at).matrix3.y_axis).to_array())
    }
}

type Object<'a> = (
    Entity,
    &'a Mesh3d,
    &'a GlobalTransform,
    &'a SpawnOrder,
    Option<&'a Name>,
    Option<&'a Material>,
    Option<&'a BackMaterial>,
    Option<&'a Shading>,
    Option<&'a Reflectance>,
    Option<&'a Faces>,
    Option<&'a AlphaMode>,
    Option<&'a VertexColors>,
    (Option<&'a Maps>, Option<&'a SolidTexture>, Option<&'a Edges>, Option<&'a ChildOf>),
);

fn solids(world: &mut World, defaults: &ViewDefaults) -> Result<Vec<Solid>, OracleError> {
    let mut query = world.query::<Object>();
    let mut shown = SystemState::<Shown>::new(world);
    let shown = shown.get(world).expect(ALWAYS);
    let is_shown = shown.by_entity();
    // A wireframe has no surface.
    let has_surface = |own: Option<&Edges>| own.or(defaults.edges.as_ref()).is_none_or(|edges| edges.surface);
    let meshes = (world.get_resource::<Assets<Mesh>>(), world.get_resource::<Assets<Texture>>());
    let mut objects: Vec<_> =
        query.iter(world).filter(|(entity, .., (_, _, edges, _))| is_shown(*entity) && has_surface(*edges)).collect();
    objects.sort_unstable_by_key(|(entity, _, _, order, ..)| (**order, *entity));
    let world: &World = world;
    let name = |object: &Object| {
        let (entity, _, _, _, own, .., (.., parent)) = object;
        let above = parent.and_then(|parent| world.get::<Name>(parent.parent()));
        let own = plain_name(*entity, *own);
        above.map_or_else(|| own.clone(), |above| format!("{above}/{own}"))
    };
    let solids = objects.into_iter().map(|object| {
        let name = name(&object);
        solid(object, meshes, defaults).map(|solid| solid.named(name))
    });
    let (mut blended, mut solids): (Vec<_>, Vec<_>) =
        solids.collect::<Result<Vec<_>, _>>()?.into_iter().partition(|solid| solid.blend);
    // Stable: at equal depth the first spawned is drawn first.
    blended.sort_by(|a, b| b.centre_depth().total_cmp(&a.centre_depth()));
    solids.extend(blended);
    Ok(solids)
}

fn solid(
    (
        entity,
        mesh,
        transform,
        _,
        name,
        material,
        back,
        shading,
        reflectance,
        faces,
        alpha,
        colors,
        (maps, cut_from, ..),
    ): Object,
    (meshes, textures): (Option<&Assets<Mesh>>, Option<&Assets<Texture>>),
    defaults: &ViewDefaults,
) -> Result<Solid, OracleError> {
    let mesh = meshes.and_then(|meshes| meshes.get(&mesh.0));
    let mesh = mesh.ok_or_else(|| OracleError::MissingMesh { entity: label(entity, name) })?;
    let world_from_model = affine(transform);
    if !world_from_model.is_finite() {
        return Err(bad_transform(entity, name, transform));
    }
    let front = material.copied().unwrap_or_default();
    let shading = shading.copied().unwrap_or(defaults.shading);
    let alpha = alpha.copied().unwrap_or_default();
    front
        .validate()
        .and_then(|()| back.map_or(Ok(()), BackMaterial::validate))
        .and_then(|()| shading.validate())
        .and_then(|()| maps.map_or(Ok(()), check_maps))
        .and_then(|()| alpha.validate())
        .and_then(|()| cut_from.map_or(Ok(()), check_solid))
        .map_err(|source| OracleError::Invalid { entity: label(entity, name), source })?;
    let appearance = Appearance {
        front,
        back: back.map_or(front, |back| back.0),
        reflectance: reflectance.copied().unwrap_or(defaults.reflectance),
        faces: faces.copied().unwrap_or_default(),
        blend: alpha.blends(),
        terms: shading.into(),
        lit: shading != Shading::Unlit,
        maps: maps.map_or_else(Default::default, |maps| {
            let appearance = |map: &SurfaceMap| {
                let there = textures.and_then(|textures| textures.get(&map.texture));
                let pyramid = there.map_or_else(Pyramid::missing, |texture| texture.0.clone());
                MapSource { pyramid, map: map.clone() }
            };
            let mut shown = maps.shown([0, 1].map(|set| mesh.uv_set(set).is_some()));
            if shading == Shading::Unlit {
                MapKind::ALL.into_iter().filter(|kind| !kind.is_of_base_color()).for_each(|k| shown[k as usize] = None);
            }
            shown.map(|map| map.map(appearance))
        }),
        mask: alpha.cutoff().map(f64::from),
        cut_from: cut_from.copied(),
        colored: colors.copied().unwrap_or_default() == VertexColors::Multiply,
    };
    Ok(Solid::new(entity, mesh.clone(), defaults.view.eye_from_model(&world_from_model), &appearance))
}

fn check_maps(maps: &Maps) -> Result<(), InvalidValue> {
    maps.wrong().map_or(Ok(()), |wrong| {
        let field = format!("{}.{}", wrong.kind.name(), wrong.field);
        Fields::for_owner("Maps").number(&field, wrong.value, false, wrong.expected)
    })
}

fn check_solid(solid: &SolidTexture) -> Result<(), InvalidValue> {
    solid.wrong().map_or(Ok(()), |wrong| {
        Fields::for_owner("SolidTexture").number(wrong.field, wrong.value, false, wrong.expected)
    })
}

fn bad_transform(entity: Entity, name: Option<&Name>, transform: &GlobalTransform) -> OracleError {
    let found = format!("{:?}", transform.affine().to_cols_array());
    OracleError::BadTransform { entity: label(entity, name), found }
}

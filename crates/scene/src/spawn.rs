//! From a scene file to entities.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use bevy_color::{ColorToComponents, LinearRgba};
use bevy_ecs::prelude::*;
use bevy_math::{DAffine3, DMat4, DVec3, Mat4, Vec3};
use bevy_transform::components::Transform;
use halfway_asset::{Assets, Handle};
use halfway_lighting::{AlphaMode, BackMaterial, GlobalAmbient, Legend, Material, VertexColors, ViewTolerance};
use halfway_lighting::{Camera, Origin, Projection, Samples, Show, Upright, current_camera, world_place};
use halfway_mesh::{Bounds, Lines, Lines3d, Mesh, Mesh3d, origin_of_box};
use halfway_texture::{Maps, SurfaceMap, TexelImage, TexelMeaning, Texture, UvSet};

use crate::animation::Animated;
use crate::defaults::{default_lights, framing_camera};
use crate::edges::EdgesEntry;
use crate::error::SceneError;
use crate::file::SceneFile;
use crate::import::ModelMaterial;
use crate::import::{camera_place, model_camera};
use crate::light::{AttachEntry, LightEntry};
use crate::light_place::place;
use crate::lights_entry::LightsEntry;
use crate::lines::LineStyleEntry;
use crate::material::MaterialEntry;
use crate::model_animation::ModelAnimation;
use crate::models::{ModelMap, ObjectShape, ShapeLines, ShapePart, Shapes};
use crate::named::NameOrIndex;
use crate::object::ObjectEntry;
use crate::part_of_light::{self, LightSource, LitEntities, PartOfLight, insert_light};
use crate::placement::Placement;
use crate::view::CameraEntry;
use crate::viewport::insert_layers;
use halfway_lighting::LightComponent;

/// The entities of a scene that was spawned.
#[derive(Clone, Debug)]
pub struct Spawned {
    /// The camera, with the scene's [`Shading`](halfway_lighting::Shading) and
    /// [`Reflectance`](halfway_lighting::Reflectance).
    pub camera: Entity,
    /// All cameras that share the picture, in the file's order, `camera` first; else `camera` alone.
    pub cameras: Vec<Entity>,
    /// The entity of every object of the file, in its order: it carries the object's `Name` and its frame. A shape of
    /// one part has its mesh on it, a model of several parts has one child for each.
    pub objects: Vec<Entity>,
    /// The lights: the scene's, in its order; or the models' own; or the default ones.
    pub lights: Vec<Entity>,
    /// The light from all directions, if the scene has one.
    pub environment: Option<Entity>,
    /// The scene's own warnings, and those of its models' repairs and omissions, one sentence each, with the file's
    /// name.
    pub warnings: Vec<String>,
    /// Whether the camera, an object, its model or a light changes in time; [`AnimationPlugin`](crate::AnimationPlugin) plays it.
    pub is_animated: bool,
    /// The [`Origin`] of the camera and of all that is near it; 0 unless the scene is far away beside its size, as at map
    /// coordinates.
    pub origin: DVec3,
    /// The part of its light that the scene asks for.
    pub part: PartOfLight,
}

impl Spawned {
    /// Moves an object to where the matrix takes it. Returns whether it could: what shears is two entities, and has to be
    /// spawned again; and so has an object that there is not.
    pub fn place_object(&self, index: usize, world_from_object: &DMat4, world: &mut World) -> bool {
        let Some(&entity) = self.objects.get(index) else { return false };
        if world.get::<ChildOf>(entity).is_some() {
            return false;
        }
        let Place { placement: Placement { outer, inner: None }, origin } = self.place(world_from_object) else {
            return false;
        };
        insert_place(&mut world.entity_mut(entity), outer, origin);
        true
    }

    /// A place in the world, near the scene's origin or not.
    fn place(&self, matrix: &DMat4) -> Place {
        Place::near(self.origin, matrix)
    }

    /// Gives a light the place and the colours of an entry. Returns whether it could: a light of another kind, or one that
    /// is attached to something else, has to be spawned again.
    pub fn place_light(&self, index: usize, entry: &LightEntry, world: &mut World) -> bool {
        let Some(&entity) = self.lights.get(index) else { return false };
        let origin = origin_near(self.origin, entry);
        let (component, transform) = place(entry, origin);
        let is_kind = world.get_entity(entity).is_ok_and(|light| component.is_kind_of(light));
        let is_attached = world.get::<ChildOf>(entity).is_some() || entry.attach != AttachEntry::World;
        let is_plain = entry.animation.is_empty() && world.get::<Animated>(entity).is_none() && entry.layers.is_none();
        if !is_kind || is_attached || !is_plain {
            return false;
        }
        let mut entity = world.entity_mut(entity);
        insert_place(&mut entity, transform, origin);
        insert_light(component, &mut entity);
        true
    }

    /// Shows a part of the scene's light alone, or all of it again. The first call remembers the whole: materials,
    /// lights, environment and backgrounds that change later come back as they were then.
    ///
    /// - Only components and resources change, so that every renderer shows the part: coefficients of materials that
    ///   have no part in it are black, and so are the global ambient light and the background; lights and environments
    ///   are hidden.
    /// - Lines along edges, legends and backgrounds that are transparent stay as they are.
    ///
    /// ```
    /// use std::path::Path;
    ///
    /// use bevy_app::App;
    /// use halfway_lighting::{LinearRgba, Material, Term};
    /// use halfway_mesh::MeshPlugin;
    /// use halfway_scene::{PartOfLight, SceneFile, spawn};
    ///
    /// let mut app = App::new();
    /// app.add_plugins(MeshPlugin);
    /// let scene = SceneFile::from_json(r#"{"objects": [{"mesh": {"box": {}}, "material": "brass"}]}"#, "a box")?;
    /// let spawned = spawn(&scene, Path::new(""), app.world_mut())?;
    /// let ball = spawned.objects[0];
    /// spawned.show_light(PartOfLight { term: Some(Term::Specular), ..PartOfLight::default() }, app.world_mut());
    /// assert_eq!(app.world().get::<Material>(ball).unwrap().diffuse, LinearRgba::BLACK);
    /// spawned.show_light(PartOfLight::default(), app.world_mut());
    /// assert_eq!(app.world().get(ball), Some(&Material::BRASS));
    /// # Ok::<(), halfway_scene::SceneError>(())
    /// ```
    pub fn show_light(&self, part: PartOfLight, world: &mut World) {
        let Self { cameras, objects, lights, .. } = self;
        part_of_light::show(part, LitEntities { cameras, objects, lights }, world);
    }

    /// Gives the camera the place and the projection of an entry. Returns whether it could: one that frames the objects,
    /// or has more keys than these, has to be spawned again.
    pub fn place_camera(&self, entry: &CameraEntry, world: &mut World) -> bool {
        let plain = CameraEntry { name: entry.name.clone(), legend: None, ..placed_as(entry) };
        if plain != *entry || world.get::<Animated>(self.camera).is_some() {
            return false;
        }
        let Some(mut camera) = world.get_mut::<Camera>(self.camera) else { return false };
        camera.projection = entry.projection();
        let origin = if entry.origin() == DVec3::ZERO { DVec3::ZERO } else { self.origin };
        insert_place(&mut world.entity_mut(self.camera), entry.transform(origin), origin);
        true
    }
}

/// The entry with its place and its projection alone.
fn placed_as(entry: &CameraEntry) -> CameraEntry {
    let CameraEntry { position, target, up, fov_y_deg, near, shift, aspect, pixel_aspect, zoom, height, far, .. } =
        *entry;
    let intrinsics = entry.intrinsics;
    CameraEntry {
        position,
        target,
        up,
        fov_y_deg,
        near,
        shift,
        aspect,
        pixel_aspect,
        zoom,
        height,
        far,
        intrinsics,
        ..CameraEntry::default()
    }
}

/// Puts a scene into a world: camera, objects, lights, and the [`GlobalAmbient`] resource; and [`ViewTolerance`] and
/// [`Legend`], where the scene has one.
///
/// Paths in the scene are relative to `base_dir`, the folder of the scene file. The size of the picture is
/// not put into the world: it belongs to the target.
///
/// - Of several cameras those with a `viewport` are spawned, to share the picture; where none has one, the first.
///   [`spawn_seen_from`] chooses one, which then has the picture for itself.
/// - Where the scene has no camera, one is made that frames all objects ([`framing_camera`]).
/// - Where an object has no material, its model's own materials are used, translated by
///   [`import`](crate::import), with their double-sidedness, blending and masks unless the object says otherwise.
/// - Of the animations of a model (glTF) the one that [`SceneFile::animation`] names, else the first is played, where the
///   App has an [`AnimationPlugin`](crate::AnimationPlugin); otherwise its parts are in the pose of the file.
/// - With a model's own materials come their images, where the world has `Assets<Texture>`. An image that cannot be
///   read gives a warning and is replaced by a checker.
/// - Where the scene has no `lights`, the models' own lights shine (`KHR_lights_punctual`), attached to their object;
///   where there are none either, the [`default_lights`]. An empty list of lights is a list: nothing shines.
/// - A transform that shears becomes a parent and a child, since a `Transform` cannot hold it.
///
/// Equal shapes share their meshes, and so do the parts of a model that show the same mesh of its file.
///
/// # Errors
/// Errors of [`SceneFile::validate`], models that cannot be loaded, [`SceneError::NoMeshAssets`]
/// and [`SceneError::NoTextureAssets`]. Nothing is
/// spawned then.
pub fn spawn(scene: &SceneFile, base_dir: &Path, world: &mut World) -> Result<Spawned, SceneError> {
    spawn_seen(scene, base_dir, None, world)
}

/// [`spawn`](fn@spawn) with the camera of this name, or at this place, counted from 0, among all cameras: the scene's
/// ([`SceneFile::all_cameras`]), then those of its models (glTF), object by object.
///
/// # Errors
/// As [`spawn`](fn@spawn), and [`SceneError::NoCamera`], which lists the cameras.
pub fn spawn_seen_from(
    scene: &SceneFile,
    base_dir: &Path,
    camera: &str,
    world: &mut World,
) -> Result<Spawned, SceneError> {
    spawn_seen(scene, base_dir, Some(camera), world)
}

fn spawn_seen(
    scene: &SceneFile,
    base_dir: &Path,
    wanted: Option<&str>,
    world: &mut World,
) -> Result<Spawned, SceneError> {
    scene.validate()?;
    if !has_mesh_assets(world) {
        return Err(SceneError::NoMeshAssets);
    }
    let has_images = |object: &ObjectEntry| object.maps.is_some() || object.scalars.is_some();
    if scene.objects.iter().any(has_images) && !world.contains_resource::<Assets<Texture>>() {
        return Err(SceneError::NoTextureAssets);
    }
    let mut shapes = Shapes::new(base_dir, scene.animation.as_ref());
    let objects = scene
        .objects
        .iter()
        .enumerate()
        .map(|(i, object)| Ok((object, shapes.load_once(object, i)?)))
        .collect::<Result<Vec<_>, SceneError>>()?;
    shapes.chosen.check()?;

    let sharing = scene.all_cameras().filter(|camera| wanted.is_none() && camera.viewport.is_some());
    let sharing: Vec<_> = sharing.cloned().map(SeenFrom::Entry).collect();
    let is_shared = !sharing.is_empty();
    let seen = if is_shared { sharing } else { vec![SeenFrom::choose(scene, &objects, wanted)?] };
    if !seen.iter().any(|seen| matches!(seen, SeenFrom::Model { .. })) {
        shapes.warnings.append(&mut shapes.unused_cameras);
    }

    let source = chosen_light(scene, &objects)?;

    world.insert_resource(GlobalAmbient(LinearRgba::from_f32_array_no_alpha(scene.ambient)));
    if let Some(tolerance) = scene.tolerance {
        world.insert_resource(ViewTolerance(tolerance));
    }
    let number = |number| is_shared.then_some(number);
    let origin = seen[0].origin(&objects);
    let each = seen.iter().enumerate().map(|(i, seen)| spawn_camera(scene, &objects, (seen, number(i)), origin, world));
    let cameras: Vec<Entity> = each.collect();
    let camera = cameras[0];
    let (mut handles, mut textures) = (Handles::new(), TextureHandles::new());
    let frames = objects
        .iter()
        .enumerate()
        .map(|(i, (object, shape))| spawn_object((object, i), shape, (&mut handles, &mut textures), origin, world))
        .collect::<Vec<_>>();
    let lights = spawn_lights(scene, camera, (&objects, &frames), origin, world);
    if let [SeenFrom::Model { index: [object, index], .. }] = seen[..]
        && let Some(mut animation) = world.get_mut::<ModelAnimation>(frames[object])
    {
        animation.camera = Some((camera, index, DMat4::from_translation(-origin) * world_from_model(&objects[object])));
    }
    let mut warnings = [scene.warnings.clone(), shapes.warnings].concat();
    hang_maps(scene, base_dir, &frames, &mut warnings, world);
    let environment = scene.environment.as_ref().map(|environment| environment.spawn(base_dir, &mut warnings, world));
    let legend =
        seen.iter().find_map(|seen| if let SeenFrom::Entry(entry) = seen { entry.legend.as_deref() } else { None });
    if let Some(title) = legend {
        spawn_legend(title, &objects, &mut warnings, world);
    }
    let is_animated = [&cameras[..], &frames, &lights].concat().iter().any(|entity| is_animated(*entity, world));
    let part = PartOfLight { term: scene.only, source };
    let spawned =
        Spawned { camera, cameras, objects: frames, lights, environment, warnings, is_animated, origin, part };
    spawned.show_light(part, world);
    Ok(spawned)
}

/// Whether there is somewhere to keep meshes, and lines.
pub(crate) fn has_mesh_assets(world: &World) -> bool {
    world.contains_resource::<Assets<Mesh>>() && world.contains_resource::<Assets<Lines>>()
}

pub(crate) type Object<'a> = (&'a ObjectEntry, Rc<ObjectShape>);

/// From the places of a model, which are counted from its origin, into the world.
fn world_from_model((object, shape): &Object) -> DMat4 {
    object.transform.matrix() * DMat4::from_translation(shape.origin)
}

/// The handle of every mesh that has been added, by where its data is: meshes that share data share a handle. All of
/// them outlive this map, in the shapes.
pub(crate) type Handles = HashMap<*const Vec3, Handle<Mesh>>;

/// The same of textures.
pub(crate) type TextureHandles = HashMap<*const [f32; 4], Handle<Texture>>;

/// The camera that is drawn.
enum SeenFrom {
    /// One of the scene's own, or one that frames everything.
    Entry(CameraEntry),
    /// One of a model's.
    Model { name: String, projection: Projection, world_from_camera: DMat4, index: [usize; 2] },
}

impl SeenFrom {
    /// The camera of this name or number; without one, the scene's first, or one that frames everything.
    fn choose(scene: &SceneFile, objects: &[Object], wanted: Option<&str>) -> Result<Self, SceneError> {
        let Some(wanted) = wanted else {
            return Ok(Self::Entry(scene.all_cameras().next().cloned().unwrap_or_else(|| {
                let [width, height] = scene.size;
                let (origin, outline) = outline_of(objects);
                let mut camera = framing_camera(outline, width as f32 / height as f32);
                for point in [&mut camera.position, &mut camera.target] {
                    *point = (DVec3::from(*point) + origin).to_array();
                }
                camera
            })));
        };
        let of_models = || {
            let cameras = |(i, (_, shape)): (usize, &'_ Object)| (0..shape.cameras.len()).map(move |k| (i, k));
            objects.iter().enumerate().flat_map(cameras)
        };
        let names: Vec<Option<&str>> = scene
            .all_cameras()
            .map(|camera| camera.name.as_deref())
            .chain(
                of_models().map(|(i, k)| Some(objects[i].1.cameras[k].name.as_str()).filter(|name| !name.is_empty())),
            )
            .collect();
        let Some(found) = NameOrIndex::from(wanted).find_by_text(names.iter().copied()) else {
            let known = listed(&names, "neither the scene nor its models have any");
            return Err(SceneError::NoCamera { wanted: wanted.to_owned(), known });
        };
        let own = scene.all_cameras().count();
        if let Some(entry) = scene.all_cameras().nth(found) {
            return Ok(Self::Entry(entry.clone()));
        }
        // The list has it.
        let (i, k) = of_models().nth(found - own).unwrap_or_default();
        let (_, shape) = &objects[i];
        let source = &shape.cameras[k];
        let (projection, place) = model_camera(source).map_err(|error| SceneError::ModelValue {
            key: format!("objects[{i}].mesh.path"),
            at: format!("camera {:?}", source.name),
            source: error,
        })?;
        let world_from_camera = world_from_model(&objects[i]) * place.to_matrix().as_dmat4();
        Ok(Self::Model { name: source.name.clone(), projection, world_from_camera, index: [i, k] })
    }

    /// The origin of a scene that is seen from here.
    fn origin(&self, objects: &[Object]) -> DVec3 {
        match self {
            Self::Entry(entry) if entry.framing().is_none() => entry.origin(),
            Self::Entry(_) | Self::Model { .. } => outline_of(objects).0,
        }
    }
}

/// Spawns a camera; with a number, it is one of several that share the picture.
fn spawn_camera(
    scene: &SceneFile,
    objects: &[Object],
    (seen, number): (&SeenFrom, Option<usize>),
    origin: DVec3,
    world: &mut World,
) -> Entity {
    let default = CameraEntry::default();
    let (entry, name, projection, place) = match seen {
        SeenFrom::Entry(entry) => (entry, entry.name.as_deref(), entry.projection(), entry.transform(origin)),
        SeenFrom::Model { name, projection, world_from_camera, .. } => {
            let place = camera_place(&(DMat4::from_translation(-origin) * *world_from_camera).as_mat4());
            (&default, Some(name.as_str()).filter(|name| !name.is_empty()), *projection, place)
        }
    };
    let camera = Camera {
        projection,
        background: LinearRgba::from_f32_array_no_alpha(scene.background),
        background_below: scene.background_below.map(LinearRgba::from_f32_array_no_alpha),
        background_opacity: scene.background_opacity,
        viewer: scene.viewer,
        samples: Samples::from_count(entry.samples.unwrap_or(scene.samples)).unwrap_or_default(),
        encoding: scene.output,
        intensity: scene.intensity,
    };
    let viewport = number.zip(entry.viewport).map(|(number, viewport)| viewport.component(number));
    let part = viewport.and_then(|viewport| viewport.rectangle(scene.size));
    let [width, height] = part.map_or(scene.size, |[_, _, width, height]| [width, height]);
    let framing = match seen {
        SeenFrom::Entry(entry) => entry.framing(),
        SeenFrom::Model { .. } => None,
    };
    let (camera, place) = match framing {
        Some(framing) => framing.camera(camera, outline_of(objects).1, width as f32 / height as f32),
        None => (camera, place),
    };
    let view = (entry.shading.unwrap_or(scene.shading), entry.reflectance.unwrap_or(scene.reflectance));
    let name = Name::new(name.unwrap_or("camera").to_owned());
    let mut entity = world.spawn((name, camera, view));
    insert_place(&mut entity, place, origin);
    insert_some(&mut entity, Animated::camera(entry));
    insert_some(&mut entity, scene.edges.as_ref().map(EdgesEntry::component));
    insert_some(&mut entity, entry.tolerance);
    insert_some(&mut entity, viewport);
    insert_layers(&mut entity, entry.layers.as_ref());
    insert_some(&mut entity, scene.line_style.as_ref().map(LineStyleEntry::component));
    insert_some(&mut entity, Some(scene.show).filter(Show::any));
    insert_some(&mut entity, Some(Upright(entry.up.into())).filter(|upright| *upright != Upright::default()));
    entity.id()
}

fn is_animated(entity: Entity, world: &World) -> bool {
    // The frame of an object that shears is its inner one, and does not move.
    world.get::<Animated>(entity).is_some() || world.get::<ModelAnimation>(entity).is_some()
}

/// Above this number of vertices the corners of boxes stand for them.
const FRAMED_VERTICES: usize = 1 << 20;

/// The vertices of all parts in the world, or, where they are many, the corners of the boxes around the parts; and the
/// origin from which they are counted.
fn outline_of(objects: &[Object]) -> (DVec3, Vec<Vec3>) {
    let mut outlined = Vec::new();
    for object in objects {
        let (_, shape) = object;
        let world_from_model = world_from_model(object);
        let place = |model_from_part: &Mat4| DAffine3::from_mat4(world_from_model * model_from_part.as_dmat4());
        outlined.extend(shape.parts.iter().map(|part| (Outlined::Mesh(&part.mesh), place(&part.object_from_part))));
        outlined.extend(shape.lines.iter().map(|part| (Outlined::Lines(&part.lines), place(&part.object_from_part))));
    }
    let (min, max) = box_around(&outlined);
    let origin = origin_of_box(min, max);
    (origin, outline_around(&outlined, origin))
}

/// A shape that is framed.
#[derive(Clone, Copy)]
enum Outlined<'a> {
    Mesh(&'a Mesh),
    Lines(&'a Lines),
}

impl Outlined<'_> {
    fn count(self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.positions().len(),
            Self::Lines(lines) => 2 * lines.segments().len() + lines.points().len(),
        }
    }

    fn bounds(self) -> Bounds {
        match self {
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Lines(lines) => lines.bounds(),
        }
    }

    fn extend(self, outline: &mut Vec<Vec3>, to_world: impl Fn(Vec3) -> Vec3) {
        match self {
            Self::Mesh(mesh) => {
                // A vertex that no triangle uses counts only where it makes no difference.
                let Bounds { min, max } = mesh.bounds();
                let drawn = mesh.positions().iter().filter(|p| p.cmpge(min).all() && p.cmple(max).all());
                outline.extend(drawn.copied().map(to_world));
            }
            Self::Lines(lines) => {
                let used = lines.segments().as_flattened().iter().chain(lines.points());
                outline.extend(used.map(|&vertex| to_world(lines.positions()[vertex as usize])));
            }
        }
    }
}

/// The box around the boxes of all shapes in the world.
fn box_around(shapes: &[(Outlined, DAffine3)]) -> (DVec3, DVec3) {
    let of_shape = |(shape, world_from_shape): &(Outlined, DAffine3)| {
        let world_from_shape = *world_from_shape;
        corners(shape.bounds()).map(move |corner| world_from_shape.transform_point3(corner.as_dvec3()))
    };
    let corners = shapes.iter().flat_map(of_shape);
    corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}

/// The vertices of all shapes in the world, or, where they are many, the corners of the boxes around them; counted from
/// an origin.
fn outline_around(shapes: &[(Outlined, DAffine3)], origin: DVec3) -> Vec<Vec3> {
    let vertices: usize = shapes.iter().map(|(shape, _)| shape.count()).sum();
    let mut outline = Vec::new();
    for (shape, world_from_shape) in shapes {
        let to_world = |p: Vec3| (world_from_shape.transform_point3(p.as_dvec3()) - origin).as_vec3();
        if vertices <= FRAMED_VERTICES {
            shape.extend(&mut outline, to_world);
        } else {
            outline.extend(corners(shape.bounds()).map(to_world));
        }
    }
    outline.retain(|point| point.is_finite());
    outline
}

/// The vertices of all meshes, lines and points in a world, placed by their `Transform`s and those above them, or, where
/// they are more than a million, the corners of the boxes around the shapes: what a [`Framing`](halfway_lighting::Framing)
/// frames. They are counted from the camera's [`Origin`], where it has one.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::Vec3;
/// use halfway_asset::Assets;
/// use halfway_lighting::{Camera, Framing, View};
/// use halfway_mesh::{Cuboid, Mesh, Mesh3d, MeshPlugin};
/// use halfway_scene::outline;
///
/// let mut app = App::new();
/// app.add_plugins(MeshPlugin);
/// let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::default());
/// app.world_mut().spawn(Mesh3d(mesh));
/// let framing = Framing::new(View::ISO, Vec3::Y);
/// let camera = framing.camera(Camera::default(), outline(app.world_mut()), 16.0 / 9.0);
/// app.world_mut().spawn(camera);
/// ```
pub fn outline(world: &mut World) -> Vec<Vec3> {
    let camera = current_camera(world).ok().and_then(|camera| world.get::<Origin>(camera));
    let origin = camera.copied().unwrap_or_default().0;
    let mut objects = world.query::<(Entity, &Mesh3d)>();
    let mut strokes = world.query::<(Entity, &Lines3d)>();
    let (meshes, lines) = (world.get_resource::<Assets<Mesh>>(), world.get_resource::<Assets<Lines>>());
    let of_mesh =
        |(entity, mesh): (Entity, &Mesh3d)| Some((Outlined::Mesh(meshes?.get(&mesh.0)?), world_place(entity, world)));
    let of_lines = |(entity, shown): (Entity, &Lines3d)| {
        Some((Outlined::Lines(lines?.get(&shown.0)?), world_place(entity, world)))
    };
    let shapes: Vec<_> =
        objects.iter(world).filter_map(of_mesh).chain(strokes.iter(world).filter_map(of_lines)).collect();
    outline_around(&shapes, origin)
}

fn corners(Bounds { min, max }: Bounds) -> impl Iterator<Item = Vec3> {
    (0..8).map(move |i| {
        let pick = |axis: usize| if i & (1 << axis) == 0 { min[axis] } else { max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}

/// A place in the world: as transforms, counted from an origin.
struct Place {
    placement: Placement,
    origin: DVec3,
}

impl Place {
    /// Counted from the origin of the scene, if it is nearer to that than to 0.
    fn near(origin: DVec3, matrix: &DMat4) -> Self {
        let translation = matrix.w_axis.truncate();
        let origin = if translation.distance(origin) < translation.length() { origin } else { DVec3::ZERO };
        let counted = DMat4 { w_axis: (translation - origin).extend(1.0), ..*matrix };
        Self { placement: Placement::from_matrix(&counted), origin }
    }
}

/// The origin from which the position of a light is counted: that of the scene, if it is nearer to that than to 0.
fn origin_near(origin: DVec3, entry: &LightEntry) -> DVec3 {
    let [x, y, z, w] = entry.position;
    let point = DVec3::new(x, y, z) / w;
    let is_near = entry.attach == AttachEntry::World && w != 0.0 && point.distance(origin) < point.length();
    if is_near { origin } else { DVec3::ZERO }
}

/// Places an entity. Without an origin there is no component either.
fn insert_place(entity: &mut EntityWorldMut, transform: Transform, origin: DVec3) {
    entity.insert(transform);
    if origin != DVec3::ZERO {
        entity.insert(Origin(origin));
    } else if entity.contains::<Origin>() {
        entity.remove::<Origin>();
    }
}

/// Spawns an object and gives the entity of its frame.
fn spawn_object(
    (object, index): (&ObjectEntry, usize),
    shape: &ObjectShape,
    (handles, textures): (&mut Handles, &mut TextureHandles),
    origin: DVec3,
    world: &mut World,
) -> Entity {
    let name = object.name.clone().unwrap_or_else(|| format!("objects[{index}]"));
    let frame = spawn_frame(&Place::near(origin, &object.transform.matrix()), None, &name, world);
    let is_near = shape.origin == DVec3::ZERO;
    match (shape.parts.as_slice(), shape.lines.as_slice()) {
        _ if shape.animations.is_some() => drop(spawn_parts(object, frame, shape, (handles, textures), world)),
        ([part], []) if is_near && part.object_from_part == Mat4::IDENTITY => {
            dress_whole(object, part, (handles, textures), frame, world);
        }
        ([], [lines]) if is_near && lines.object_from_part == Mat4::IDENTITY => {
            dress_lines(object, lines, frame, world);
        }
        _ => {
            spawn_parts(object, frame, shape, (handles, textures), world);
        }
    }
    insert_some(&mut world.entity_mut(frame), Animated::object(&object.transform, &object.animation));
    insert_layers(&mut world.entity_mut(frame), object.layers.as_ref());
    frame
}

/// Spawns the parts of a shape as children of its frame, and gives their entities.
pub(crate) fn spawn_parts(
    object: &ObjectEntry,
    frame: Entity,
    shape: &ObjectShape,
    (handles, textures): (&mut Handles, &mut TextureHandles),
    world: &mut World,
) -> Vec<Entity> {
    // A moving part may shear at some time.
    let place = |object_from_part: &Mat4| {
        let placement = Placement::from_matrix(&object_from_part.as_dmat4());
        let inner = shape.animations.as_ref().map(|_| placement.inner.unwrap_or_default());
        Place { placement: Placement { inner: inner.or(placement.inner), ..placement }, origin: shape.origin }
    };
    let spawn_part = |(i, part): (usize, &ShapePart)| {
        let name = if part.name.is_empty() { format!("parts[{i}]") } else { part.name.clone() };
        let entity = spawn_frame(&place(&part.object_from_part), Some(frame), &name, world);
        dress_whole(object, part, (handles, textures), entity, world);
        entity
    };
    let parts: Vec<Entity> = shape.parts.iter().enumerate().map(spawn_part).collect();
    let spawn_lines = |(i, lines): (usize, &ShapeLines)| {
        let name = if lines.name.is_empty() { format!("lines[{i}]") } else { lines.name.clone() };
        let entity = spawn_frame(&place(&lines.object_from_part), Some(frame), &name, world);
        dress_lines(object, lines, entity, world);
        entity
    };
    let lines: Vec<Entity> = shape.lines.iter().enumerate().map(spawn_lines).collect();
    if let Some((animations, clip)) = &shape.animations {
        world.entity_mut(frame).insert(ModelAnimation {
            animations: Arc::clone(animations),
            clip: *clip,
            parts: parts.clone(),
            lines: lines.clone(),
            lights: Vec::new(),
            camera: None,
            normals: object.normals,
            moves_vertices: object.displacement.is_none() && object.scalars.is_none(),
            shown: None,
        });
    }
    [parts, lines].concat()
}

/// Gives an entity lines and points and their looks.
fn dress_lines(object: &ObjectEntry, part: &ShapeLines, entity: Entity, world: &mut World) {
    let handle = world.resource_mut::<Assets<Lines>>().add(part.lines.clone());
    let entity = &mut world.entity_mut(entity);
    entity.insert((Lines3d(handle), material_of(object, part.own)));
    insert_some(entity, object.reflectance);
    insert_some(entity, object.line_style.as_ref().map(LineStyleEntry::component));
    insert_looks(object, part.own, entity);
}

/// The object's material, else the model's own, else the default one.
fn material_of(object: &ObjectEntry, own: Option<ModelMaterial>) -> Material {
    let given = object.material.as_ref().and_then(MaterialEntry::material);
    let own = own.filter(|_| object.material.is_none());
    given.or(own.map(|own| own.material)).unwrap_or_default()
}

/// The use of vertex colours and of opacity.
fn insert_looks(object: &ObjectEntry, own: Option<ModelMaterial>, entity: &mut EntityWorldMut) {
    // The default needs no component.
    insert_some(entity, Some(object.vertex_colors).filter(|colors| *colors != VertexColors::default()));
    let own = own.filter(|_| object.material.is_none());
    let alpha = alpha(object, own.map(|own| own.alpha).unwrap_or_default());
    insert_some(entity, Some(alpha).filter(|alpha| *alpha != AlphaMode::default()));
    insert_some(entity, object.shading.or(own.and_then(|own| own.shading)));
}

/// Gives an entity a part: its mesh, its looks and the images of its own material.
fn dress_whole(
    object: &ObjectEntry,
    part: &ShapePart,
    (handles, textures): (&mut Handles, &mut TextureHandles),
    entity: Entity,
    world: &mut World,
) {
    let mesh = handles
        .entry(part.mesh.positions().as_ptr())
        .or_insert_with(|| world.resource_mut::<Assets<Mesh>>().add(part.mesh.clone()))
        .clone();
    dress(object, part, mesh, &mut world.entity_mut(entity));
    if part.scalars.is_some() || object.material.is_none() && object.maps.is_none() {
        hang_own_maps(part, textures, entity, world);
    }
}

/// An entity at a placement; the inner of two where it shears.
fn spawn_frame(place: &Place, parent: Option<Entity>, name: &str, world: &mut World) -> Entity {
    let Place { placement, origin } = place;
    let mut spawn_at = |transform: Transform, origin: DVec3, parent: Option<Entity>| {
        let mut entity = world.spawn_empty();
        insert_place(&mut entity, transform, origin);
        insert_some(&mut entity, parent.map(ChildOf));
        entity.id()
    };
    let outer = spawn_at(placement.outer, *origin, parent);
    let frame = placement.inner.map_or(outer, |inner| spawn_at(inner, DVec3::ZERO, Some(outer)));
    world.entity_mut(frame).insert(Name::new(name.to_owned()));
    frame
}

/// Gives a part its mesh and its looks.
fn dress(object: &ObjectEntry, part: &ShapePart, mesh: Handle<Mesh>, entity: &mut EntityWorldMut) {
    let own = if object.material.is_some() { None } else { part.own };
    let faces = object.faces.or(own.map(|own| own.faces)).unwrap_or_default();
    entity.insert((Mesh3d(mesh), material_of(object, part.own), faces));
    insert_some(entity, object.back_material.as_ref().and_then(MaterialEntry::material).map(BackMaterial));
    insert_some(entity, object.tolerance);
    insert_some(entity, object.reflectance);
    // All parts are cut from one solid.
    insert_some(entity, object.edges.as_ref().map(EdgesEntry::component));
    insert_some(entity, object.solid.as_ref().map(|solid| solid.for_part(&part.object_from_part)));
    insert_looks(object, part.own, entity);
}

/// The effect of an object's opacity, by its keys `mask` and `blend` and by its model's own material.
fn alpha(object: &ObjectEntry, own: AlphaMode) -> AlphaMode {
    // An object that asks for blending is not cut out by its model's material.
    let of_model = own.cutoff().filter(|_| object.blend != Some(true));
    let cutoff = object.mask.or(of_model).filter(|cutoff| *cutoff > 0.0);
    AlphaMode::new(cutoff, object.blend.unwrap_or(own.blends()))
}

fn insert_some(entity: &mut EntityWorldMut, component: Option<impl Bundle>) {
    if let Some(component) = component {
        entity.insert(component);
    }
}

/// Gives a part the images of its model's material, where the world keeps images.
fn hang_own_maps(part: &ShapePart, textures: &mut TextureHandles, entity: Entity, world: &mut World) {
    let Some(mut assets) = world.get_resource_mut::<Assets<Texture>>() else { return };
    let mut maps = Maps::default();
    for ModelMap { kind, texture, map } in &part.maps {
        let handle = textures.entry(texture.0.texels().as_ptr()).or_insert_with(|| assets.add(texture.clone()));
        maps.set(*kind, Some(SurfaceMap { texture: handle.clone(), ..map.clone() }));
    }
    if maps.iter().next().is_some() {
        world.entity_mut(entity).insert(maps);
    }
}

/// The textures of a scene's own images, by path and by the meaning of their numbers.
type SceneTextures<'a> = HashMap<(&'a Path, TexelMeaning), Handle<Texture>>;

/// Gives objects, or all parts of their models, their images. Each file is read once for each meaning; an
/// unreadable one is a warning, and a checker is shown in its place.
fn hang_maps(scene: &SceneFile, base_dir: &Path, frames: &[Entity], warnings: &mut Vec<String>, world: &mut World) {
    let mut handles = SceneTextures::new();
    for (index, (object, &frame)) in scene.objects.iter().zip(frames).enumerate() {
        let Some(entries) = &object.maps else { continue };
        let mut maps = Maps::default();
        for (kind, entry) in entries.iter() {
            let texture = handles.entry((&entry.path, kind.meaning())).or_insert_with(|| {
                let loaded = halfway_texture::load(&base_dir.join(&entry.path), kind.meaning());
                let kind = kind.name();
                if let Some(what) = loaded.as_ref().ok().and_then(TexelImage::reduction) {
                    warnings.push(format!("objects[{index}].maps.{kind}: {} {what}", entry.path.display()));
                }
                let texture = loaded.map_or_else(
                    |error| {
                        warnings.push(format!("objects[{index}].maps.{kind}: {error}; a checker is shown"));
                        Texture::missing()
                    },
                    Texture::from,
                );
                world.resource_mut::<Assets<Texture>>().add(texture)
            });
            maps.set(kind, Some(entry.with_texture(texture.clone())));
        }
        let mut below = vec![frame];
        let (mut shown, mut without) = (0, 0);
        while let Some(entity) = below.pop() {
            below.extend(world.get::<Children>(entity).iter().flat_map(|children| children.iter()));
            if let Some(Mesh3d(mesh)) = world.get::<Mesh3d>(entity) {
                let mesh = world.resource::<Assets<Mesh>>().get(mesh);
                let has = |set: UvSet| mesh.is_some_and(|mesh| mesh.uv_set(set as usize).is_some());
                let has_all = maps.iter().all(|(_, map)| has(map.uv_set));
                (shown, without) = (shown + 1, without + usize::from(!has_all));
                world.entity_mut(entity).insert(maps.clone());
            }
        }
        if without > 0 {
            warnings.push(format!(
                "objects[{index}].maps: {without} of {shown} meshes have no texture coordinates for all of them, and do not show those"
            ));
        }
    }
}

/// Inserts the legend of the first numbers that are shown.
fn spawn_legend(title: &str, objects: &[Object], warnings: &mut Vec<String>, world: &mut World) {
    let mut shown = objects.iter().flat_map(|(_, shape)| &shape.parts).filter_map(|part| part.scalars);
    let first = shown.next();
    let Some((first, range)) = first.and_then(|first| Some((first, first.range?))) else {
        warnings.push("legend: there are no numbers to explain; expected `scalars` on an object".to_owned());
        return;
    };
    if shown.any(|other| other != first) {
        warnings
            .push("legend: it is that of the first object with `scalars`; others have another map or range".to_owned());
    }
    world.insert_resource(Legend { title: title.to_owned(), range, colors: first.map.colors() });
}

/// The light that the scene draws alone, if it does.
fn chosen_light(scene: &SceneFile, objects: &[Object]) -> Result<LightSource, SceneError> {
    let Some(wanted) = &scene.light else { return Ok(LightSource::Anywhere) };
    let entries = scene.lights.as_ref().map(LightsEntry::entries);
    let of_models = || objects.iter().flat_map(|(_, shape)| &shape.lights).map(|light| Some(light.name.clone()));
    let mut names: Vec<Option<String>> = match &entries {
        Some(entries) => entries.iter().map(|light| light.name.clone()).collect(),
        None => of_models().collect(),
    };
    if entries.is_none() && names.is_empty() {
        names = default_lights().iter().map(|light| light.name.clone()).collect();
    }
    let names: Vec<Option<&str>> = names.iter().map(|name| name.as_deref().filter(|name| !name.is_empty())).collect();
    // Messages call a light without a name so.
    let place = || (0..names.len()).position(|i| *wanted == NameOrIndex::Name(format!("lights[{i}]")));
    let found = wanted.find_by_text(names.iter().copied()).or_else(place);
    found.map(LightSource::Light).ok_or_else(|| {
        let wanted = match wanted {
            NameOrIndex::Name(name) => name.clone(),
            NameOrIndex::Index(index) => index.to_string(),
        };
        SceneError::NoLight { wanted, known: listed(&names, "the scene has none") }
    })
}

/// Names with their numbers, as a clause.
fn listed(names: &[Option<&str>], nothing: &str) -> String {
    let listed = names.iter().enumerate().map(|(i, name)| match name {
        Some(name) => format!("{i} {name:?}"),
        None => i.to_string(),
    });
    let listed: Vec<String> = listed.collect();
    if listed.is_empty() { nothing.to_owned() } else { format!("there are {}", listed.join(", ")) }
}

/// The scene's lights, else the models', else the default ones.
fn spawn_lights(
    scene: &SceneFile,
    camera: Entity,
    (objects, frames): (&[Object], &[Entity]),
    origin: DVec3,
    world: &mut World,
) -> Vec<Entity> {
    let mut entries = scene.lights.as_ref().map(LightsEntry::entries).unwrap_or_default();
    if scene.lights.is_none() {
        let own = spawn_own_lights(objects, frames, world);
        if !own.is_empty() {
            return own;
        }
        entries = Cow::Owned(default_lights());
    }
    spawn_listed_lights((scene, &entries), camera, frames, origin, world)
}

/// Spawns lights of a scene, each in the frame that it is attached to.
pub(crate) fn spawn_listed_lights(
    (scene, entries): (&SceneFile, &[LightEntry]),
    camera: Entity,
    frames: &[Entity],
    origin: DVec3,
    world: &mut World,
) -> Vec<Entity> {
    let spawn_entry = |(i, entry): (usize, &LightEntry)| {
        let parent = match &entry.attach {
            AttachEntry::World => None,
            AttachEntry::Camera => Some(camera),
            AttachEntry::Object(object) => scene.object_index(object).and_then(|index| frames.get(index)).copied(),
        };
        let origin = origin_near(origin, entry);
        let (component, transform) = place(entry, origin);
        let name = entry.name.clone().unwrap_or_else(|| format!("lights[{i}]"));
        let light = spawn_light(name, component, (transform, origin), parent, world);
        insert_some(&mut world.entity_mut(light), Animated::light(entry));
        insert_layers(&mut world.entity_mut(light), entry.layers.as_ref());
        light
    };
    entries.iter().enumerate().map(spawn_entry).collect()
}

/// Spawns the lights of models as children of their objects.
pub(crate) fn spawn_own_lights(objects: &[Object], frames: &[Entity], world: &mut World) -> Vec<Entity> {
    let mut lights = Vec::new();
    for ((_, shape), &frame) in objects.iter().zip(frames) {
        for light in &shape.lights {
            let name = if light.name.is_empty() { "light".to_owned() } else { light.name.clone() };
            let place = (light.object_from_light, shape.origin);
            lights.push(spawn_light(name, light.light, place, Some(frame), world));
        }
        if let Some(mut animation) = world.get_mut::<ModelAnimation>(frame) {
            animation.lights = lights[lights.len() - shape.lights.len()..].to_vec();
        }
    }
    lights
}

fn spawn_light(
    name: String,
    component: LightComponent,
    (transform, origin): (Transform, DVec3),
    parent: Option<Entity>,
    world: &mut World,
) -> Entity {
    let mut entity = world.spawn(Name::new(name));
    insert_place(&mut entity, transform, origin);
    component.insert_into(&mut entity);
    insert_some(&mut entity, parent.map(ChildOf));
    entity.id()
}

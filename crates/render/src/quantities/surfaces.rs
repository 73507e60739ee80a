//! The surface that each pixel shows.

use crate::quantities::redrawn::{self, Shows, Taken, numbers};
use crate::views::{self, Views};
use bevy_ecs::prelude::*;
use bevy_math::{DAffine3, DMat3, DVec2, DVec3, UVec2, Vec3A};
use bevy_platform::collections::HashMap;
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_frame::error::RenderError;
use halfway_frame::view::camera::{PictureSize, View, eye_from_world};
use halfway_frame::view::matrices::normal_matrix;
use halfway_frame::view::select::Visible;
use halfway_lighting::{Camera, FrameOrigin, Lens, current_camera};
use halfway_mesh::{Mesh, Mesh3d, SpawnOrder};

/// The surface that the middle of each pixel shows, with all that is known of it.
///
/// Which triangle is seen is decided by the drawer of the frame, on its grid of sub-pixels; everything else follows from
/// the triangle in 64-bit arithmetic. Blended objects count as opaque ones; where a mask cuts away, what lies behind is
/// seen. Triangles are those of the mesh, whatever levels of detail the picture was drawn with. Nothing is averaged,
/// however many samples the camera takes.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::{DVec3, UVec2};
/// use bevy_transform::{TransformPlugin, components::Transform};
/// use halfway_asset::Assets;
/// use halfway_lighting::Camera;
/// use halfway_mesh::{Cuboid, Mesh, Mesh3d};
/// use halfway_render::{AdapterChoice, Headless, RenderError, RenderPlugin, Surfaces, take_picture};
///
/// # fn main() -> Result<(), RenderError> {
/// let mut app = App::new();
/// app.add_plugins((TransformPlugin, RenderPlugin::default()))
///     .insert_resource(Headless { size: UVec2::new(64, 48), ..Headless::default() })
///     .insert_resource(AdapterChoice::cpu());
/// let world = app.world_mut();
/// world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0)));
/// let cube = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
/// let cube = world.spawn((Mesh3d(cube), Transform::default())).id();
/// take_picture(world)?;
///
/// let surfaces = Surfaces::take(world)?;
/// let middle = surfaces.at(32, 24).expect("the cube");
/// assert_eq!(middle.entity, cube);
/// assert!((middle.depth - 3.5).abs() < 1e-6 && (middle.normal - DVec3::Z).length() < 1e-6);
/// assert_eq!(surfaces.at(0, 0), None);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Surfaces {
    size: UVec2,
    lens: Lens<f64>,
    eye_from_world: DAffine3,
    /// The point of the world from which `eye_from_world` counts.
    origin: DVec3,
    objects: Vec<SeenObject>,
    /// The number of the object and of its triangle, row by row from the top.
    numbers: Vec<Option<[u32; 2]>>,
}

#[derive(Clone, Debug)]
struct SeenObject {
    entity: Entity,
    object: u32,
    part: u32,
    mesh: Mesh,
    eye_from_model: DAffine3,
    normal_matrix: DMat3,
}

/// The triangle that a ray meets.
struct Met<'a> {
    seen: &'a SeenObject,
    /// Its number, and the numbers of its vertices.
    triangle: u32,
    corners: [usize; 3],
    /// Its corners in eye space.
    ends: [DVec3; 3],
    weights: DVec3,
    /// Of the ray.
    direction: DVec3,
}

/// The plane of the surface in a pixel, in eye space.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SeenPlane {
    /// Of any length, to either side.
    pub(crate) normal: DVec3,
    /// Where the middle of the pixel shows it.
    pub(crate) point: DVec3,
    pub(crate) depth: f64,
}

/// A point of a surface that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The entity that carries the mesh.
    pub entity: Entity,
    /// The number of the object, from 1 on: entities below one root of the hierarchy are one object, and objects are
    /// counted in the order in which their first meshes were spawned, hidden ones included.
    pub object: u32,
    /// The number of the mesh within its object, from 1 on.
    pub part: u32,
    /// The number of the triangle in its mesh, from 0 on.
    pub triangle: u32,
    /// The weights of the triangle's corners in the point: each 0 to 1, with the sum 1.
    pub barycentrics: DVec3,
    /// The point in world space.
    pub position: DVec3,
    /// Its depth along the axis of the camera, in world units.
    pub depth: f64,
    /// Its distance from the camera, in world units.
    pub distance: f64,
    /// Whether the front of the surface is seen.
    pub front: bool,
    /// The unit normal in world space, interpolated between the corners, of the side that is seen. Images on the surface
    /// do not turn it.
    pub normal: DVec3,
    /// The unit normal of the triangle in world space, of the side that is seen.
    pub face_normal: DVec3,
    /// The texture coordinates of the first set, if the mesh has any.
    pub uv: Option<DVec2>,
}

impl Surfaces {
    /// The surfaces that the newest frame of this world shows, window or not. Objects are where they were when it was
    /// drawn. Where several cameras share the picture, those of the first; [`pick`] and
    /// [`take_quantities`](crate::take_quantities) look at all of them.
    ///
    /// # Errors
    /// [`RenderError::NoPicture`] before the first frame; [`RenderError::TooLarge`] for meshes of more than 16,777,216
    /// triangles; [`RenderError::FloatTarget`] where the adapter cannot draw numbers.
    pub fn take(world: &mut World) -> Result<Self, RenderError> {
        let picture = redrawn::draw(world, Shows::Numbers, Taken::InOneFrame)?;
        let (view, size) = (world.resource::<View>(), world.resource::<PictureSize>().0);
        let (camera, eye_from_world) = (view.camera.ok_or(RenderError::NoPicture)?, view.eye_from_world);
        let entities = world.resource::<Visible>().0.clone();
        let numbers = picture.pixels().map(|pixel| numbers(pixel.0)).collect();
        Ok(Self::new(world, (&camera, eye_from_world), size, &entities, numbers))
    }

    /// The surfaces that another drawer shows: `find` gives the entity and the triangle in the middle of a pixel, by its
    /// column and row.
    ///
    /// # Errors
    /// [`RenderError::NoCamera`]; [`RenderError::ManyCameras`] where it is no camera's [turn](halfway_lighting::CameraTurn).
    pub fn found_by(
        world: &mut World,
        size: UVec2,
        find: impl Fn(u32, u32) -> Option<(Entity, u32)>,
    ) -> Result<Self, RenderError> {
        let entity = current_camera(world).map_err(no_camera)?;
        let camera = *world.get::<Camera>(entity).ok_or(RenderError::NoCamera)?;
        let eye_from_world = eye_from_world(world.get::<GlobalTransform>(entity).ok_or(RenderError::NoCamera)?);
        let mut entities = Vec::new();
        let mut numbers_of = HashMap::<Entity, u32>::default();
        let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
        let numbers = pixels.map(|(x, y)| {
            let (entity, triangle) = find(x, y)?;
            let number = *numbers_of.entry(entity).or_insert_with(|| {
                entities.push(entity);
                entities.len() as u32 - 1
            });
            Some([number, triangle])
        });
        let numbers = numbers.collect();
        Ok(Self::new(world, (&camera, eye_from_world), size, &entities, numbers))
    }

    fn new(
        world: &mut World,
        (camera, eye_from_world): (&Camera, DAffine3),
        size: UVec2,
        entities: &[Entity],
        numbers: Vec<Option<[u32; 2]>>,
    ) -> Self {
        let lens = camera.projection.lens(size.to_array());
        let origin = world.get_resource::<FrameOrigin>().copied().unwrap_or_default().0;
        Self { size, lens, eye_from_world, origin, objects: SeenObject::all(world, entities, &eye_from_world), numbers }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The surface in a pixel, whose column and row are counted from the top left; `None` where there is only background,
    /// and outside of the picture.
    pub fn at(&self, x: u32, y: u32) -> Option<SurfacePoint> {
        let Met { seen, triangle, corners, ends, weights, direction } = self.met(x, y)?;
        let eye = mixed(weights, ends);
        let face = face_normal(corners.map(|vertex| seen.mesh.positions()[vertex].as_dvec3()));
        let face = (seen.normal_matrix * face).normalize_or_zero();
        let front = face.dot(direction) <= 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let normal = mixed(weights, corners.map(|vertex| seen.mesh.normals()[vertex].as_dvec3()));
        let normal = (seen.normal_matrix * normal).try_normalize().unwrap_or(face);
        let world_from_eye = self.eye_from_world.inverse();
        let uv = seen.mesh.uvs().map(|uvs| {
            let [a, b, c] = corners.map(|vertex| uvs[vertex].as_dvec2());
            a * weights.x + b * weights.y + c * weights.z
        });
        Some(SurfacePoint {
            entity: seen.entity,
            object: seen.object,
            part: seen.part,
            triangle,
            barycentrics: weights,
            position: self.origin + world_from_eye.transform_point3(eye),
            depth: -eye.z,
            distance: eye.length(),
            front,
            normal: world_from_eye.transform_vector3(side * normal),
            face_normal: world_from_eye.transform_vector3(side * face),
            uv,
        })
    }

    /// The triangle that the ray through the middle of a pixel meets.
    fn met(&self, x: u32, y: u32) -> Option<Met<'_>> {
        if x >= self.size.x || y >= self.size.y {
            return None;
        }
        let [object, triangle] = self.numbers[(y * self.size.x + x) as usize]?;
        let middle = (UVec2::new(x, y).as_dvec2() + 0.5) / self.size.as_dvec2();
        let ray = self.lens.ray([2.0 * middle.x - 1.0, 1.0 - 2.0 * middle.y]);
        let [origin, direction] = [ray.origin, ray.direction].map(DVec3::from);
        let seen = self.objects.get(object as usize)?;
        let corners = seen.mesh.indices().as_chunks().0.get(triangle as usize)?.map(|vertex| vertex as usize);
        let ends = corners.map(|vertex| seen.eye_from_model.transform_point3(seen.mesh.positions()[vertex].as_dvec3()));
        let weights = weights(ends.map(|end| end - origin), direction);
        Some(Met { seen, triangle, corners, ends, weights, direction })
    }

    /// The plane of the surface in a pixel; `None` as for [`at`](Self::at).
    pub(crate) fn plane_at(&self, x: u32, y: u32) -> Option<SeenPlane> {
        let Met { ends, weights, .. } = self.met(x, y)?;
        let (point, [a, b, c]) = (mixed(weights, ends), ends);
        Some(SeenPlane { normal: (b - a).cross(c - a), point, depth: -point.z })
    }

    /// All pixels, row by row from the top.
    pub fn iter(&self) -> impl Iterator<Item = Option<SurfacePoint>> + '_ {
        (0..self.size.y).flat_map(move |y| (0..self.size.x).map(move |x| self.at(x, y)))
    }

    /// The projection of its picture.
    pub(crate) fn lens(&self) -> &Lens<f64> {
        &self.lens
    }

    /// The point from which [`Quantity::Position`](crate::Quantity::Position) counts: the origin of the camera
    /// ([`FrameOrigin`]), 0 where nothing has one.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// World to eye, counted from [`origin`](Self::origin).
    pub(crate) fn eye_from_world(&self) -> DAffine3 {
        self.eye_from_world
    }

    /// The objects that pixels may show, in the order of their numbers.
    pub(crate) fn entities(&self) -> impl Iterator<Item = Entity> + '_ {
        self.objects.iter().map(|seen| seen.entity)
    }

    /// The numbers of the object and of the triangle in a pixel of the picture.
    pub(crate) fn numbers_at(&self, x: u32, y: u32) -> Option<[u32; 2]> {
        self.numbers[(y * self.size.x + x) as usize]
    }

    /// A direction of the world in eye space.
    pub(crate) fn in_eye_space(&self, direction: DVec3) -> DVec3 {
        self.eye_from_world.transform_vector3(direction)
    }
}

impl SeenObject {
    /// The objects, in the order of their numbers.
    fn all(world: &mut World, entities: &[Entity], eye_from_world: &DAffine3) -> Vec<Self> {
        let places = places(world);
        let mut objects = world.query::<(&Mesh3d, &GlobalTransform)>();
        let world = &*world;
        let meshes = world.get_resource::<Assets<Mesh>>();
        let nothing = |entity| (entity, Mesh::from(halfway_mesh::Cuboid::default()), DAffine3::IDENTITY);
        let seen = entities.iter().map(|&entity| {
            let found = objects.get(world, entity).ok().and_then(|(mesh, transform)| {
                Some((entity, meshes?.get(&mesh.0)?.clone(), *eye_from_world * world_from_model(transform)))
            });
            let (entity, mesh, eye_from_model) = found.unwrap_or_else(|| nothing(entity));
            let [object, part] = places.get(&entity).copied().unwrap_or_default();
            let normal_matrix = normal_matrix(&eye_from_model.matrix3).as_dmat3();
            Self { entity, object, part, mesh, eye_from_model, normal_matrix }
        });
        seen.collect()
    }
}

/// An object's transform, as exactly as it is known.
pub(crate) fn world_from_model(transform: &GlobalTransform) -> DAffine3 {
    let (matrix, translation) = (transform.affine().matrix3, transform.affine().translation);
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec3A::as_dvec3);
    DAffine3 { matrix3: DMat3::from_cols(columns[0], columns[1], columns[2]), translation: translation.as_dvec3() }
}

/// The numbers of each object and part.
fn places(world: &mut World) -> HashMap<Entity, [u32; 2]> {
    let mut parts = world.query_filtered::<(Entity, &SpawnOrder), With<Mesh3d>>();
    let mut parts: Vec<_> = parts.iter(world).map(|(entity, order)| (*order, entity)).collect();
    parts.sort_unstable();
    let parent = |entity| world.get::<ChildOf>(entity).map(ChildOf::parent);
    let mut objects: HashMap<Entity, [u32; 2]> = HashMap::default();
    let mut places = HashMap::default();
    for (_, entity) in parts {
        // A hierarchy that runs in a circle comes to an end.
        let root = std::iter::successors(Some(entity), |&entity| parent(entity)).take(10_000).last().unwrap_or(entity);
        let next = objects.len() as u32 + 1;
        let [object, parts] = objects.entry(root).or_insert([next, 0]);
        *parts += 1;
        places.insert(entity, [*object, *parts]);
    }
    places
}

/// The surface in a pixel of the newest frame, as [`Surfaces::at`] has it: for a click. Where several cameras share the
/// picture, that of the last one that draws in this pixel.
///
/// # Errors
/// Those of [`Surfaces::take`].
pub fn pick(world: &mut World, x: u32, y: u32) -> Result<Option<SurfacePoint>, RenderError> {
    let at = |world: &mut World, x, y| Ok(Surfaces::take(world)?.at(x, y));
    match world.get_resource::<Views>().filter(|views| !views.is_empty()).map(|views| views.showing(UVec2::new(x, y))) {
        None => at(world, x, y),
        Some(None) => Ok(None),
        Some(Some(number)) => {
            views::in_turn(world, number, |world, place| at(world, x - place.corner.x, y - place.corner.y))
        }
    }
}

/// The error of [`current_camera`].
pub(crate) fn no_camera(count: usize) -> RenderError {
    if count == 0 { RenderError::NoCamera } else { RenderError::ManyCameras(count) }
}

/// The weights of a triangle's corners where the ray from the origin meets it. Of a ray that passes beside it by a
/// rounding, or of a triangle seen edge-on, the nearest weights of a point within.
fn weights([a, b, c]: [DVec3; 3], direction: DVec3) -> DVec3 {
    // Each is the volume between the ray and the opposite edge.
    let volumes = DVec3::new(direction.dot(b.cross(c)), direction.dot(c.cross(a)), direction.dot(a.cross(b)));
    let volumes = if volumes.element_sum() < 0.0 { -volumes } else { volumes };
    let inside = volumes.max(DVec3::ZERO);
    let sum = inside.element_sum();
    if sum > 0.0 { inside / sum } else { DVec3::splat(1.0 / 3.0) }
}

fn mixed(weights: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * weights.x + b * weights.y + c * weights.z
}

fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

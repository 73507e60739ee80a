//! A scene in which everything changes.

use halfway::mesh::SpawnOrder;
use halfway::prelude::*;
use halfway::render::{PendingPicture, RenderError};

/// Small pictures, since leaks do not depend on pixels.
const SIZE: UVec2 = UVec2::splat(16);
/// Objects that come and go, one a frame.
const VISITORS: u64 = 12;
/// The period of the light that comes and goes, in frames; it exists for half of it.
const LAMP: u64 = 16;

/// An App whose scene changes from frame to frame.
pub(crate) struct Life {
    pub(crate) app: App,
    visitors: Vec<Entity>,
    /// The light that comes and goes.
    lamp: Option<Entity>,
    /// The object whose mesh is replaced in place, and that mesh.
    shape: Handle<Mesh>,
    kept: Option<Vec<Handle<Mesh>>>,
}

impl Life {
    /// The scene before its first frame; one that `leaks` keeps a handle of each mesh.
    pub(crate) fn new(leaks: bool) -> Self {
        let mut life = Self::empty();
        let world = life.app.world_mut();
        world.spawn((Camera::default(), Transform::from_xyz(0.0, 2.0, 7.0).looking_at(Vec3::ZERO, Vec3::Y)));
        world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.1, 0.1, 0.1)));
        world.spawn((DirectionalLight::white(), Transform::default()));
        for _ in 0..4 {
            world.spawn((PointLight { range: Some(6.0), ..PointLight::white() }, Transform::default()));
        }
        world.spawn((SpotLight::white(0.6), Transform::default()));
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let (floor, shape) = (meshes.add(Plane { size: 9.0, divisions: 8 }), meshes.add(Cuboid::default()));
        world.spawn((Mesh3d(floor), Material::JADE, Transform::from_xyz(0.0, -1.5, 0.0), Shading::Gouraud));
        world.spawn((Mesh3d(shape.clone()), Material::BRASS));
        (life.shape, life.kept) = (shape, leaks.then(Vec::new));
        life
    }

    fn empty() -> Self {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::headless(SIZE));
        Self { app, visitors: Vec::new(), lamp: None, shape: Handle::default(), kept: None }
    }

    /// Changes the scene for a frame.
    pub(crate) fn step(&mut self, frame: u64) {
        self.change_lights(frame);
        self.move_lights(frame);
        self.replace(frame);
        self.change_materials(frame);
        let oldest = (self.visitors.len() as u64 == VISITORS).then(|| self.visitors.remove(0));
        let world = self.app.world_mut();
        if let Some(oldest) = oldest {
            world.despawn(oldest);
        }
        let mesh = world.resource_mut::<Assets<Mesh>>().add(sphere(frame));
        if let Some(kept) = &mut self.kept {
            kept.push(mesh.clone());
        }
        let at = Quat::from_rotation_y(0.7 * frame as f32) * Vec3::new(2.5, 0.3 * (frame % 5) as f32 - 1.0, 0.0);
        let shading = [Shading::Flat, Shading::Gouraud, Shading::Phong][frame as usize % 3];
        let opacity = if frame.is_multiple_of(4) { 0.5 } else { 1.0 };
        let material = Material { opacity, ..varied(frame) };
        let mut visitor = world.spawn((Mesh3d(mesh), material, shading, Transform::from_translation(at)));
        if opacity < 1.0 {
            visitor.insert(AlphaMode::Blend);
        }
        self.visitors.push(visitor.id());
    }

    fn change_lights(&mut self, frame: u64) {
        let world = self.app.world_mut();
        if frame.is_multiple_of(LAMP) {
            let lamp = PointLight { range: Some(4.0), ..PointLight::white() };
            self.lamp = Some(world.spawn((lamp, Transform::default())).id());
        } else if frame % LAMP == LAMP / 2
            && let Some(lamp) = self.lamp.take()
        {
            world.despawn(lamp);
        }
    }

    fn move_lights(&mut self, frame: u64) {
        let world = self.app.world_mut();
        let mut lights =
            world.query_filtered::<&mut Transform, Or<(With<PointLight>, With<SpotLight>, With<DirectionalLight>)>>();
        for (mut transform, number) in lights.iter_mut(world).zip(0u16..) {
            let way = Quat::from_rotation_y(0.01 * frame as f32 + f32::from(number));
            *transform = Transform::from_translation(way * Vec3::new(2.0, 3.0, 2.0)).looking_at(Vec3::ZERO, Vec3::Y);
        }
    }

    /// Gives the asset another mesh, which stays for three frames: long enough for levels of detail to be ordered.
    fn replace(&mut self, frame: u64) {
        if frame.is_multiple_of(3) {
            let mesh = Mesh::from(UvSphere::new(0.9, 6 + frame as u32 % 13, 5));
            let id = self.shape.id();
            let replaced = self.app.world_mut().resource_mut::<Assets<Mesh>>().insert(id, mesh);
            replaced.expect("its handle is kept");
        }
    }

    fn change_materials(&mut self, frame: u64) {
        let world = self.app.world_mut();
        for (mut material, number) in world.query::<&mut Material>().iter_mut(world).zip(0u64..) {
            // Blended ones keep theirs.
            if (frame + number).is_multiple_of(5) && material.opacity >= 1.0 {
                *material = varied(frame * 31 + number);
            }
        }
    }

    /// The same scene in a new App.
    pub(crate) fn fresh(&mut self) -> Result<Self, RenderError> {
        let mut fresh = Self::empty();
        let (old, new) = (self.app.world_mut(), fresh.app.world_mut());
        for parts in old.query::<(&Camera, &Transform)>().iter(old) {
            new.spawn((*parts.0, *parts.1));
        }
        new.insert_resource(*old.resource::<GlobalAmbient>());
        // In the order of summation.
        for parts in old.query::<(&DirectionalLight, &Transform)>().iter(old) {
            new.spawn((*parts.0, *parts.1));
        }
        for parts in old.query::<(&PointLight, &Transform)>().iter(old) {
            new.spawn((*parts.0, *parts.1));
        }
        for parts in old.query::<(&SpotLight, &Transform)>().iter(old) {
            new.spawn((*parts.0, *parts.1));
        }
        let mut objects =
            old.query::<(&SpawnOrder, &Mesh3d, &Material, Option<&Shading>, Option<&AlphaMode>, &Transform)>();
        let mut objects: Vec<_> = objects.iter(old).collect();
        objects.sort_by_key(|object| *object.0);
        for (_, Mesh3d(handle), material, shading, alpha, transform) in objects {
            let missing = || RenderError::MissingMesh { entity: "an object of the long run".into() };
            let mesh = old.resource::<Assets<Mesh>>().get(handle).ok_or_else(missing)?.clone();
            let mesh = new.resource_mut::<Assets<Mesh>>().add(mesh);
            let mut object = new.spawn((Mesh3d(mesh), *material, *transform));
            if let Some(shading) = shading {
                object.insert(*shading);
            }
            if let Some(alpha) = alpha {
                object.insert(*alpha);
            }
        }
        Ok(fresh)
    }

    /// The picture once all pipelines are built.
    pub(crate) fn settled_picture(&mut self) -> Result<Picture, RenderError> {
        for _ in 0..3 {
            self.app.update();
        }
        self.app.update();
        PendingPicture::request(self.app.world())?.wait()
    }
}

/// A small sphere; every other one has enough triangles for levels of detail.
fn sphere(number: u64) -> Mesh {
    Mesh::from(UvSphere::new(0.4 + 0.02 * (number % 10) as f32, 5 + number as u32 % 9, 4))
}

/// A material that has not been used for a long time.
fn varied(number: u64) -> Material {
    let part = |factor: u64| (number * factor % 1009) as f32 / 1009.0;
    let mut material = Material::matte(LinearRgba::rgb(part(17), part(101), part(313)));
    material.specular = LinearRgba::rgb(part(7), part(7), part(7));
    material.shininess = 1.0 + 40.0 * (number % 3) as f32;
    material
}

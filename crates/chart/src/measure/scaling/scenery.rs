//! The scenes of the sweeps.

use std::f32::consts::TAU;

use halfway::prelude::*;
use halfway::render::Adapter;

use super::Growth;
use super::growth::PIXELS;
use crate::timing::TimedLook;

/// An App that shows one scene after another in the same look.
pub(super) struct ScalingScene {
    app: App,
    look: TimedLook,
}

/// Marks what goes when the next scene comes.
#[derive(Component)]
struct SceneEntity;

/// An object that turns.
#[derive(Component)]
struct Turning;

fn turn(mut objects: Query<&mut Transform, With<Turning>>) {
    for mut transform in &mut objects {
        transform.rotate_local_y(0.02);
    }
}

/// The colour of everything.
const COLOR: LinearRgba = LinearRgba::rgb(0.6, 0.5, 0.4);
/// Distance of the objects from each other.
const SPACING: f32 = 2.5;
/// cot(45°/2): how far a camera has to be from what is 2 units high.
const FAR: f32 = 2.414_213_6;
/// Width of the ground, in lights and units.
const GROUND: u32 = 100;
/// Width of its tiles.
const TILE: u32 = 5;

impl ScalingScene {
    /// Without a scene, drawing on `adapter`, which others may share.
    pub(super) fn new(look: TimedLook, adapter: &Adapter) -> Self {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.insert_resource(GlobalAmbient(LinearRgba::rgb(0.1, 0.1, 0.1)))
            .add_plugins(HalfwayPlugins::headless(UVec2::ONE))
            .add_systems(Update, turn);
        app.finish();
        app.cleanup();
        Self { app, look }
    }

    pub(super) fn app(&mut self) -> &mut App {
        &mut self.app
    }

    /// Sets the scene with about as many as asked for, and tells how many there are. Pictures have `size` × `size`
    /// pixels unless it is them that are counted.
    pub(super) fn show(&mut self, growth: Growth, count: f64, size: u32) -> f64 {
        let world = self.app.world_mut();
        let old: Vec<Entity> = world.query_filtered::<Entity, With<SceneEntity>>().iter(world).collect();
        for entity in old {
            world.despawn(entity);
        }
        let size = if growth == Growth::Pixels { picture(count) } else { UVec2::splat(size) };
        world.resource_mut::<Headless>().size = size;
        world.insert_resource(ViewTolerance(growth.tolerance()));
        let whole = count as u32;
        match growth {
            Growth::Triangles => return self.one_mesh(count),
            Growth::Objects => self.objects(whole, false),
            Growth::TurningObjects => self.objects(whole, true),
            Growth::Lights => self.ground(whole),
            Growth::LightsOnOne => self.one_object(whole),
            Growth::Pixels => {
                self.filled();
                return f64::from(size.x) * f64::from(size.y);
            }
        }
        f64::from(whole)
    }

    fn one_mesh(&mut self, count: f64) -> f64 {
        self.camera(3.0);
        self.sun();
        // 2·2r·(r − 1) triangles.
        let rings = (0.5 + (0.25 + count / 4.0).sqrt()).round() as u32;
        let mesh = Mesh::from(UvSphere::new(1.0, 2 * rings, rings));
        let triangles = mesh.triangle_count() as f64;
        let mesh = self.mesh(mesh);
        self.object(mesh, Transform::default());
        triangles
    }

    /// In a square grid that faces the camera and fills the picture.
    fn objects(&mut self, count: u32, turning: bool) {
        let side = f64::from(count).sqrt().ceil() as u32;
        let half = side as f32 * SPACING / 2.0;
        self.camera(half * FAR + 1.0);
        self.sun();
        let mesh = self.mesh(UvSphere::new(1.0, 4, 2));
        for i in 0..count {
            let at = |i: u32| (i as f32 + 0.5) * SPACING - half;
            let object = self.object(mesh.clone(), Transform::from_xyz(at(i % side), at(i / side), 0.0));
            if turning {
                self.app.world_mut().entity_mut(object).insert(Turning);
            }
        }
    }

    /// Of tiles, so that a light can be told to reach one and not another.
    fn ground(&mut self, lights: u32) {
        let half = GROUND as f32 / 2.0;
        // From above: the ground lies in the plane of the picture.
        let camera = self.camera(half * FAR * 1.02);
        let above = Transform::from_xyz(0.0, half * FAR * 1.02, 0.0).looking_at(Vec3::ZERO, Vec3::NEG_Z);
        self.app.world_mut().entity_mut(camera).insert(above);
        let mesh = self.mesh(Plane { size: TILE as f32, divisions: 4 });
        let tiles = GROUND / TILE;
        for i in 0..tiles * tiles {
            let at = |i: u32| (i as f32 + 0.5) * TILE as f32 - half;
            self.object(mesh.clone(), Transform::from_xyz(at(i % tiles), 0.0, at(i / tiles)));
        }
        for i in 0..lights {
            // Over each unit one; the golden section scatters the first of them. It has no factor in common with the
            // units.
            let unit = i * 6181 % (GROUND * GROUND);
            let at = |unit: u32| unit as f32 + 0.5 - half;
            let light = PointLight {
                attenuation: Attenuation::new(1.0, 0.0, 0.5),
                range: Some(1.5),
                ..PointLight::from_color(COLOR)
            };
            self.spawn((light, Transform::from_xyz(at(unit % GROUND), 0.5, at(unit / GROUND))));
        }
    }

    /// A sphere with lights on a circle before it.
    fn one_object(&mut self, lights: u32) {
        self.camera(3.0);
        let mesh = self.mesh(UvSphere::new(1.0, 64, 32));
        self.object(mesh, Transform::default());
        let light = PointLight::from_color(LinearRgba::rgb(1.0, 1.0, 1.0) * (1.0 / lights as f32));
        for i in 0..lights {
            let (sin, cos) = (TAU * i as f32 / lights as f32).sin_cos();
            self.spawn((light, Transform::from_xyz(1.5 * cos, 1.5 * sin, 2.5)));
        }
    }

    /// A sphere that covers the picture: its half angle is asin(1/1.4) = 45.6°, and the corners of 16:9 lie 40.2° off
    /// the middle.
    fn filled(&mut self) {
        self.camera(1.4);
        self.sun();
        let mesh = self.mesh(UvSphere::new(1.0, 64, 32));
        self.object(mesh, Transform::default());
    }

    fn camera(&mut self, distance: f32) -> Entity {
        self.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, distance)))
    }

    fn sun(&mut self) {
        let from = Transform::from_xyz(1.0, 1.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y);
        self.spawn((DirectionalLight::from_color(LinearRgba::rgb(0.9, 0.9, 0.9)), from));
    }

    fn mesh(&mut self, mesh: impl Into<Mesh>) -> Handle<Mesh> {
        self.app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh.into())
    }

    fn object(&mut self, mesh: Handle<Mesh>, place: Transform) -> Entity {
        self.spawn((Mesh3d(mesh), self.look.material(COLOR), self.look.shading(), place))
    }

    fn spawn(&mut self, parts: impl Bundle) -> Entity {
        self.app.world_mut().spawn((parts, SceneEntity)).id()
    }
}

/// A square of about as many pixels; the largest has the shape of a screen.
fn picture(pixels: f64) -> UVec2 {
    if pixels >= PIXELS { UVec2::new(3840, 2160) } else { UVec2::splat(pixels.sqrt().round() as u32) }
}

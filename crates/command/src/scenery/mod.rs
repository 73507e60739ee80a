//! The benchmark scenes: the same everywhere, so that renderers can be compared.
//!
//! All colours are linear RGB; the material is Blinn–Phong with a white highlight of shininess 32 and an ambient colour
//! equal to its diffuse one; the background is (0.01, 0.012, 0.02); the camera has a vertical field of view of 45° and
//! looks at the origin.
//!
//! | | objects | lights besides ambient | camera | pixels |
//! |---|---|---|---|---|
//! | S1 | one sphere, 512 × 256 | directional 0.6 from (1, 1, 1), three tinted points of 0.5 | (0, 0, 3) | 1280 × 720 |
//! | S1×16 | the same | each of them four times, turned about +Y by 0°, 90°, 180° and 270°, at a quarter of its intensity | (0, 0, 3) | 1280 × 720 |
//! | S2 | 10,000 spheres of 16 × 8 in 10 colours, 2.5 apart, all turning | directional 0.9 | (0, 60, 160) | 1280 × 720 |
//! | S3 | 400 spheres on a plane of 200 | directional 0.15, 256 circling points of 2.0 and range 12 | (0, 40, 100) | 1280 × 720 |
//! | S4 | one sphere, 64 × 32 | directional 0.9 | (0, 0, 3) | 256 × 256 |
//! | S5 | 60 objects of five kinds (see [`gallery`]), 12 of each | directional 0.4 and 0.2, three circling points of 0.6, one spot | (0, 10, 19) | 1280 × 720 |
//! | S6 | one scan of 1,000,000 triangles with noise, in half of the pixels, turning | those of S5 that are directional, one point of 0.3 | (0, 0, 2.5) | 1280 × 720 |
//!
//! Single [`features`] are timed in another, neutral scene.

pub(crate) mod features;
mod gallery;
pub(crate) mod growth;
pub(crate) mod many_lights;

use std::f32::consts::TAU;

use clap::ValueEnum;
use halfway::prelude::*;
use halfway_chart::front::Still;
use halfway_chart::front::scenes::random;
use halfway_chart::timing::TimedShading;

/// One of these scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BenchmarkScene {
    S1,
    S1x16,
    S2,
    S3,
    S4,
    S5,
    S6,
}

impl BenchmarkScene {
    /// The size of its picture in pixels.
    pub(crate) fn size(self) -> UVec2 {
        if self == Self::S4 { UVec2::splat(256) } else { UVec2::new(1280, 720) }
    }
}

/// A benchmark scene as a plugin: spawns it at start-up and advances it by one step a frame, the first frame being 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Benchmark {
    pub(crate) scene: BenchmarkScene,
    pub(crate) look: TimedShading,
    /// Spheres of S2 as octahedra, which keeps the work on 10,000 entities and removes that on their triangles.
    pub(crate) octahedra: bool,
}

impl Plugin for Benchmark {
    fn build(&self, app: &mut App) {
        let Self { scene, look, octahedra } = *self;
        let ambient = if scene == BenchmarkScene::S3 { 0.05 } else { 0.1 };
        app.insert_resource(GlobalAmbient(grey(ambient)))
            .init_resource::<FrameNumber>()
            .add_systems(Startup, move |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
                let mut stage = Scenery { commands: &mut commands, meshes: &mut meshes, look };
                match scene {
                    BenchmarkScene::S1 => stage.one_mesh(1),
                    BenchmarkScene::S1x16 => stage.one_mesh(4),
                    BenchmarkScene::S2 => stage.many_objects(if octahedra { (4, 2) } else { (16, 8) }),
                    BenchmarkScene::S3 => stage.many_lights(),
                    BenchmarkScene::S4 => stage.small(),
                    BenchmarkScene::S5 => stage.gallery(),
                    BenchmarkScene::S6 => stage.large_scan(),
                }
            })
            .add_systems(Update, (turn, circle, count).chain().run_if(not(resource_exists::<Still>)));
    }
}

/// f, the number of the frame.
#[derive(Resource, Default)]
struct FrameNumber(u32);

fn count(mut frame: ResMut<FrameNumber>) {
    frame.0 += 1;
}

/// An object of S2: turns about a slanted axis, starting at an angle of its own.
#[derive(Component)]
struct Turning {
    start: f32,
}

fn turn(frame: Res<FrameNumber>, mut objects: Query<(&Turning, &mut Transform)>) {
    let axis = Vec3::new(0.3, 1.0, 0.2).normalize();
    for (turning, mut transform) in &mut objects {
        transform.rotation = Quat::from_axis_angle(axis, turning.start + 0.02 * frame.0 as f32);
    }
}

/// A light of S3: goes round a circle of radius 3 about a point.
#[derive(Component)]
struct Circling {
    center: Vec3,
    start: f32,
}

fn circle(frame: Res<FrameNumber>, mut lights: Query<(&Circling, &mut Transform)>) {
    for (circling, mut transform) in &mut lights {
        let (sin, cos) = (circling.start + 0.05 * frame.0 as f32).sin_cos();
        transform.translation = circling.center + 3.0 * Vec3::new(cos, 0.0, sin);
    }
}

struct Scenery<'a, 'w, 's> {
    commands: &'a mut Commands<'w, 's>,
    meshes: &'a mut Assets<Mesh>,
    look: TimedShading,
}

impl Scenery<'_, '_, '_> {
    /// Each light stands `times` times around the mesh, with as much less intensity.
    fn one_mesh(&mut self, times: u8) {
        self.camera(Vec3::new(0.0, 0.0, 3.0));
        let share = f32::from(times).recip();
        let turns = (0..times).map(|i| Quat::from_rotation_y(TAU * f32::from(i) * share));
        for turn in turns.clone() {
            self.sun(0.6 * share, turn);
        }
        let tinted = [
            ([2.0, 0.0, 2.0], [1.0, 0.9, 0.8]),
            ([-2.0, 1.0, 1.5], [0.8, 0.9, 1.0]),
            ([0.0, -2.0, 2.0], [0.9, 1.0, 0.9]),
        ];
        for (position, [red, green, blue]) in tinted {
            for turn in turns.clone() {
                let light = PointLight::new(LinearRgba::rgb(red, green, blue) * (0.5 * share));
                self.commands.spawn((light, Transform::from_translation(turn * Vec3::from(position))));
            }
        }
        self.object(UvSphere::new(1.0, 512, 256), RED, Vec3::ZERO);
    }

    fn small(&mut self) {
        self.camera(Vec3::new(0.0, 0.0, 3.0));
        self.sun(0.9, Quat::IDENTITY);
        self.object(UvSphere::new(1.0, 64, 32), RED, Vec3::ZERO);
    }

    fn many_objects(&mut self, (segments, rings): (u32, u32)) {
        self.camera(Vec3::new(0.0, 60.0, 160.0));
        self.sun(0.9, Quat::IDENTITY);
        let sphere = self.meshes.add(UvSphere::new(1.0, segments, rings));
        for i in 0..10_000_u16 {
            let (column, row) = (f32::from(i % 100), f32::from(i / 100));
            let place = Transform::from_xyz((column - 49.5) * 2.5, 0.0, (row - 49.5) * 2.5);
            let color = hsv(f32::from(i % 10) / 10.0, 0.7, 0.8);
            let turning = Turning { start: 0.01 * f32::from(i % 97) };
            self.commands.spawn((
                Mesh3d(sphere.clone()),
                self.look.material(color),
                self.look.shading(),
                place,
                turning,
            ));
        }
    }

    fn many_lights(&mut self) {
        self.camera(Vec3::new(0.0, 40.0, 100.0));
        self.sun(0.15, Quat::IDENTITY);
        self.object(Plane { size: 200.0, divisions: 64 }, grey(0.6), Vec3::ZERO);
        let sphere = self.meshes.add(UvSphere::new(1.5, 32, 16));
        for i in 0..400_u16 {
            let (column, row) = (f32::from(i % 20), f32::from(i / 20));
            let place = Transform::from_xyz((column - 9.5) * 8.0, 1.5, (row - 9.5) * 8.0);
            self.commands.spawn((Mesh3d(sphere.clone()), self.look.material(grey(0.8)), self.look.shading(), place));
        }
        for i in 0..256 {
            let light = PointLight {
                attenuation: Attenuation::new(1.0, 0.0, 0.5),
                range: Some(12.0),
                ..PointLight::new(hsv(random(i, 4), 0.6, 1.0) * 2.0)
            };
            let center =
                Vec3::new(-90.0 + 180.0 * random(i, 0), 1.0 + 5.0 * random(i, 1), -90.0 + 180.0 * random(i, 2));
            self.commands.spawn((light, Circling { center, start: TAU * random(i, 3) }));
        }
    }

    fn camera(&mut self, position: Vec3) {
        let camera = Camera { background: LinearRgba::rgb(0.01, 0.012, 0.02), ..Camera::default() };
        self.commands.spawn((camera, Transform::from_translation(position).looking_at(Vec3::ZERO, Vec3::Y)));
    }

    fn sun(&mut self, intensity: f32, turn: Quat) {
        let from = Transform::from_translation(turn * Vec3::ONE).looking_at(Vec3::ZERO, Vec3::Y);
        self.commands.spawn((DirectionalLight::new(grey(intensity)), from));
    }

    fn object(&mut self, mesh: impl Into<Mesh>, color: LinearRgba, at: Vec3) {
        let mesh = Mesh3d(self.meshes.add(mesh.into()));
        let place = Transform::from_translation(at);
        self.commands.spawn((mesh, self.look.material(color), self.look.shading(), place));
    }
}

const RED: LinearRgba = LinearRgba::rgb(0.8, 0.3, 0.2);

fn grey(intensity: f32) -> LinearRgba {
    LinearRgba::rgb(intensity, intensity, intensity)
}

/// Hue, saturation and value, each 0 to 1, straight to linear RGB.
fn hsv(hue: f32, saturation: f32, value: f32) -> LinearRgba {
    let channel = |n: f32| {
        let k = (n + 6.0 * hue) % 6.0;
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    LinearRgba::rgb(channel(5.0), channel(3.0), channel(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_by_hue() {
        for (hue, expected) in [(0.0, [1.0, 0.5, 0.5]), (1.0 / 3.0, [0.5, 1.0, 0.5]), (0.5, [0.5, 1.0, 1.0])] {
            let LinearRgba { red, green, blue, .. } = hsv(hue, 0.5, 1.0);
            for (channel, expected) in [red, green, blue].into_iter().zip(expected) {
                assert!((channel - expected).abs() < 1e-6, "{hue}: {red} {green} {blue}");
            }
        }
    }
}

//! Scenes of surfaces that are known by formula.

use halfway::mesh::{Cone, Cylinder, HeightField, ParametricSurface, Tessellation};
use halfway::prelude::*;

use super::super::ChartedScene;
use crate::measure::{ChartObject, ChartScene};

/// A unit sphere.
pub fn sphere() -> ChartedScene {
    object("sphere", "a sphere of a radius of 1 under one directional light, shininess 32", ChartObject::Sphere)
}

/// The same by Phong's formula, for which Blinn's may stand.
pub fn sphere_by_phong() -> ChartedScene {
    let about = "the sphere with Phong’s (v·r)³², for which Blinn–Phong may stand";
    by_phong(object("sphere-by-phong", about, ChartObject::Sphere))
}

/// The Utah teapot.
pub fn teapot() -> ChartedScene {
    let about = "the Utah teapot, Bézier patches of n × n cells each, under one directional light, shininess 32";
    object("teapot", about, ChartObject::Teapot)
}

/// The same by Phong's formula, for which Blinn's may stand.
pub fn teapot_by_phong() -> ChartedScene {
    let about = "the teapot with Phong’s (v·r)³², for which Blinn–Phong may stand";
    by_phong(object("teapot-by-phong", about, ChartObject::Teapot))
}

fn by_phong(scene: ChartedScene) -> ChartedScene {
    ChartedScene { reflectance: Some(Reflectance::Phong), ..scene }
}

fn object(name: &str, about: &str, object: ChartObject) -> ChartedScene {
    ChartedScene::of_surfaces(name, about, (0..5).map(|i| object.level(i)), move |world, level| {
        world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.15, 0.15)));
        world.spawn((Camera::default(), object.camera()));
        sun(world, ChartScene::LIGHT);
        show(world, object.mesh(level), ChartScene::shiny(), Transform::default());
    })
}

/// A flange with a hub, a tip and six bolts: cylinders and a cone with discs at their ends, so that creases are sharp.
pub fn machine_part() -> ChartedScene {
    let about =
        "a flange with a hub, a tip and six bolts, all with sharp creases, under a directional and a point light";
    ChartedScene::of_surfaces("machine-part", about, [8, 16, 32, 64, 128], |world, around| {
        world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.12, 0.12, 0.12)));
        let eye = Transform::from_xyz(1.6, 2.4, 3.0).looking_at(Vec3::new(0.0, 0.15, 0.0), Vec3::Y);
        world.spawn((Camera::default(), eye));
        sun(world, Vec3::new(-0.4, 1.0, 0.8));
        let lamp = PointLight::from_color(LinearRgba::rgb(0.25, 0.3, 0.4));
        world.spawn((lamp, Transform::from_xyz(2.0, 1.2, 1.0)));
        let steel = Material { shininess: 48.0, ..Material::matte(LinearRgba::rgb(0.34, 0.36, 0.4)) };
        let steel = Material { specular: LinearRgba::rgb(0.35, 0.35, 0.35), ..steel };
        let cylinder = |radius, height| Cylinder { radius, height, capped: true };
        let rows = (around / 8).max(1);
        let parts = [(1.2, 0.25, 0.0), (0.6, 0.7, 0.475)];
        for (radius, height, y) in parts {
            show(world, cut(&cylinder(radius, height), rows, around), steel, Transform::from_xyz(0.0, y, 0.0));
        }
        let tip = cut(&Cone { radius: 0.45, height: 0.4, capped: true }, rows, around);
        show(world, tip, steel, Transform::from_xyz(0.0, 1.025, 0.0));
        let bolt = cut(&cylinder(0.12, 0.2), 1, (around / 2).max(6));
        for i in 0..6 {
            let turned = Quat::from_rotation_y(std::f32::consts::TAU * i as f32 / 6.0);
            show(world, bolt.clone(), steel, Transform::from_translation(turned * Vec3::new(0.92, 0.22, 0.0)));
        }
    })
}

/// Hills: a smooth surface through the heights of a grid, in evening light.
pub fn terrain() -> ChartedScene {
    let about = "hills, a smooth surface through 17 × 17 heights, in low light, shininess 8";
    ChartedScene::of_surfaces("terrain", about, [16, 32, 64, 128, 256], |world, cells| {
        world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.17, 0.2)));
        let eye = Transform::from_xyz(0.0, 3.6, 6.4).looking_at(Vec3::new(0.0, -0.3, 0.4), Vec3::Y);
        world.spawn((Camera { background: LinearRgba::rgb(0.25, 0.35, 0.5), ..Camera::default() }, eye));
        sun(world, Vec3::new(-1.0, 0.45, 0.2));
        let soil = Material::matte(LinearRgba::rgb(0.35, 0.42, 0.2));
        let soil = Material { specular: LinearRgba::rgb(0.2, 0.2, 0.15), shininess: 8.0, ..soil };
        show(world, terrain_mesh(cells), soil, Transform::default());
    })
}

/// The mesh of [`terrain`], 8 × 8 units around the origin and up to 1.4 high and deep, of `cells` cells along each
/// side.
pub fn terrain_mesh(cells: u32) -> Mesh {
    match HeightField::new(8.0, 8.0, SAMPLES, heights()) {
        Ok(field) => cut(&field, cells, cells),
        Err(error) => unreachable!("{error}"),
    }
}

/// Along each side of the terrain.
const SAMPLES: u32 = 17;

fn heights() -> Vec<f32> {
    let height = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|k| k as f32 / (SAMPLES - 1) as f32);
        let waves = [(1.0, 1.3, 0.9, 0.2), (0.5, -2.1, 2.6, 1.1), (0.25, 4.7, 3.9, 2.3), (0.1, 7.1, -6.3, 0.7)];
        waves.iter().map(|(high, a, b, start)| 0.75 * high * (6.0 * (a * x + b * z) + start).sin()).sum()
    };
    (0..SAMPLES * SAMPLES).map(|k| height(k % SAMPLES, k / SAMPLES)).collect()
}

fn cut(surface: &impl ParametricSurface, rows: u32, columns: u32) -> Mesh {
    match surface.mesh(Tessellation::Count { rows, columns }) {
        Ok(mesh) => mesh,
        Err(error) => unreachable!("surfaces of our own are in their ranges: {error}"),
    }
}

/// A white light from this direction, infinitely far away.
fn sun(world: &mut World, from: Vec3) {
    world.spawn((DirectionalLight::white(), Transform::default().looking_to(-from, Vec3::Y)));
}

fn show(world: &mut World, mesh: Mesh, material: Material, place: Transform) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    world.spawn((Mesh3d(mesh), material, place));
}

//! Every shading × reflectance × light kind × viewer, pixel by pixel against the f64 evaluation.

use crate::render::compare::{FLOAT, Failures, SRGB};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;

const SIZE: u32 = 64;

const REFLECTANCES: [Reflectance; 3] = [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];
const VIEWERS: [Viewer; 2] = [Viewer::Local, Viewer::Infinite];

/// One lamp of each kind, at about `at` and shining at `target`.
fn lamps(at: Vec3, target: Vec3) -> [(&'static str, Lamp); 6] {
    let to = target - at;
    let cone = Cone { cutoff: 0.45, inner: None, exponent: 3.5 };
    let inner = Cone { cutoff: 0.5, inner: Some(0.2), exponent: 1.0 };
    let ranged = PointLight { range: Some(1.3 * to.length()), ..point_light() };
    let attenuated = PointLight { attenuate_ambient: true, ..point_light() };
    [
        ("directional", Lamp::directional(directional_light(), to)),
        ("point", Lamp::point(point_light(), at)),
        ("spot", Lamp::spot(SpotLight { light: point_light(), cone }, at, to)),
        ("spot with an inner cone", Lamp::spot(SpotLight { light: point_light(), cone: inner }, at, to)),
        ("point with a range", Lamp::point(ranged, at)),
        ("point with attenuated ambient", Lamp::point(attenuated, at)),
    ]
}

/// A plane seen obliquely and a sphere with analytic normals, each with the lamp's position and target.
fn geometries() -> [(&'static str, Scene, [Vec3; 2]); 2] {
    let plane = Thing::new(Plane { size: 6.0, divisions: 5 });
    let turned = Transform::from_rotation(Quat::from_rotation_x(0.7)).with_translation(Vec3::new(0.1, -0.05, 0.0));
    let sphere = Thing::new(UvSphere::new(1.0, 24, 12)).at(turned);
    let over = Scene::seen_from(Vec3::new(0.5, 2.2, 4.0), Vec3::new(0.1, 0.0, 0.3)).ambient(0.1).with(plane);
    let before = Scene::seen_from(Vec3::new(0.4, 0.6, 2.9), Vec3::ZERO).ambient(0.1).with(sphere);
    [
        ("plane", over, [Vec3::new(-0.7, 1.6, -0.9), Vec3::new(0.1, 0.0, 0.2)]),
        ("sphere", before, [Vec3::new(1.6, 1.4, 2.0), Vec3::new(0.2, 0.1, 0.3)]),
    ]
}

/// Draws every combination under one shading, in floating point and in bytes.
fn every_combination(shading: Shading) {
    let mut stage = Stage::new(SIZE, SIZE);
    let mut failures = Failures::default();
    for (geometry, mut scene, [at, target]) in geometries() {
        scene.things[0].shading = Some(shading);
        scene.camera.background = LinearRgba::rgb(0.02, 0.03, 0.04);
        let lamps = lamps(at, target);
        let products = REFLECTANCES
            .into_iter()
            .flat_map(|reflectance| lamps.iter().map(move |lamp| (reflectance, lamp)))
            .flat_map(|(reflectance, lamp)| VIEWERS.map(|viewer| (reflectance, lamp, viewer)));
        for (reflectance, (name, lamp), viewer) in products {
            let row = format!("{geometry}, {shading:?}, {reflectance:?}, {name}, {viewer:?} viewer");
            let mut scene = scene.clone().lit(lamp.clone());
            scene.camera.viewer = viewer;
            scene.things[0].reflectance = Some(reflectance);
            let verdict = failures.draw(&row, &mut stage, &scene, FLOAT);
            failures.unless(verdict.counted > 0.4, || format!("{row}: {verdict}"));
            let bytes = stage.bytes();
            failures.compare_bytes(&format!("{row}, bytes"), &mut stage, &bytes, SRGB);
        }
    }
    failures.finish();
}

#[test]
fn flat_matches_the_equations_in_every_combination() {
    every_combination(Shading::Flat);
}

#[test]
fn gouraud_matches_the_equations_in_every_combination() {
    every_combination(Shading::Gouraud);
}

#[test]
fn phong_matches_the_equations_in_every_combination() {
    every_combination(Shading::Phong);
}

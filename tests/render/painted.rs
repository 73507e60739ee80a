//! Lists of many lights on objects with images: omitted light stays within the tolerance.

use crate::render::random::between;
use crate::render::scene::{Lamp, Map, Scene, Thing};
use crate::render::stage::Stage;
use fastrand::Rng;
use halfway::prelude::*;
use halfway::texture::normals::from_heights;
use halfway::texture::{TexelImage, Wrap};

/// A floor of 4 by 4 seen from above, in patches, under 120 dim lights from afar and 60 near ones.
fn floor(maps: Vec<(MapKind, Map)>) -> Scene {
    let shiny = Material {
        ambient: LinearRgba::BLACK,
        diffuse: LinearRgba::gray(0.8),
        specular: LinearRgba::gray(0.7),
        shininess: 30.0,
        ..Material::default()
    };
    let thing =
        Thing { maps, ..Thing::new(Plane { size: 4.0, divisions: 64 }) }.with_material(shiny).shaded(Shading::Phong);
    let mut scene = Scene::seen_from(Vec3::new(0.0, 4.0, 0.5), Vec3::ZERO).with(thing);
    let mut random = Rng::with_seed(5);
    for number in 0..180 {
        let brightness = between(&mut random, 0.001, 0.008);
        let color = LinearRgba::gray(brightness);
        if number % 3 > 0 {
            let down = Vec3::new(between(&mut random, -0.3, 0.3), -1.0, between(&mut random, -0.3, 0.3));
            let light = DirectionalLight { ambient: LinearRgba::BLACK, ..DirectionalLight::new(color) };
            scene.lamps.push(Lamp::directional(light, down));
        } else {
            let at = Vec3::new(
                between(&mut random, -2.0, 2.0),
                between(&mut random, 0.5, 2.0),
                between(&mut random, -2.0, 2.0),
            );
            scene.lamps.push(Lamp::point(PointLight::new(color), at));
        }
    }
    scene
}

/// A number to the left, and another to the right.
fn halves(left: f32, right: f32) -> Map {
    let texel = |x: u32, _: u32| if x < 32 { [left, left, left, 1.0] } else { [right, right, right, 1.0] };
    Map::new(TexelImage::from_fn(64, 64, texel).expect("a small image"))
}

/// The normal map of waves of this height.
fn waves(height: f32) -> Map {
    let heights = TexelImage::from_fn(64, 64, |x, y| {
        let of = |at: u32, turns: f32| (turns * std::f32::consts::TAU * at as f32 / 64.0).sin();
        [of(x, 5.0) + of(y, 3.0); 4]
    });
    Map::new(from_heights(&heights.expect("a small image"), [Wrap::Repeat; 2], height).expect("normals"))
}

/// The picture of a scene in bytes without a curve, within N steps; and the terms that patches shade.
fn drawn(stage: &mut Stage, scene: &Scene, steps: f32) -> (image::RgbaImage, u64) {
    stage.world().insert_resource(ViewTolerance(Tolerance::steps(steps)));
    stage.set(scene);
    stage.encode(Encoding::Raw);
    let picture = stage.bytes();
    (picture, stage.report().lights_assigned)
}

fn stage() -> Stage {
    Stage::new(64, 48)
}

/// In steps of 1/255 the most that a picture may be off: the tolerance, and half a step of rounding on both sides.
fn most_off(stage: &mut Stage, scene: &Scene, steps: f32) -> (f64, u64) {
    let (picture, terms) = drawn(stage, scene, steps);
    let expected = stage.oracle().draw();
    let mut most = 0.0_f64;
    // Off the floor's rim, where a pixel may show either side.
    for (x, y, pixel) in picture.enumerate_pixels().filter(|(x, y, _)| (16..48).contains(x) && (12..36).contains(y)) {
        let exact = expected.pixels()[(y * 64 + x) as usize];
        for c in 0..3 {
            let exact = exact[c].clamp(0.0, 1.0) * 255.0;
            most = most.max((f64::from(pixel.0[c]) - exact).abs());
        }
    }
    (most - 0.5, terms)
}

#[test]
fn textured_objects_stay_within_the_tolerance() {
    let mut stage = stage();
    let images = [
        ("bright", vec![(MapKind::Color, halves(0.9, 0.9)), (MapKind::Specular, halves(0.9, 0.9))]),
        ("dark", vec![(MapKind::Color, halves(0.15, 0.1)), (MapKind::Specular, halves(0.1, 0.3))]),
        ("halves", vec![(MapKind::Color, halves(0.9, 0.05)), (MapKind::Specular, halves(0.0, 1.0))]),
        ("occluded", vec![(MapKind::Occlusion, halves(0.2, 0.9)), (MapKind::Color, halves(0.9, 0.3))]),
        ("low waves", vec![(MapKind::Normal, waves(0.3)), (MapKind::Color, halves(0.9, 0.3))]),
        ("steep waves", vec![(MapKind::Normal, waves(3.0)), (MapKind::Specular, halves(0.9, 0.3))]),
        ("bumps", vec![(MapKind::Height, Map { amount: 0.05, ..waves(1.0) })]),
        ("waves of less", vec![(MapKind::Normal, Map { amount: 0.4, ..waves(0.5) })]),
    ];
    let mut largest = 0.0_f64;
    for (name, maps) in images {
        for steps in [2.0_f32, 8.0] {
            for reflectance in [Reflectance::BlinnPhong, Reflectance::Phong] {
                let mut scene = floor(maps.clone());
                scene.view_reflectance = Some(reflectance);
                let (off, terms) = most_off(&mut stage, &scene, steps);
                println!("{name}, {reflectance:?}, {steps} steps: {off:.2} off, {terms} terms");
                assert!(off <= f64::from(steps) + 0.01, "{name}, {reflectance:?}: {off} steps off, {steps} allowed");
                largest = largest.max(off / f64::from(steps));
            }
        }
    }
    // Bounds half as large would leave out twice as much, which this test would find.
    assert!(largest > 0.6, "of the tolerance {largest} is spent");
}

/// Emission masks omitted light, but not where an image removes the emission.
#[test]
fn emission_that_an_image_leaves_nothing_of_hides_nothing() {
    let mut stage = stage();
    let mut off = |share: f32| {
        let mut scene = floor(vec![(MapKind::Emission, halves(share, share))]);
        scene.things[0].material.emission = LinearRgba::gray(0.7);
        stage.set(&scene);
        stage.world().insert_resource(ViewTolerance(Tolerance::steps(4.0)));
        stage.encode(Encoding::Srgb);
        let picture = stage.bytes();
        stage.world().insert_resource(ViewTolerance(Tolerance::EXACT));
        let exact = stage.bytes();
        picture.iter().zip(exact.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    };
    assert!(off(0.0) <= 5, "{} steps", off(0.0));
    assert!(off(1.0) <= 5, "{} steps", off(1.0));
}

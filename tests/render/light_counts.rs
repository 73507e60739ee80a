//! Any number of lights: none is dropped, however the lists reach the shader.

use crate::render::compare::{FLOAT, Failures};
use crate::render::random::between;
use crate::render::scene::{Lamp, Scene, Thing};
use crate::render::stage::Stage;
use fastrand::Rng;
use halfway::lighting::Frequency;
use halfway::prelude::*;

/// Few pixels: a thousand lights take the evaluator a while at each.
const SIZE: u32 = 8;
/// On both sides of 8, above which lights are listed, and many more.
const COUNTS: [usize; 9] = [0, 1, 3, 8, 9, 40, 128, 129, 1000];

fn floor() -> Thing {
    Thing::new(Plane { size: 8.0, divisions: 3 })
}

/// A floor that fills the picture.
fn over_floor() -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 3.0, 1.5), Vec3::ZERO).ambient(0.1);
    scene.camera.projection = Projection::perspective(0.7);
    scene
}

/// `count` lights of mixed kinds, all of them over the floor, each with colours of its own and about 1/count bright.
fn mixed_lamps(count: usize) -> Vec<Lamp> {
    let mut random = Rng::with_seed(count as u64);
    let lamp = |i: usize| {
        let mut colour = || {
            let mut channel = || between(&mut random, 0.5, 2.0) / count as f32;
            LinearRgba::rgb(channel(), channel(), channel())
        };
        let (ambient, diffuse, specular) = (colour(), colour(), colour());
        let at =
            Vec3::new(between(&mut random, -2.0, 2.0), between(&mut random, 0.8, 2.5), between(&mut random, -2.0, 2.0));
        let down = Vec3::new(between(&mut random, -0.5, 0.5), -1.0, between(&mut random, -0.5, 0.5));
        let light = PointLight {
            ambient,
            diffuse,
            specular,
            attenuation: Attenuation::new(0.5, 0.1, 0.1),
            range: i.is_multiple_of(5).then_some(9.0),
            attenuate_ambient: i.is_multiple_of(7),
        };
        match i % 3 {
            0 => Lamp::directional(DirectionalLight { ambient, diffuse, specular }, down),
            1 => Lamp::point(light, at),
            _ => Lamp::spot(SpotLight { light, cone: Cone { cutoff: 1.2, inner: Some(0.4), exponent: 1.0 } }, at, down),
        }
    };
    (0..count).map(lamp).collect()
}

#[test]
fn any_number_of_lights_adds_up() {
    let mut stage = Stage::new(SIZE, SIZE);
    let mut failures = Failures::default();
    // Up, and down again: buffers that have grown serve shorter lists too.
    for count in COUNTS.into_iter().chain([129, 3, 0]) {
        let lamps = mixed_lamps(count);
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            let mut scene = over_floor().with(floor().shaded(shading));
            scene.lamps.clone_from(&lamps);
            failures.draw(&format!("{count} lights, {shading:?}"), &mut stage, &scene, FLOAT);
            assert_eq!(stage.report().lights as usize, count, "{shading:?}");
        }
    }
    failures.finish();
}

#[test]
fn mixed_frequencies_shade_from_two_lists_of_any_length() {
    let mut stage = Stage::new(SIZE, SIZE);
    let mut failures = Failures::default();
    // Each light is in both lists, so their lengths add up: 4 + 4, 5 + 5, 64 + 64, 65 + 65.
    for count in [1, 4, 5, 64, 65, 200] {
        for (diffuse, specular) in [(Frequency::Vertex, Frequency::Fragment), (Frequency::Fragment, Frequency::Vertex)]
        {
            let mut scene = over_floor().with(floor().terms(diffuse, specular));
            scene.lamps = mixed_lamps(count);
            let row = format!("{count} lights, diffuse {diffuse:?}, specular {specular:?}");
            failures.draw(&row, &mut stage, &scene, FLOAT);
        }
    }
    failures.finish();
}

#[test]
fn objects_of_one_frame_may_use_lists_of_different_lengths() {
    let mut stage = Stage::new(24, SIZE);
    let mut failures = Failures::default();
    let strip = |x: f32| Thing::new(Plane { size: 1.0, divisions: 2 }).at(Transform::from_xyz(x, 0.0, 0.0));
    // Nothing, half of the terms, all of them, and all of them in two lists: 0, n, n and 2n lights.
    for count in [1, 5, 8, 70, 100, 128, 150] {
        let mut scene = over_floor()
            .with(strip(-1.5).with_material(Material::emissive(LinearRgba::rgb(0.1, 0.2, 0.3))))
            .with(strip(-0.5).terms(Frequency::Fragment, Frequency::Never))
            .with(strip(0.5).shaded(Shading::Phong))
            .with(strip(1.5).terms(Frequency::Vertex, Frequency::Fragment))
            .with(strip(2.5).shaded(Shading::Gouraud))
            .with(strip(-2.5).shaded(Shading::Flat));
        scene.lamps = mixed_lamps(count);
        failures.draw(&format!("{count} lights"), &mut stage, &scene, FLOAT);
    }
    failures.finish();
}

#[test]
fn the_last_light_of_every_kind_shines() {
    let mut stage = Stage::new(8, 8);
    let square = Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 9.0).with_material(Material::matte(LinearRgba::WHITE));
    for count in COUNTS.into_iter().filter(|&count| count > 0) {
        for kind in 0..3 {
            let lamp = |i: usize| {
                let grey = if i + 1 == count { LinearRgba::rgb(0.5, 0.5, 0.5) } else { LinearRgba::BLACK };
                let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::new(grey) };
                match kind {
                    0 => Lamp::directional(DirectionalLight::new(grey), Vec3::NEG_Z),
                    1 => Lamp::point(light, Vec3::Z * 1e4),
                    _ => Lamp::spot(SpotLight { light, cone: Cone::new(0.5) }, Vec3::Z * 1e4, Vec3::NEG_Z),
                }
            };
            let mut scene = Scene::in_eye_space().with(square.clone());
            scene.lamps = (0..count).map(lamp).collect();
            let centre = stage.draw(&scene).get_pixel(4, 4).0[0];
            // n·l = 1 but for the 10⁻⁴ rad under which the light is seen.
            assert!((centre - 0.5).abs() < 1e-6, "{count} lights, kind {kind}: {centre}");
        }
    }
}

#[test]
fn a_thousand_equal_lights_are_one_a_thousand_times_as_bright() {
    let mut stage = Stage::new(8, 8);
    let square = Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 9.0).with_material(Material::matte(LinearRgba::WHITE));
    for count in COUNTS.into_iter().filter(|&count| count > 0) {
        let share = 1.0 / count as f32;
        let light = DirectionalLight::new(LinearRgba::rgb(share, share, share));
        let mut scene = Scene::in_eye_space().with(square.clone());
        scene.lamps = vec![Lamp::directional(light, Vec3::NEG_Z); count];
        let centre = stage.draw(&scene).get_pixel(4, 4).0[0];
        // A sum of n equal numbers is off by at most n half steps of 6·10⁻⁸.
        assert!((centre - 1.0).abs() <= (count + 4) as f32 * 6e-8, "{count} lights: {centre}");
    }
}

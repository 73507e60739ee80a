//! Terms shaded at different frequencies, and the pure cases: flat, Gouraud and Phong.

use crate::render::compare::{FLOAT, Failures, assert_as_expected, assert_identical, difference};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, other_material, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;

const FREQUENCIES: [Frequency; 3] = [Frequency::Never, Frequency::Vertex, Frequency::Fragment];

/// A coarse sphere, where frequencies differ much, under a light of each kind; one attenuates its ambient.
fn coarse_sphere() -> Scene {
    let spot = SpotLight {
        light: PointLight { attenuate_ambient: true, ..point_light() },
        cone: Cone { cutoff: 0.6, inner: None, exponent: 2.0 },
    };
    let at = Vec3::new(-1.5, 1.0, 2.5);
    Scene::seen_from(Vec3::new(0.3, 0.5, 3.0), Vec3::ZERO)
        .ambient(0.1)
        .with(Thing::new(UvSphere::new(1.0, 10, 5)))
        .lit(Lamp::directional(directional_light(), Vec3::new(-1.0, -0.7, -0.8)))
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.5, 1.5)))
        .lit(Lamp::spot(spot, at, -at))
}

#[test]
fn every_pair_of_frequencies_matches_the_equations() {
    let mut stage = Stage::new(48, 48);
    for diffuse in FREQUENCIES {
        for specular in FREQUENCIES {
            for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
                let mut scene = coarse_sphere();
                scene.things[0] = scene.things[0].clone().terms(diffuse, specular).reflecting(reflectance);
                let row = format!("diffuse {diffuse:?}, specular {specular:?}, {reflectance:?}");
                assert_as_expected(&row, &mut stage, &scene);
            }
        }
    }
}

#[test]
fn mixed_terms_are_right_on_both_sides() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let square = Thing::square(Vec3::ZERO, Vec3::new(0.2, 0.3, 1.0), 3.0).back(other_material());
    for (side, eye) in [("front", Vec3::new(0.0, 0.2, 3.0)), ("back", Vec3::new(0.3, 0.4, -3.0))] {
        for faces in [Faces::Front, Faces::Back, Faces::Both] {
            let thing = square.clone().faces(faces).terms(Frequency::Vertex, Frequency::Fragment);
            let scene = Scene::seen_from(eye, Vec3::ZERO)
                .ambient(0.1)
                .with(thing)
                .lit(Lamp::point(point_light(), Vec3::new(0.4, 0.5, 1.5)))
                .lit(Lamp::point(point_light(), Vec3::new(-0.3, 0.4, -1.5)));
            let row = format!("{faces:?} faces, {side} seen");
            let verdict = failures.draw_any(&row, &mut stage, &scene, FLOAT);
            let seen = if side == "front" { faces.shows_front() } else { faces.shows_back() };
            failures.unless((verdict.counted > 0.2) == seen, || format!("{row}: {verdict}"));
        }
    }
    failures.finish();
}

#[test]
fn pure_frequencies_are_the_shadings_to_the_bit() {
    let mut stage = Stage::new(48, 48);
    for (frequency, shading) in [
        (Frequency::Triangle, Shading::Flat),
        (Frequency::Vertex, Shading::Gouraud),
        (Frequency::Fragment, Shading::Phong),
    ] {
        for faces in [Faces::Front, Faces::Both] {
            let mut scene = coarse_sphere();
            scene.things[0] = scene.things[0].clone().faces(faces);
            let mut with_terms = scene.clone();
            with_terms.things[0] = scene.things[0].clone().terms(frequency, frequency);
            scene.things[0].shading = Some(shading);
            let row = format!("{frequency:?} is {shading:?}, {faces:?} faces");
            assert_identical(&row, &stage.draw(&with_terms), &stage.draw(&scene));
        }
    }
}

#[test]
fn frequencies_differ_where_they_should() {
    let mut stage = Stage::new(48, 48);
    let mut draw = |diffuse, specular| {
        let mut scene = coarse_sphere();
        scene.things[0] = scene.things[0].clone().terms(diffuse, specular);
        stage.draw(&scene)
    };
    let (vertex, fragment) = (Frequency::Vertex, Frequency::Fragment);
    let gouraud = draw(vertex, vertex);
    let hybrid = draw(vertex, fragment);
    let phong = draw(fragment, fragment);
    // On ten segments a highlight of shininess 19.5 falls between the vertices: far more than rounding.
    assert!(difference(&gouraud, &hybrid) > 0.05, "{}", difference(&gouraud, &hybrid));
    assert!(difference(&hybrid, &phong) > 0.02, "{}", difference(&hybrid, &phong));
}

#[test]
fn a_term_never_shaded_is_a_term_of_black() {
    let mut stage = Stage::new(32, 32);
    let never = |diffuse, specular| {
        let mut scene = coarse_sphere();
        scene.things[0] = scene.things[0].clone().terms(diffuse, specular);
        scene
    };
    let black = |diffuse: bool| {
        let mut scene = coarse_sphere();
        let material = &mut scene.things[0].material;
        *(if diffuse { &mut material.diffuse } else { &mut material.specular }) = LinearRgba::BLACK;
        // The ambient that attenuates goes with the diffuse term, so it goes too.
        for lamp in scene.lamps.iter_mut().filter(|_| diffuse) {
            if let crate::render::scene::Kind::Spot(spot) = &mut lamp.kind {
                spot.light.ambient = LinearRgba::BLACK;
            }
        }
        scene
    };
    for (row, scene, without) in [
        ("no specular", never(Frequency::Fragment, Frequency::Never), black(false)),
        ("no diffuse", never(Frequency::Never, Frequency::Fragment), black(true)),
    ] {
        let (never, black) = (stage.draw(&scene), stage.draw(&without));
        // A sum that starts from other zeros may round once differently.
        assert!(difference(&never, &black) <= 1e-6, "{row}: {}", difference(&never, &black));
    }
}

//! Four samples a pixel: values are interpolated at a point inside the triangle.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::render::take_picture;
use std::f32::consts::TAU;

/// Colours that were extrapolated to a pixel's centre outside the triangle went below 0 at outlines.
#[test]
fn no_intensity_is_negative_at_an_outline() {
    let mut stage = Stage::new(96, 96);
    for samples in [Samples::One, Samples::Four] {
        for (vertex, fragment) in [(Frequency::Vertex, Frequency::Vertex), (Frequency::Vertex, Frequency::Fragment)] {
            let ball = Thing::new(UvSphere::new(1.0, 96, 48)).terms(vertex, fragment);
            let mut scene = Scene::seen_from(Vec3::new(0.4, 0.3, 3.0), Vec3::ZERO)
                .with(ball)
                .lit(Lamp::point(point_light(), Vec3::new(3.0, 0.5, 0.3)));
            scene.camera.samples = samples;
            let picture = stage.draw(&scene);
            let negative = picture.pixels().filter(|pixel| pixel.0.iter().any(|&channel| channel < 0.0)).count();
            assert_eq!(negative, 0, "{samples:?}, {vertex:?} and {fragment:?}");
            let lit = picture.pixels().filter(|pixel| pixel.0[0] > 0.1).count();
            assert!(lit > 500, "{lit} pixels are lit");
        }
    }
}

/// A fan around the z axis whose middle faces away from a light along −Z and whose rim faces it.
fn fan(sectors: u16) -> Mesh {
    let mut positions = vec![Vec3::ZERO];
    positions.extend((0..sectors).map(|i| {
        let (sine, cosine) = (TAU * f32::from(i) / f32::from(sectors)).sin_cos();
        Vec3::new(cosine, sine, 0.0)
    }));
    let mut normals = vec![Vec3::Z; positions.len()];
    normals[0] = Vec3::X;
    let sectors = u32::from(sectors);
    let indices = (0..sectors).flat_map(|i| [0, 1 + i, 1 + (i + 1) % sectors]).collect();
    Mesh::from_parts(positions, Some(normals), None, indices).expect("triangles")
}

/// Colours that were extrapolated to a pixel's centre outside the triangle went above those of the vertices.
#[test]
fn no_intensity_at_an_outline_is_above_that_of_the_vertices() {
    let mut stage = Stage::new(96, 96);
    // A fully lit white: 1 at the rim, 0 in the middle.
    let black = LinearRgba::BLACK;
    let white = LinearRgba::WHITE;
    let chalk = Material { ambient: black, diffuse: white, specular: black, emission: black, ..Material::DEFAULT };
    let light = DirectionalLight { ambient: black, diffuse: white, ..directional_light() };
    for samples in [Samples::One, Samples::Four] {
        for faces in [Faces::Front, Faces::Both] {
            for (vertex, fragment) in [(Frequency::Vertex, Frequency::Vertex), (Frequency::Vertex, Frequency::Fragment)]
            {
                let thing = Thing::new(fan(7)).with_material(chalk).faces(faces).terms(vertex, fragment);
                let mut scene =
                    Scene::seen_from(Vec3::Z * 6.0, Vec3::ZERO).with(thing).lit(Lamp::directional(light, Vec3::NEG_Z));
                scene.camera.samples = samples;
                // The background is neither brighter nor darker.
                scene.camera.background = white;
                let picture = stage.draw(&scene);
                let row = format!("{samples:?}, {faces:?} faces, {vertex:?} and {fragment:?}");
                let brightest = picture.pixels().map(|pixel| pixel.0[0]).fold(0.0, f32::max);
                // Single precision.
                assert!(brightest < 1.0 + 1e-5, "{row}: {brightest}");
                let dark = picture.pixels().filter(|pixel| pixel.0[0] < 0.5).count();
                assert!(dark > 100, "{row}: {dark} pixels are darker than half of the rim");
            }
        }
    }
}

/// A ball and a blended pane, off centre and with pixels that are not square.
fn ball_and_pane(samples: Samples) -> Scene {
    let film = Film { shift: [0.1, -0.05], aspect: None, pixel_aspect: 1.25 };
    let mut scene = Scene::seen_from(Vec3::new(0.4, 0.3, 3.0), Vec3::ZERO)
        .with(Thing::new(UvSphere::new(0.8, 24, 12)).shaded(Shading::Phong))
        .with(Thing::square(Vec3::new(0.3, 0.2, 1.0), Vec3::new(0.3, 0.2, 1.0), 0.7).blended(0.5))
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)));
    scene.camera.projection = scene.camera.projection.with_film(film);
    scene.camera.background = LinearRgba::rgb(0.1, 0.4, 0.8);
    scene.camera.samples = samples;
    scene
}

/// The mean of frames is the oracle's mean of as many rays, at the same points of each pixel.
#[test]
fn sixteen_and_sixty_four_samples_are_the_mean_of_the_oracle() {
    let mut stage = Stage::new(60, 44);
    for samples in [Samples::Sixteen, Samples::SixtyFour] {
        for scene in [ball_and_pane(samples), {
            let mut scene = ball_and_pane(samples);
            scene.camera.projection = Projection::orthographic(2.2).with_film(scene.camera.projection.film());
            scene
        }] {
            stage.set(&scene);
            stage.encode(Encoding::Srgb);
            stage.bytes();
            let taken = take_picture(stage.world()).expect("a picture");
            let Picture::Byte(picture) = taken else { panic!("bytes") };
            let side = samples.side().expect("several frames");
            let mean =
                |side| stage.oracle().with_supersampling(side).with_clamping(true).draw().to_bytes(Encoding::Srgb);
            let [expected, other] = [side, 2].map(mean);
            let off = |expected: &image::RgbImage| {
                let pixels = picture.pixels().zip(expected.pixels());
                pixels.map(|(a, b)| (0..3).map(|c| a.0[c].abs_diff(b.0[c])).max().unwrap_or(0)).collect::<Vec<_>>()
            };
            // A sample on an edge falls to either side, by the grid of the vertices: a 16th of a step from 0 to 255.
            let off_expected = off(&expected);
            let far = off_expected.iter().filter(|&&steps| steps > 1).count();
            // On a grid of 4 bits a vertex is off by up to a 32nd of a pixel, an eighth of the distance between 16 samples.
            let (allowed, times) = if stage.grid_bits() < 8 { (25, 2) } else { (10, 4) };
            assert!(far * 1000 < allowed * off_expected.len(), "{samples:?}: {far} pixels are off");
            assert!(off_expected.iter().all(|&steps| steps < 30), "{samples:?}: {:?}", off_expected.iter().max());
            // A planted fault: other points of the pixels.
            let wrong = off(&other).iter().filter(|&&steps| steps > 1).count();
            assert!(wrong > times * far.max(10), "{samples:?}: {wrong} pixels differ from the mean of four");
            assert_eq!(stage.world().query::<&Camera>().single(stage.world()).expect("one").samples, samples);
        }
    }
}

#[test]
fn many_samples_beside_a_policy_of_the_whole_picture_are_refused() {
    let camera = Camera { samples: Samples::Sixteen, intensity: Intensity::Aces, ..Camera::default() };
    let error = camera.validate().expect_err("refused").to_string();
    assert!(error.contains("Camera.samples: the value is 16.0; expected 1 or 4"), "{error}");
}

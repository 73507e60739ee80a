//! Four samples a pixel: values are interpolated at a point inside the triangle.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;
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

//! Vertex colours match the oracle, and objects without them do not pay for them.

use crate::render::compare::{FLOAT, judge};
use crate::render::conformance::colors::colored;
use crate::render::scene::{Lamp, Scene, Thing, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;

fn scene(mesh: Mesh, colors: Option<VertexColors>) -> Scene {
    let thing = Thing { colors, ..Thing::new(mesh) };
    Scene::seen_from(Vec3::new(0.4, 1.0, 3.0), Vec3::ZERO)
        .ambient(0.2)
        .with(thing)
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)))
}

#[test]
fn colors_that_are_ignored_change_no_bit_and_cost_no_byte() {
    let sphere = Mesh::from(UvSphere::new(1.0, 24, 12));
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let drawn =
            [(sphere.clone(), None), (colored(sphere.clone()), Some(VertexColors::Ignore))].map(|(mesh, colors)| {
                let mut stage = Stage::new(64, 48);
                let mut scene = scene(mesh, colors);
                scene.view_shading = Some(shading);
                stage.set(&scene);
                let uploaded = stage.frame().bytes_uploaded;
                (stage.float(), uploaded, stage.report().pipelines)
            });
        assert!(drawn[0] == drawn[1], "{shading:?}: {:?} and {:?}", drawn[0].1, drawn[1].1);
    }
}

#[test]
fn one_color_everywhere_is_another_material() {
    let sphere = Mesh::from(UvSphere::new(1.0, 24, 12));
    let white = vec![Vec4::new(0.25, 0.5, 1.0, 0.5); sphere.positions().len()];
    let tinted = sphere.clone().with_colors(white).expect("a colour a vertex");
    let times = |color: LinearRgba| LinearRgba::rgb(0.25 * color.red, 0.5 * color.green, color.blue);
    let own = Material { ambient: times(material().ambient), diffuse: times(material().diffuse), ..material() };
    let mut stage = Stage::new(64, 48);
    stage.frame();
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for (opacity, samples) in [(None, Samples::One), (None, Samples::Four), (Some(0.7), Samples::One)] {
            // Not every adapter blends floats, and at outlines drivers interpolate the same color to different values.
            if (opacity, samples) != (None, Samples::One) && !stage.is_on_cpu() {
                continue;
            }
            let [a, b] = [(&tinted, material(), 1.0), (&sphere, own, 0.5)].map(|(mesh, of, share)| {
                let mut scene = scene(mesh.clone(), None);
                scene.view_shading = Some(shading);
                scene.camera.samples = samples;
                scene.things[0].material = of;
                if let Some(opacity) = opacity {
                    scene.things[0] = scene.things[0].clone().blended(opacity * share);
                }
                stage.draw(&scene)
            });
            let most = a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most < 2e-6, "{shading:?}, {opacity:?}, {samples:?}: {most:e}");
        }
    }
}

#[test]
fn a_picture_without_vertex_colors_is_found() {
    let mut stage = Stage::new(64, 48);
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let mesh = colored(UvSphere::new(1.0, 24, 12));
        let mut wrong = scene(mesh, Some(VertexColors::Ignore));
        wrong.view_shading = Some(shading);
        let without = stage.draw(&wrong);
        wrong.things[0].colors = None;
        stage.set(&wrong);
        stage.frame();
        let (verdict, _) = judge(&mut stage, &Image::from_float(&without), FLOAT);
        assert!(!verdict.is_within(), "{shading:?}: {verdict}");
    }
}

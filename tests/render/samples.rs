//! Four samples a pixel: what is interpolated is taken where the triangle is.

use crate::render::scene::{Lamp, Scene, Thing, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;

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

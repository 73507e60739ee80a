//! Lights at the exact position of a vertex.

use crate::render::compare::{Failures, SRGB};
use crate::render::scene::{Lamp, Scene, Thing, rotated};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// The direction and the intensity of such a light once came from rounding errors.
#[test]
fn a_light_on_a_vertex_shines_along_the_normal() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let sphere = UvSphere::new(1.0, 12, 6);
    let positions = Mesh::from(sphere).positions().to_vec();
    // A millionth of white, which the largest attenuation makes white at the vertex.
    let faint = LinearRgba::rgb(1e-6, 0.7e-6, 0.4e-6);
    let light = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::new(faint) };
    for (number, vertex) in positions.iter().enumerate().step_by(3) {
        let turned = rotated(0.3 + 0.1 * number as f32, 0.5, 0.2).with_translation(Vec3::new(3.1, -0.7, 0.9));
        let at = turned.transform_point(*vertex);
        // From a point where the vertex is visible.
        let middle = turned.translation;
        let scene = Scene::seen_from(middle + 3.5 * (at - middle) + Vec3::new(0.2, 0.3, 0.1), middle)
            .with(Thing::new(sphere).at(turned).shaded(Shading::Gouraud))
            .lit(Lamp::point(light, at));
        stage.set(&scene);
        let picture = stage.bytes();
        let row = format!("vertex {number}");
        failures.compare_bytes(&row, &mut stage, &picture, SRGB);
        let brightest = picture.pixels().map(|pixel| pixel.0[0]).max().unwrap_or(0);
        failures.unless(brightest > 100, || format!("{row}: the vertex is dark, {brightest}"));
    }
    failures.finish();
}

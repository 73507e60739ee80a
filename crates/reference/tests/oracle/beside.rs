//! The judge on pixels beside a triangle, by less than the grid of a rasterizer.

use bevy_math::{Vec2, Vec3};
use halfway_lighting::{DirectionalLight, Shading};
use halfway_reference::Oracle;

use crate::mutants::{assert_caught, at_pixel, float, oracle, with};
use crate::scene::{Stage, chalk, grey, triangle};

/// A triangle 0.15 of a pixel high, bright along the lower side and dark at the corner above it, that ends 0.0015 of a
/// pixel above the middles of row 40: a grid of 1/256 may move it there.
fn steep() -> Stage {
    let corner = |x, y| at_pixel(Vec3::NEG_Z, Vec2::new(x, y));
    let (bottom, dark) = (BOTTOM as f32, (BOTTOM - 0.15) as f32);
    let mesh =
        triangle([corner(10.0, bottom), corner(80.0, bottom), corner(45.0, dark)], Some([Vec3::Z, Vec3::Z, Vec3::X]));
    let mut stage = Stage::new();
    stage.sun(DirectionalLight { diffuse: grey(1.0), ..DirectionalLight::white() }, Vec3::NEG_Z);
    stage.add(mesh, (chalk(0.8), Shading::Gouraud));
    stage
}

const BOTTOM: f64 = 40.4985;

/// The triangle's colour at a point of the picture, on it or below it.
fn color(truth: &Oracle, x: f64, y: f64) -> [f64; 3] {
    let [here, above] = [0.01, 0.02].map(|above| truth.probe(x, BOTTOM - above).color);
    let more = (y - (BOTTOM - 0.01)) / 0.01;
    std::array::from_fn(|k| here[k] + more * (here[k] - above[k]))
}

#[test]
fn colors_extend_beside_a_triangle_as_far_as_the_grid() {
    let mut truth = steep();
    let judged = oracle(&mut truth);
    let picture = judged.draw();
    assert!(
        picture.pixels().iter().flatten().all(|channel| channel.abs() < 1e-12),
        "it lies between the middles of pixels"
    );
    let row = |below: f64| -> Vec<_> {
        (40..50).map(|x| ((x, 40), color(&judged, f64::from(x) + 0.5, BOTTOM + below))).collect()
    };
    let covered = |below: f64| with(&picture, row(below));
    for below in [-0.01, 0.0, 0.0015] {
        let verdict = float(&judged, &covered(below));
        assert!(verdict.is_within(), "{below} beside it: {verdict}");
    }
    let brightest = judged.probe(45.5, BOTTOM - 1e-6).color[0];
    assert!(row(0.0015)[0].1[0] > 1.008 * brightest, "no steeper than what the bars allow");
    for (fault, below) in [("two steps of a fine grid", 1.0 / 128.0), ("a step of a coarse grid", 1.0 / 16.0)] {
        assert_caught(&format!("colours from {fault} beside it"), &mut truth, &covered(below));
    }
}

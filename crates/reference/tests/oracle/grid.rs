//! Vertices on the grid that a rasterizer rounds to.

use bevy_color::LinearRgba;
use bevy_math::Vec4;
use halfway_lighting::{GlobalAmbient, Material};
use halfway_mesh::Mesh;
use halfway_reference::Image;

use crate::scene::{Stage, panel};

/// A rectangle at depth 1 with a colour at each corner, on a picture of 16 × 16 pixels that shows 2 × 2 units there.
fn ramp(left: f32, right: f32, bottom: f32, top: f32) -> Stage {
    let mut stage = Stage::new();
    stage.world.insert_resource(GlobalAmbient(LinearRgba::WHITE));
    let colors = [[0.1, 0.2], [0.9, 0.4], [0.8, 0.9], [0.3, 0.6]].map(|[r, g]| Vec4::new(r, g, 0.5, 1.0));
    let mesh: Mesh = panel(left, right, bottom, top, 1.0).with_colors(colors.to_vec()).expect("a colour a vertex");
    stage.add(mesh, Material { ambient: LinearRgba::WHITE, diffuse: LinearRgba::BLACK, ..Material::DEFAULT });
    stage
}

fn difference(a: &Image, b: &Image) -> f64 {
    let channels = |image: &Image| image.pixels().iter().flatten().copied().collect::<Vec<f64>>();
    channels(a).into_iter().zip(channels(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn what_is_interpolated_goes_with_the_rounded_corners() {
    // Corners at 2.15 and 10.15 pixels, which whole pixels bring to 2 and 10, and quarters to 2.25 and 10.25.
    let mut stage = ramp(-0.73125, 0.26875, -0.26875, 0.73125);
    let exact = stage.oracle(16, 16).draw();
    for (bits, moved) in [(0, -0.15 / 8.0), (2, 0.1 / 8.0)] {
        let on_grid = stage.oracle(16, 16).on_grid(bits).draw();
        let mut by_hand = ramp(-0.73125 + moved, 0.26875 + moved, -0.26875 - moved, 0.73125 - moved);
        let expected = by_hand.oracle(16, 16).draw();
        // Positions are f32.
        let error = difference(&on_grid, &expected);
        assert!(error < 1e-6, "{bits} bits: {error}");
        assert!(difference(&on_grid, &exact) > 1e-3, "{bits} bits move nothing");
    }
    assert!(difference(&stage.oracle(16, 16).on_grid(24).draw(), &exact) < 1e-6);
}

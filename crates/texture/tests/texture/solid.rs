//! Solid textures: their position, their pattern, and invalid fields.

use halfway_texture::noise::{LEAST_WIDTH, checker, fractal, marble, wood};
use halfway_texture::solid::solid_value;
use halfway_texture::{SolidKind, SolidTexture};

const STILL: [[f64; 3]; 2] = [[0.0; 3]; 2];

/// Doubled, turned by a right angle around z, and moved.
const COLUMNS: [[f32; 4]; 4] =
    [[0.0, 2.0, 0.0, 0.0], [-2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0], [0.25, 0.5, -0.75, 1.0]];

#[test]
fn a_point_lies_where_the_matrix_says() {
    let colors = [[0.125, 0.25, 0.5], [1.0, 0.75, 0.0]];
    let p = [0.3, -0.4, 0.7];
    let q = [0.8 + 0.25, 0.6 + 0.5, 1.4 - 0.75];
    let ways = [[0.01, 0.0, 0.02], [0.0, -0.03, 0.0]];
    let turned = [[0.0, 0.02, 0.04], [0.06, 0.0, 0.0]];
    for kind in SolidKind::ALL {
        let solid = SolidTexture::new(kind, colors).placed(COLUMNS);
        let t = solid_value(kind, solid.octaves, q, turned);
        let expected = [0, 1, 2].map(|c| f64::from(colors[0][c]) * (1.0 - t) + f64::from(colors[1][c]) * t);
        let found = solid.color_at(p, ways);
        assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-7), "{kind:?}: {found:?}, not {expected:?}");
        // As many cells again to a length: the same at half the way.
        let finer = SolidTexture::new(kind, colors).scaled(2.0).color_at(p.map(|x| 0.5 * x), STILL);
        assert_eq!(finer, SolidTexture::new(kind, colors).color_at(p, STILL), "{kind:?}");
    }
}

#[test]
fn each_kind_is_its_function_at_its_width() {
    let q = [1.3, -2.6, 0.45];
    let ways = [[0.1, 0.0, 0.2], [0.0, -0.3, 0.1]];
    let longer = (0.3_f64.powi(2) + 0.1_f64.powi(2)).sqrt();
    let sides = [0.1, 0.3, 0.05_f64.sqrt()];
    let half_on = q.map(|x| x + 0.5);
    let value = |kind| solid_value(kind, 4, q, ways);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a}, not {b}");
    near(value(SolidKind::Checker), checker(half_on, sides));
    near(value(SolidKind::Marble), marble(q, 4, longer));
    near(value(SolidKind::Wood), wood(q, longer));
    near(value(SolidKind::Noise), 0.5 + 0.5 * fractal(q, 4, longer));
    // From afar all are their means.
    let far = [[40.0, 30.0, 20.0], [10.0, -30.0, 50.0]];
    for kind in SolidKind::ALL {
        assert!((solid_value(kind, 4, q, far) - 0.5).abs() < 1e-3, "{kind:?}");
    }
}

#[test]
fn cubes_have_their_middles_at_whole_numbers() {
    let at = |x: f64, y: f64, z: f64| solid_value(SolidKind::Checker, 1, [x, y, z], STILL);
    for (x, y, z) in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 2, 4), (-3, -3, -3)] {
        let expected = f64::from((x + y + z) & 1);
        for offset in [0.0, 0.49, -0.49] {
            let [x, y, z] = [x, y, z].map(|number: i32| f64::from(number) + offset);
            assert_eq!(at(x, y, z), expected, "{x} {y} {z}");
        }
    }
    // Between two cubes the mean, despite rounding of the position; one of them at a least width beside.
    assert_eq!(at(0.5, 0.0, 0.0), 0.5);
    let rounding = 1e-7;
    assert!((at(0.5 + rounding, 0.0, 0.0) - 0.5).abs() < 2e-4);
    assert_eq!(at(0.5 + f64::from(LEAST_WIDTH), 0.0, 0.0), 1.0);
}

#[test]
fn checkers_are_exact_far_from_an_edge() {
    // As a difference of integrals over the width it was off by 10⁻³ there.
    for k in 0..1000 {
        let x = 7.2 + 0.6 * k as f32 / 1000.0;
        assert_eq!(checker([x, 0.3, 40.7], [0.003, 0.001, 0.002]), 1.0, "{x}");
    }
}

#[test]
fn invalid_fields_are_named() {
    let right = SolidTexture::default();
    assert_eq!(right.wrong(), None);
    assert_eq!(right.with_octaves(16).wrong(), None);
    let mut place = right;
    place.solid_from_object[2][3] = f32::NAN;
    let mut color = right;
    color.colors[0][1] = -0.1;
    let named = [
        (right.with_octaves(0), "octaves"),
        (right.with_octaves(17), "octaves"),
        (place, "solid_from_object"),
        (color, "colors"),
    ];
    for (solid, field) in named {
        assert_eq!(solid.wrong().map(|wrong| wrong.field), Some(field));
    }
}

//! Lengths and directions at any magnitude.

use halfway_lighting::equations::vector::{cross, length, normalize, toward};

#[test]
fn lengths_neither_underflow_nor_overflow() {
    let rows: [(&str, [f32; 3], f32); 6] = [
        ("zero", [0.0; 3], 0.0),
        ("3-4-5", [3.0, 0.0, -4.0], 5.0),
        ("tiny", [3e-30, 0.0, 4e-30], 5e-30),
        ("huge", [3e30, 4e30, 0.0], 5e30),
        ("beyond the range", [f32::MAX, f32::MAX, 0.0], f32::MAX),
        ("infinite", [f32::NEG_INFINITY, 0.0, 0.0], f32::MAX),
    ];
    for (name, vector, expected) in rows {
        let got = length(vector);
        // A division, a square root and a product: three roundings.
        assert!((got - expected).abs() <= expected * 2e-7, "{name}: {got:e} against {expected:e}");
    }
}

#[test]
fn directions_exist_unless_zero_or_not_finite() {
    for size in [1e-44f32, 1e-30, 1.0, 1e30, f32::MAX] {
        assert_eq!(normalize([0.0, -size, 0.0]), Some([0.0, -1.0, 0.0]), "{size:e}");
    }
    for nothing in [[0.0f32; 3], [f32::NAN, 1.0, 0.0], [1.0, f32::NAN, 0.0], [0.0, 0.0, f32::INFINITY]] {
        assert_eq!(normalize(nothing), None, "{nothing:?}");
    }
}

#[test]
fn the_way_from_point_to_point() {
    let p = [1f32, 2.0, 3.0];
    assert_eq!(toward(p, p), (None, 0.0));
    assert_eq!(toward(p, [1.0, 2.0, 8.0]), (Some([0.0, 0.0, 1.0]), 5.0));
    let [low, high] = [[-f32::MAX, 0.0, 0.0], [f32::MAX, 0.0, 0.0]];
    assert_eq!(toward(low, high), (Some([1.0, 0.0, 0.0]), f32::MAX), "a difference beyond the range of f32");
    assert_eq!(toward(high, low), (Some([-1.0, 0.0, 0.0]), f32::MAX));
}

#[test]
fn the_cross_product_is_right_handed() {
    assert_eq!(cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
}

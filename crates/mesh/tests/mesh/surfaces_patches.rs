//! Patches and height fields against the definitions of what they are made of.

use glam::DVec3;
use halfway_mesh::{BezierPatch, HeightField, Parameter, ParametricSurface};

use crate::surfaces_common::{cubic, scattered};

/// De Casteljau's algorithm.
fn de_casteljau(mut points: Vec<DVec3>, t: f64) -> DVec3 {
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    points[0]
}

#[test]
fn bezier_patches_of_any_degree_agree_with_de_casteljau() {
    for (rows, columns) in [(2, 2), (2, 5), (3, 3), (4, 4), (6, 3), (9, 12), (33, 33)] {
        let point = |i: usize| DVec3::new((i as f64 * 1.7).sin(), (i as f64 * 2.3).cos(), (i as f64 * 0.9).sin());
        let points: Vec<DVec3> = (0..rows * columns).map(point).collect();
        let patch = BezierPatch::new(columns, points.clone()).unwrap();
        assert_eq!((patch.rows(), patch.columns()), (rows, columns));
        for (u, v) in scattered().take(20).chain([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]) {
            let along = points.chunks(columns).map(|row| de_casteljau(row.to_vec(), v)).collect();
            let p = patch.position(u.into(), v.into());
            // The coordinates are at most 1, and so are the sums of the weights.
            assert!(
                p.distance(de_casteljau(along, u)) < 1e-14 * (rows + columns) as f64,
                "{rows} × {columns}: {u}, {v}"
            );
        }
    }
}

#[test]
fn polynomials_are_their_monomials() {
    let (rows, columns) = (5, 4);
    let coefficient = |i: usize| DVec3::new((i as f64 * 1.1).sin(), (i as f64 * 0.7).cos(), (i as f64 * 2.9).sin());
    let coefficients: Vec<DVec3> = (0..rows * columns).map(coefficient).collect();
    let patch = BezierPatch::from_polynomial(columns, coefficients.clone()).unwrap();
    for (u, v) in scattered().take(50) {
        let terms = coefficients.iter().enumerate();
        let sum: DVec3 = terms.map(|(i, &c)| c * u.powi((i / columns) as i32) * v.powi((i % columns) as i32)).sum();
        // Twenty terms of about 1.
        assert!(patch.position(u.into(), v.into()).distance(sum) < 1e-13, "{u}, {v}");
    }
    // u² − u v + v³/2 over (−v, u).
    let p = cubic().position(0.5.into(), 0.25.into());
    assert!(p.distance(DVec3::new(-0.25, 0.25 - 0.125 + 1.0 / 128.0, 0.5)) < 1e-15, "{p}");
}

#[test]
fn a_height_field_passes_through_its_samples_smoothly() {
    let height = |i: u32, j: u32| (f64::from(i) * 1.3).sin() as f32 + (f64::from(j) * 0.9).cos() as f32;
    let heights: Vec<f32> = (0..5).flat_map(|i| (0..7).map(move |j| height(i, j))).collect();
    let field = HeightField::new(3.0, 2.0, 7, heights.clone()).unwrap();
    for (i, j) in (0..5).flat_map(|i| (0..7).map(move |j| (i, j))) {
        let p = field.at(Parameter::fraction(i, 4), Parameter::fraction(6 - j, 6));
        let expected = DVec3::new(f64::from(j) / 2.0 - 1.5, f64::from(height(i, j)), f64::from(i) / 2.0 - 1.0);
        assert!(p.position.distance(expected) < 1e-14, "{} {expected}", p.position);
        // From either side of the lines between cells.
        for (du, dv) in [(-1e-9, 0.3e-9), (1e-9, -0.3e-9)] {
            let (u, v) = (f64::from(i) / 4.0 + du, 1.0 - f64::from(j) / 6.0 + dv);
            let near = field.at(u.clamp(0.0, 1.0).into(), v.clamp(0.0, 1.0).into());
            assert!(p.normal.distance(near.normal) < 1e-6, "{i}, {j}: {} {}", p.normal, near.normal);
        }
    }
    // Samples of a plane make the plane.
    let heights = (0..12_u16).map(|i| 0.5 * f32::from(i / 4) - 0.25 * f32::from(i % 4)).collect();
    let slope = HeightField::new(3.0, 2.0, 4, heights).unwrap();
    for (u, v) in scattered().take(50) {
        let p = slope.at(u.into(), v.into());
        let expected = 0.5 * (p.position.z + 1.0) - 0.25 * (p.position.x + 1.5);
        assert!((p.position.y - expected).abs() < 1e-14);
        assert!(p.normal.distance(DVec3::new(0.25, 1.0, -0.5).normalize()) < 1e-14);
    }
}

//! Normals under transforms.

use glam::{DMat3, DVec3};
use halfway_lighting::equations::vector::{cross, dot, length, normalize, scale};
use halfway_lighting::equations::{normal_matrix, transform_normal};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::support::{Pcg, close, close3, to_f64};

type Mat3 = [[f64; 3]; 3];
/// Name, matrix, normal, transformed normal.
type Row = (&'static str, Mat3, [f64; 3], Option<[f64; 3]>);

fn apply(m: Mat3, v: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| m[0][i] * v[0] + m[1][i] * v[1] + m[2][i] * v[2])
}

fn diagonal(x: f64, y: f64, z: f64) -> Mat3 {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

fn random_matrix(rng: &mut Pcg) -> Mat3 {
    core::array::from_fn(|_| core::array::from_fn(|_| rng.between(-1.0, 1.0)))
}

fn determinant(m: Mat3) -> f64 {
    dot(m[0], cross(m[1], m[2]))
}

/// The definition, straight from the cofactors.
fn by_definition(m: Mat3, n: [f64; 3]) -> [f64; 3] {
    let cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let raw = scale(apply(cofactors, n), determinant(m).signum());
    scale(raw, dot(raw, raw).sqrt().recip())
}

#[test]
fn it_is_the_signed_cofactor_matrix() {
    let mut rng = Pcg::new(7);
    for round in 0..2000 {
        let (m, n) = (random_matrix(&mut rng), rng.direction());
        if determinant(m).abs() < 1e-3 {
            continue;
        }
        let got = transform_normal(normal_matrix(m), n).expect("an invertible matrix keeps normals");
        close3(got, by_definition(m, n), 1e-11, &format!("round {round}"));
    }
}

#[test]
fn transformed_normals_stay_perpendicular_and_outside() {
    let mut rng = Pcg::new(8);
    for round in 0..2000 {
        let m = random_matrix(&mut rng);
        let n = rng.direction();
        let tangent = cross(n, rng.direction());
        let got = transform_normal(normal_matrix(m), n).expect("a random matrix is invertible");
        let moved = apply(m, tangent);
        let size = dot(moved, moved).sqrt();
        close(dot(got, moved) / size, 0.0, 1e-9, &format!("round {round}"));
        // A point just outside stays outside, also under a mirroring matrix.
        assert!(dot(got, apply(m, n)) > 0.0, "round {round}: the normal points inside");
    }
}

#[test]
fn special_matrices() {
    let n = [0.6, 0.0, 0.8];
    let rows: [Row; 9] = [
        ("identity", diagonal(1.0, 1.0, 1.0), n, Some(n)),
        ("uniform scale", diagonal(7.0, 7.0, 7.0), n, Some(n)),
        ("stretched in x by 4/3: x flattens", diagonal(4.0 / 3.0, 1.0, 1.0), n, Some([0.490_261, 0.0, 0.871_576])),
        ("mirrored in x", diagonal(-1.0, 1.0, 1.0), n, Some([-0.6, 0.0, 0.8])),
        ("point reflection", diagonal(-1.0, -1.0, -1.0), n, Some([-0.6, 0.0, -0.8])),
        ("flattened to xy", diagonal(1.0, 1.0, 0.0), n, Some([0.0, 0.0, 1.0])),
        ("flattened, a normal in the plane", diagonal(1.0, 1.0, 0.0), [1.0, 0.0, 0.0], None),
        ("flattened to a line", diagonal(1.0, 0.0, 0.0), n, None),
        ("nothing left", diagonal(0.0, 0.0, 0.0), n, None),
    ];
    for (name, m, n, expected) in rows {
        let got = transform_normal(normal_matrix(m), n);
        assert_eq!(got.is_some(), expected.is_some(), "{name}: {got:?}");
        if let (Some(got), Some(expected)) = (got, expected) {
            close3(got, expected, 1e-6, name);
        }
    }
}

#[test]
fn a_singular_matrix_with_full_columns_gives_the_planes_normal() {
    // The columns span the plane x + y + z = 0.
    let m = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 0.0, -1.0]];
    for (single, name) in [(false, "f64"), (true, "f32")] {
        let n = [0.0, 0.0, 1.0];
        let got = if single {
            let small = normal_matrix(m.map(|c| c.map(|x| x as f32)));
            transform_normal(small, n.map(|x| x as f32)).map(|a| a.map(f64::from))
        } else {
            transform_normal(normal_matrix(m), n)
        };
        let got = got.expect("rank 2");
        close(got[0].abs(), 1f64 / 3f64.sqrt(), 1e-6, name);
        close3(got, [got[0]; 3], 1e-6, name);
    }
}

#[test]
fn a_flattening_in_any_direction_has_no_random_sign() {
    let mut rng = Pcg::new(10);
    for round in 0..2000 {
        let [first, second] = [0, 1].map(|_| {
            let axis = DVec3::from_array(rng.direction());
            DMat3::from_axis_angle(axis, rng.between(0.0, 6.0))
        });
        let n = DVec3::from_array(rng.direction());
        // cof(A·diag(1, 1, 0)·B) = A·diag(0, 0, 1)·B for rotations A and B: the normal is ±A·z.
        let side = (second * n).z;
        let m = first * DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)) * second;
        let shortest = m.x_axis.length().min(m.y_axis.length()).min(m.z_axis.length());
        if side.abs() < 0.01 || shortest < 0.1 {
            continue;
        }
        let expected = first.z_axis * side.signum();
        let name = format!("round {round}");
        let double = transform_normal(normal_matrix(m.to_cols_array_2d()), n.to_array()).expect("rank 2");
        close3(double, expected.to_array(), 1e-12, &name);
        let single = normal_matrix(m.to_cols_array_2d().map(|column| column.map(|x| x as f32)));
        let single = transform_normal(single, n.to_array().map(|x| x as f32)).expect("rank 2");
        // Cofactors of unit columns are off by 1e-7 each, and the sum of them is at least 0.01·0.1² long.
        close3(single.map(f64::from), expected.to_array(), 1e-3, &name);
    }
}

#[test]
fn scales_neither_underflow_nor_overflow_in_f32() {
    let n = [0.6f32, 0.0, 0.8];
    for size in [1e-30f32, 1e-18, 1.0, 1e18, 1e30] {
        let m = [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, -size]];
        let got = transform_normal(normal_matrix(m), n).expect("defined at any size");
        close3(got.map(f64::from), [0.6, 0.0, -0.8], 1e-6, &format!("size {size:e}"));
    }
    // Thin in z by 10³⁰: every normal but those in the plane turns to z.
    let thin = [[1f32, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1e-30]];
    assert_eq!(transform_normal(normal_matrix(thin), n), Some([7.5e-31, 0.0, 1.0]));
    assert_eq!(transform_normal(normal_matrix(thin), [1.0, 0.0, 0.0]), Some([1.0, 0.0, 0.0]));
}

/// A column of any size: any direction, one axis, another column over again, or 0.
fn columns() -> impl Strategy<Value = [[f32; 3]; 3]> {
    let size = prop_oneof![1 => Just(0.0), 6 => (-8f32..=8.0).prop_map(|x| 10f32.powf(x))];
    let column = (prop::array::uniform3(-1f32..=1.0), size, 0..6u8);
    prop::array::uniform3(column).prop_map(|columns| {
        let mut m = [[0f32; 3]; 3];
        for (i, (direction, size, kind)) in columns.into_iter().enumerate() {
            m[i] = match kind {
                0 if i > 0 => m[i - 1],
                1 => core::array::from_fn(|k| if k == i { size } else { 0.0 }),
                2 => core::array::from_fn(|k| if k == i { -size } else { 0.0 }),
                _ => direction.map(|x| x * size),
            };
        }
        m
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 12_000,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1971),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_transform_gives_a_normal_or_none(m in columns(), n in prop::array::uniform3(-1f32..=1.0)) {
        prop_assume!(n != [0.0; 3]);
        let n: [f32; 3] = normalize(n).expect("a direction");
        let (m64, n64) = (m.map(to_f64), to_f64(n));
        let got = [transform_normal(normal_matrix(m), n).map(to_f64), transform_normal(normal_matrix(m64), n64)];
        for normal in got.into_iter().flatten() {
            prop_assert!((length(normal) - 1.0).abs() < 1e-6, "{normal:?}");
        }
        let Some(off) = angle_of_rounding(m64, n64) else { return Ok(()) };
        let [Some(single), Some(double)] = got else { return Err(TestCaseError::fail(format!("{got:?}"))) };
        let apart = length([0, 1, 2].map(|i| single[i] - double[i]));
        prop_assert!(apart <= off, "{single:?} against {double:?}: {apart:e} apart, and rounding explains {off:e}");
    }
}

/// The largest angle by which rounding to f32 may turn the normal of a transform; `None` if it may lose the normal
/// altogether.
fn angle_of_rounding(m: Mat3, n: [f64; 3]) -> Option<f64> {
    let lengths = m.map(length);
    let unit = m.map(|column| normalize(column).unwrap_or([0.0; 3]));
    let cofactors = [cross(unit[1], unit[2]), cross(unit[2], unit[0]), cross(unit[0], unit[1])];
    // A sign within rounding of 0 may go either way.
    let signed = dot(unit[0], cofactors[0]).abs() > 4e-6;
    let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
    let shares = lengths.map(|s| if s <= shortest { 1.0 } else { shortest / s });
    // A cofactor of unit columns is off by ten roundings of 6·10⁻⁸: four a column, two of its own.
    let off: f64 = (0..3).map(|j| shares[j] * n[j].abs() * 6e-7).sum();
    let whole = length([0, 1, 2].map(|i| (0..3).map(|j| shares[j] * cofactors[j][i] * n[j]).sum::<f64>()));
    (signed && off < 0.1 * whole).then(|| 2.0 * off / whole + 3e-7)
}

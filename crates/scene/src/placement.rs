//! A matrix as transforms of `bevy_transform`.
//!
//! A `Transform` is a translation, a rotation and a scale along the object's own axes; a matrix may also shear, that
//! is, leave axes that are not perpendicular. Every matrix M is U·Σ·Vᵀ with rotations U, V and a diagonal Σ (its
//! singular value decomposition), and that is two transforms, one inside the other: U and Σ outside, Vᵀ inside. So a
//! sheared matrix becomes a parent and a child, and nothing of it is lost.

use bevy_math::{DMat3, DMat4, DQuat, DVec3, Quat, Vec3};
use bevy_transform::components::Transform;

/// A matrix as transforms, the outer one first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) outer: Transform,
    /// There only where the matrix shears.
    pub(crate) inner: Option<Transform>,
}

/// The cosine between axes up to which they count as perpendicular: a few rounding steps of an `f32` rotation.
const PERPENDICULAR: f64 = 4.0 * f32::EPSILON as f64;

/// A singular value this much smaller than the largest is rounding.
const RANK: f64 = 1e-14;

impl Placement {
    /// The transforms whose product is the affine matrix `m`, to the rounding of `f32` relative to its largest axis.
    pub(crate) fn from_matrix(m: &DMat4) -> Self {
        let axes = [m.x_axis, m.y_axis, m.z_axis].map(bevy_math::DVec4::truncate);
        let translation = m.w_axis.truncate().as_vec3();
        if perpendicular(&axes) {
            let (rotation, scale) = rotation_and_scale(axes, 0.0);
            return Self { outer: Transform { translation, rotation, scale }, inner: None };
        }
        let (columns, v) = jacobi(DMat3::from_cols(axes[0], axes[1], axes[2]));
        let largest = columns.iter().map(|c| c.length()).fold(0.0, f64::max);
        let (rotation, scale) = rotation_and_scale(columns, largest * RANK);
        Self {
            outer: Transform { translation, rotation, scale },
            inner: Some(Transform::from_rotation(quat(v.transpose()))),
        }
    }
}

fn perpendicular(axes: &[DVec3; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)]
        .into_iter()
        .all(|(i, j)| axes[i].dot(axes[j]).abs() <= PERPENDICULAR * axes[i].length() * axes[j].length())
}

/// Perpendicular columns as a rotation and the lengths along its axes; the first length is negative where the columns
/// mirror. Columns not longer than `zero` get length 0 and an axis that completes the rotation.
fn rotation_and_scale(columns: [DVec3; 3], zero: f64) -> (Quat, Vec3) {
    let lengths = columns.map(DVec3::length);
    let unit = |i: usize| (lengths[i] > zero).then(|| columns[i] / lengths[i]);
    let any = DVec3::any_orthonormal_vector;
    // An axis that is missing is the cross product of the next two, in cyclic order.
    let mut axes = match [unit(0), unit(1), unit(2)] {
        [Some(x), Some(y), Some(z)] => [x, y, z],
        [None, Some(y), Some(z)] => [y.cross(z), y, z],
        [Some(x), None, Some(z)] => [x, z.cross(x), z],
        [Some(x), Some(y), None] => [x, y, x.cross(y)],
        [Some(x), None, None] => [x, any(x), x.cross(any(x))],
        [None, Some(y), None] => [y.cross(any(y)), y, any(y)],
        [None, None, Some(z)] => [any(z), z.cross(any(z)), z],
        [None, None, None] => [DVec3::X, DVec3::Y, DVec3::Z],
    };
    let mut scale = DVec3::from_array(lengths.map(|l| if l > zero { l } else { 0.0 }));
    if DMat3::from_cols(axes[0], axes[1], axes[2]).determinant() < 0.0 {
        axes[0] = -axes[0];
        scale.x = -scale.x;
    }
    (quat(DMat3::from_cols(axes[0], axes[1], axes[2])), scale.as_vec3())
}

/// One-sided Jacobi: turns the columns of `m` by a rotation V until they are perpendicular. Gives m·V and V.
///
/// After Hestenes 1958, "Inversion of matrices by biorthogonalization and related results". It converges
/// quadratically; 30 sweeps are far more than a 3×3 matrix needs.
fn jacobi(m: DMat3) -> ([DVec3; 3], DMat3) {
    let mut columns = m.to_cols_array_2d().map(DVec3::from_array);
    let mut v = [DVec3::X, DVec3::Y, DVec3::Z];
    for _ in 0..30 {
        let mut turned = false;
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            let (alpha, beta) = (columns[p].length_squared(), columns[q].length_squared());
            let gamma = columns[p].dot(columns[q]);
            if gamma == 0.0 || gamma.abs() <= f64::EPSILON * (alpha * beta).sqrt() {
                continue;
            }
            let zeta = (beta - alpha) / (2.0 * gamma);
            let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let c = t.hypot(1.0).recip();
            for columns in [&mut columns, &mut v] {
                let (a, b) = (columns[p], columns[q]);
                columns[p] = (a - b * t) * c;
                columns[q] = (a * t + b) * c;
            }
            turned = true;
        }
        if !turned {
            break;
        }
    }
    (columns, DMat3::from_cols(v[0], v[1], v[2]))
}

fn quat(rotation: DMat3) -> Quat {
    DQuat::from_mat3(&rotation).normalize().as_quat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::Mat4;

    fn product(placement: &Placement) -> Mat4 {
        let inner = placement.inner.unwrap_or_default();
        // In f64, so that only the rounding of the transforms themselves is seen.
        let of = |t: &Transform| {
            bevy_math::DMat4::from_scale_rotation_translation(
                t.scale.as_dvec3(),
                t.rotation.as_dquat().normalize(),
                t.translation.as_dvec3(),
            )
        };
        (of(&placement.outer) * of(&inner)).as_mat4()
    }

    fn matrix(rows: [[f32; 3]; 3]) -> Mat4 {
        let [x, y, z] = rows;
        Mat4::from_cols_array(&[
            x[0], y[0], z[0], 0.0, x[1], y[1], z[1], 0.0, x[2], y[2], z[2], 0.0, 5.0, -6.0, 7.0, 1.0,
        ])
    }

    #[test]
    fn every_matrix_is_kept() {
        let cases: &[(&str, [[f32; 3]; 3], bool)] = &[
            ("identity", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], false),
            ("turned", [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], false),
            ("mirrored", [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 1.0]], false),
            ("flat", [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 3.0]], false),
            ("a line", [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]], false),
            ("a line along x", [[3.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 0.0]], false),
            ("a line along z", [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]], false),
            ("nothing", [[0.0; 3]; 3], false),
            ("sheared", [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], true),
            ("sheared hard", [[1.0, 100.0, -7.0], [0.0, 1.0, 40.0], [0.0, 0.0, 1.0]], true),
            ("sheared, mirrored", [[-1.0, 0.5, 0.2], [0.0, 1.0, 0.3], [0.0, 0.0, 2.0]], true),
            ("sheared, rank 2", [[1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 2.0, 1.0]], true),
            ("sheared, rank 1", [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [3.0, 6.0, 9.0]], true),
            ("tiny", [[1e-30, 5e-31, 0.0], [0.0, 1e-30, 0.0], [0.0, 0.0, 1e-30]], true),
            ("huge", [[1e30, 5e29, 0.0], [0.0, 1e30, 0.0], [0.0, 0.0, 1e30]], true),
            ("uneven", [[1e6, 5e5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1e-6]], true),
        ];
        for (name, rows, sheared) in cases {
            let m = matrix(*rows);
            let placement = Placement::from_matrix(&m.as_dmat4());
            assert_eq!(placement.inner.is_some(), *sheared, "{name}");
            assert!(placement.outer.rotation.is_normalized(), "{name}");
            let product = product(&placement);
            let largest = rows.iter().flatten().fold(0.0_f32, |m, x| m.max(x.abs()));
            for (a, b) in product.to_cols_array().into_iter().zip(m.to_cols_array()).take(12) {
                // Two rotations of f32 numbers: eight rounding steps of the largest entry.
                assert!((a - b).abs() <= 8.0 * f32::EPSILON * largest, "{name}: {product} is not {m}");
            }
            assert_eq!(product.w_axis, m.w_axis, "{name}");
        }
    }

    #[test]
    fn plain_matrices_are_kept_exactly() {
        for rows in [
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[-1.0, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 1e9]],
            [[1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, 1.0]],
        ] {
            let m = matrix(rows);
            assert_eq!(Placement::from_matrix(&m.as_dmat4()).outer.to_matrix(), m);
        }
    }
}

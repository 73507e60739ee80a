//! Normals under transforms.

use super::Real;
use super::vector::{cross, dot, length, normalize, normalize_or_zero, scale};

/// An interpolated normal at most this long has no direction; see [`interpolated_normal`](super::interpolated_normal).
pub const NORMAL_MIN: f32 = 1e-6;

// ANCHOR: normal_matrix
/// `sign(det M)·cof(M)` up to a positive factor, which the normalisation after it removes; both matrices as columns.
///
/// M is the upper 3×3 of a model or model-view matrix. Where M is invertible this is M⁻ᵀ up to a positive factor; where
/// M flattens space to a plane (rank 2, sign taken as +) it still maps every normal to the normal of that plane; where
/// M mirrors, the sign keeps normals on the outside. Each column is brought to unit length first, so that only the
/// ratio of two scales can underflow (in `f32` beyond 10³⁷), never their product. A matrix whose unit columns have a
/// determinant within 8 ε of 0 counts as singular: its sign would be that of a rounding error. Transform normals with
/// [`transform_normal`].
pub fn normal_matrix<T: Real>(m: [[T; 3]; 3]) -> [[T; 3]; 3] {
    let lengths = m.map(length);
    let unit = m.map(normalize_or_zero);
    let cofactors = [cross(unit[1], unit[2]), cross(unit[2], unit[0]), cross(unit[0], unit[1])];
    let det = dot(unit[0], cofactors[0]);
    let sign = if det < -T::epsilon() * T::from_f64(8.0) { -T::one() } else { T::one() };
    // cof(M)ⱼ = (product of the other two lengths)·(cofactor of the unit columns)ⱼ. Times min/(product of all three):
    let shortest = lengths[0].min(lengths[1]).min(lengths[2]);
    let factor = lengths.map(|s| if s <= shortest { sign } else { sign * (shortest / s) });
    [scale(cofactors[0], factor[0]), scale(cofactors[1], factor[1]), scale(cofactors[2], factor[2])]
}
// ANCHOR_END: normal_matrix

// ANCHOR: transform_normal
/// The unit normal `normalise(N·n)` for the normal matrix N, or `None` where N takes n to 0 (M of rank 0 or 1, or the
/// surface collapsed to a line).
pub fn transform_normal<T: Real>(normal_matrix: [[T; 3]; 3], n: [T; 3]) -> Option<[T; 3]> {
    let row = |i: usize| dot([normal_matrix[0][i], normal_matrix[1][i], normal_matrix[2][i]], n);
    normalize([row(0), row(1), row(2)])
}
// ANCHOR_END: transform_normal

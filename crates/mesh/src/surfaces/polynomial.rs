//! Polynomial patches.

use bevy_math::DVec3;

use super::{BezierPatch, SurfaceError};

impl BezierPatch {
    /// The patch p(u, v) = Σᵢ Σⱼ cᵢⱼ uⁱ vʲ, of coefficients that lie row by row, `columns` in each: i counts rows, j
    /// columns.
    ///
    /// Of a monomial xⁱ the control values of degree n are C(k, i) / C(n, i), k = 0 … n.
    ///
    /// # Errors
    /// As [`new`](Self::new), with coefficients for points.
    pub fn from_polynomial(columns: usize, coefficients: Vec<DVec3>) -> Result<Self, SurfaceError> {
        let mut patch = Self::new(columns, coefficients)?;
        for row in patch.points_mut().chunks_mut(columns) {
            let controls = controls_of(row);
            row.copy_from_slice(&controls);
        }
        for column in 0..columns {
            let down: Vec<DVec3> = patch.points().iter().skip(column).step_by(columns).copied().collect();
            for (row, control) in controls_of(&down).into_iter().enumerate() {
                patch.points_mut()[row * columns + column] = control;
            }
        }
        Self::new(columns, patch.points().to_vec())
    }
}

/// The control points of the curve Σ cᵢ xⁱ.
fn controls_of(coefficients: &[DVec3]) -> Vec<DVec3> {
    let degree = coefficients.len() - 1;
    let control = |k: usize| {
        // C(k, i) / C(n, i) from its predecessor; 0 from i = k + 1 on.
        let mut share = 1.0;
        coefficients
            .iter()
            .enumerate()
            .map(|(i, &c)| {
                let term = share * c;
                share *= k.saturating_sub(i) as f64 / (degree - i).max(1) as f64;
                term
            })
            .sum()
    };
    (0..=degree).map(control).collect()
}

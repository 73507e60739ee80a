//! Bicubic Bézier patches.

use bevy_math::DVec3;

/// A place on a patch's edge-to-edge scale, as the fraction `i` / `n`.
///
/// The fraction and its complement are rounded alike, so that an edge that two patches run along in opposite
/// directions has bit-equal points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameter {
    t: f64,
    s: f64,
}

impl Parameter {
    pub(super) fn new(i: u32, n: u32) -> Self {
        Self { t: f64::from(i) / f64::from(n), s: f64::from(n - i) / f64::from(n) }
    }

    pub(super) fn value(self) -> f64 {
        self.t
    }

    /// The cubic Bernstein polynomials.
    fn weights(self) -> [f64; 4] {
        let Self { t, s } = self;
        [s * s * s, 3.0 * (s * s) * t, 3.0 * (t * t) * s, t * t * t]
    }

    /// Their derivatives.
    fn slopes(self) -> [f64; 4] {
        let Self { t, s } = self;
        [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
    }

    /// Their second derivatives.
    fn curvatures(self) -> [f64; 4] {
        let Self { t, s } = self;
        [6.0 * s, 6.0 * (t - 2.0 * s), 6.0 * (s - 2.0 * t), 6.0 * t]
    }

    /// +1 where the patch lies on the side of growing parameters, −1 at its far end.
    fn inward(self) -> f64 {
        if self.t < self.s { 1.0 } else { -1.0 }
    }
}

/// A bicubic Bézier patch: four rows of four control points; u runs from row to row, v along a row.
pub(super) struct BicubicPatch {
    pub(super) rows: [[DVec3; 4]; 4],
}

/// Below this fraction of the largest product of tangents, their cross product counts as 0. The figures of a patch are
/// of order 1 and rounded to 2⁻⁵³ of that, a hundred of which are allowed for.
const VANISHED: f64 = 1e-14;

impl BicubicPatch {
    /// The sum of the control points, each weighted by its row's and its column's weight. Added in an order that does
    /// not change when rows or columns are reversed.
    fn blend(&self, rows: [f64; 4], columns: [f64; 4]) -> DVec3 {
        let sum = |w: [f64; 4], p: [DVec3; 4]| (w[0] * p[0] + w[3] * p[3]) + (w[1] * p[1] + w[2] * p[2]);
        sum(rows, self.rows.map(|row| sum(columns, row)))
    }

    /// p(u, v).
    pub(super) fn position(&self, u: Parameter, v: Parameter) -> DVec3 {
        self.blend(u.weights(), v.weights())
    }

    /// ∂p/∂v × ∂p/∂u, normalised; `None` where it has no direction even in the limit.
    ///
    /// Where the cross product vanishes, as at the end of a patch whose row has shrunk to a point, the direction is
    /// the limit from inside the patch: that of the cross product's derivative along the inward u, else the inward v.
    pub(super) fn normal(&self, u: Parameter, v: Parameter) -> Option<DVec3> {
        let pu = self.blend(u.slopes(), v.weights());
        let pv = self.blend(u.weights(), v.slopes());
        let puv = self.blend(u.slopes(), v.slopes());
        let puu = self.blend(u.curvatures(), v.weights());
        let pvv = self.blend(u.weights(), v.curvatures());
        let largest = [pu, pv, puv, puu, pvv].iter().fold(0.0_f64, |most, tangent| most.max(tangent.length_squared()));
        [pv.cross(pu), u.inward() * (puv.cross(pu) + pv.cross(puu)), v.inward() * (pvv.cross(pu) + pv.cross(puv))]
            .into_iter()
            .find(|n| n.length() > VANISHED * largest)
            .map(DVec3::normalize)
    }
}

//! Parameters of surfaces, and the points at them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

/// A parameter from 0 to 1 with its complement.
///
/// A fraction of whole numbers and its complement are rounded alike, so that an edge that two patches share in
/// opposite directions has bit-equal points.
///
/// ```
/// use halfway_mesh::Parameter;
///
/// let third = Parameter::fraction(1, 3);
/// assert_eq!(third.complement(), Parameter::fraction(2, 3).value());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    t: f64,
    s: f64,
}

impl Parameter {
    /// `i` / `n`, `i` at most `n`.
    pub fn fraction(i: u32, n: u32) -> Self {
        Self { t: f64::from(i) / f64::from(n), s: f64::from(n - i) / f64::from(n) }
    }

    /// The parameter as a number.
    pub fn value(self) -> f64 {
        self.t
    }

    /// 1 less the parameter.
    pub fn complement(self) -> f64 {
        self.s
    }

    /// ½ − t: from ½ down to −½, the ends exactly opposite.
    pub(super) fn before_middle(self) -> f64 {
        0.5 * (self.s - self.t)
    }

    /// +1 where the patch lies on the side of growing parameters, −1 at its far end.
    pub(super) fn inward(self) -> f64 {
        if self.t < self.s { 1.0 } else { -1.0 }
    }
}

impl From<f64> for Parameter {
    fn from(t: f64) -> Self {
        Self { t, s: 1.0 - t }
    }
}

/// A point of a [`ParametricSurface`](super::ParametricSurface).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// p.
    pub position: DVec3,
    /// ∂p/∂u; 0 where a column has shrunk to a point.
    pub du: DVec3,
    /// ∂p/∂v; 0 where a row has shrunk to a point.
    pub dv: DVec3,
    /// The outward unit normal: from the formula of the surface, and so also where a partial is 0.
    pub normal: DVec3,
    /// Texture coordinates: (1 − v, u).
    pub uv: DVec2,
}

/// The texture coordinates at (u, v).
pub(super) fn uv_at(u: Parameter, v: Parameter) -> DVec2 {
    DVec2::new(v.complement(), u.value())
}

/// Sine and cosine of a fraction of a turn.
///
/// Exact at the quarters, the last equal to the first: sin π is not 0 in floating point, and poles and seams must
/// close. The complement has the opposite sine and the same cosine, to the bit.
pub(super) fn turn(at: Parameter) -> (f64, f64) {
    let (t, s) = (at.value(), at.complement());
    let (sin, cos) = match 4.0 * t.min(s) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        quarters => (TAU / 4.0 * quarters).sin_cos(),
    };
    (if t > s { -sin } else { sin }, cos)
}

/// Sine and cosine of a fraction of half a turn; exact at its ends and in its middle.
pub(super) fn half_turn(at: Parameter) -> (f64, f64) {
    let (t, s) = (at.value(), at.complement());
    let (sin, cos) = turn((0.5 * t.min(s)).into());
    (sin, if t > s { -cos } else { cos })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact_and_mirrored() {
        for n in [3, 4, 7, 8, 12, 512] {
            assert_eq!(turn(Parameter::fraction(0, n)), (0.0, 1.0));
            assert_eq!(turn(Parameter::fraction(n, n)), (0.0, 1.0));
            for i in 0..=n {
                let at = Parameter::fraction(i, n);
                let (sin, cos) = turn(at);
                let angle = TAU * at.value();
                // sin and cos of the rounded angle are off by at most half a rounding step of the angle (< 2π).
                assert!((sin - angle.sin()).abs() < 1e-15 && (cos - angle.cos()).abs() < 1e-15);
                assert_eq!(turn(Parameter::fraction(n - i, n)), (-sin, cos));
                let (sin, cos) = half_turn(at);
                assert!((sin - (0.5 * angle).sin()).abs() < 1e-15 && (cos - (0.5 * angle).cos()).abs() < 1e-15);
            }
        }
    }
}

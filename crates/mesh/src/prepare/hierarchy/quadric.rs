//! Squared distances from planes, summed (Garland and Heckbert 1997, "Surface simplification using quadric error
//! metrics").

use std::ops::AddAssign;

use bevy_math::{DMat3, DVec3};

/// The weighted squares of the distances from some planes: pᵀ`a`p + 2`b`·p + `c`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorQuadric {
    a: DMat3,
    b: DVec3,
    c: f64,
    weight: f64,
}

impl ErrorQuadric {
    /// Of no planes.
    pub(super) const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0, weight: 0.0 };

    /// Of the plane through a point across a unit vector.
    pub(super) fn plane(n: DVec3, through: DVec3, weight: f64) -> Self {
        let d = -n.dot(through);
        let a = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        Self { a: a * weight, b: n * (d * weight), c: d * d * weight, weight }
    }

    /// The root of the mean square of the distances; 0 without planes.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        let sum = p.dot(self.a * p) + 2.0 * self.b.dot(p) + self.c;
        // Rounding may take it below 0.
        if self.weight > 0.0 { (sum.max(0.0) / self.weight).sqrt() } else { 0.0 }
    }
}

impl AddAssign for ErrorQuadric {
    fn add_assign(&mut self, other: Self) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
        self.weight += other.weight;
    }
}

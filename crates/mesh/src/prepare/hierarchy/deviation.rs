//! How far apart surfaces are, and their normals.

use bevy_math::DVec3;

/// A bound of how far apart two surfaces are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Deviation {
    /// No point of either is further from the other than this.
    pub(super) distance: f64,
    /// Every point of the coarse one has a point of the fine one within the distance whose normal is turned by no more
    /// than this, in radians.
    pub(super) angle: f64,
}

impl Deviation {
    pub(super) fn max(self, other: Self) -> Self {
        Self { distance: self.distance.max(other.distance), angle: self.angle.max(other.angle) }
    }

    /// Of a surface from a third one, where this is that of the first from the second, and `other` of the second from
    /// the third.
    pub(super) fn and(self, other: Self) -> Self {
        let angle = (self.angle + other.angle).min(std::f64::consts::PI);
        Self { distance: self.distance + other.distance, angle }
    }
}

/// The angle between two vectors, exact also where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

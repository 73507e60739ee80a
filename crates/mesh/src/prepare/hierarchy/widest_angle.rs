//! The largest of many angles, most of which are looked at only roughly.

use bevy_math::DVec3;

use super::deviation::angle;

/// The largest of angles.
#[derive(Default)]
pub(super) struct WidestAngle {
    pub(super) angle: f64,
    /// The square of a tangent: what is by far less than that of the angle is not the largest.
    by_far2: f64,
}

impl WidestAngle {
    /// Adds the angle between two vectors, π where the second is none.
    pub(super) fn add(&mut self, a: DVec3, b: DVec3) {
        let (across2, along) = (a.cross(b).length_squared(), a.dot(b));
        if along > 0.0 && across2 < self.by_far2 * along * along {
            return;
        }
        let angle = if b == DVec3::ZERO { std::f64::consts::PI } else { angle(a, b) };
        if angle > self.angle {
            // From a right angle on all are looked at.
            let tan = if angle < 1.5 { angle.tan() } else { 0.0 };
            (self.angle, self.by_far2) = (angle, 0.999_999 * tan * tan);
        }
    }
}

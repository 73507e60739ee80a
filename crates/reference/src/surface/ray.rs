//! Rays.

use bevy_math::DVec3;

/// The ray origin + t·direction; the direction is not 0 and may have any other length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
}

impl Ray {
    /// The same line from the place on it that is next to `p`, and the t of that place.
    ///
    /// What is computed from there keeps its digits however far away the ray begins: each coordinate of the new origin is
    /// rounded once, when it is already small.
    pub(super) fn beside(&self, p: DVec3) -> (Self, f64) {
        let Self { origin, direction } = *self;
        let t = (p - origin).dot(direction) / direction.length_squared();
        (Self { origin: direction.mul_add(DVec3::splat(t), origin), direction }, t)
    }

    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

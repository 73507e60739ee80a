//! Rays and their hits.

use bevy_math::DVec3;

/// The ray origin + t·direction; the direction is not 0 and may have any other length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
}

impl Ray {
    /// The same line from the point on it next to `p`, and the t of that point.
    ///
    /// Results from there keep their precision however far away the ray begins: each coordinate of the new origin is
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

/// A point where a ray hits a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceHit {
    /// The distance along the ray, in lengths of its direction; positive.
    pub(crate) t: f64,
    /// The point.
    pub(crate) position: DVec3,
    /// The outward unit normal there. At the tip of a cone, where there is none, it points away from the middle of the
    /// piece.
    pub(crate) normal: DVec3,
}

/// The longest edge of the box around the points.
pub(super) fn extent(points: impl Iterator<Item = DVec3> + Clone) -> f64 {
    let min = points.clone().fold(DVec3::INFINITY, DVec3::min);
    let max = points.fold(DVec3::NEG_INFINITY, DVec3::max);
    (max - min).max_element().max(0.0)
}

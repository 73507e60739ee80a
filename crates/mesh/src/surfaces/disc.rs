//! The flat disc.

use bevy_math::DVec3;

use super::{SurfaceError, check_coordinates};

/// A flat disc.
///
/// u runs from the middle to the rim, v around: where it faces along the Y axis from +X, toward +Z if it faces up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    center: DVec3,
    normal: DVec3,
    radius: f64,
}

impl Disc {
    /// The disc of this middle and radius that faces the way of `normal`, which may have any length but 0.
    ///
    /// # Errors
    /// A coordinate of the middle that is not from −1e30 to 1e30, a radius that is not from 1e-30 to 1e30, or a normal
    /// without a direction.
    pub fn new(center: DVec3, normal: DVec3, radius: f64) -> Result<Self, SurfaceError> {
        let error = |field, value, expected: &str| {
            Err(SurfaceError { surface: "Disc", field, value, expected: expected.to_owned() })
        };
        check_coordinates("Disc", "center", [center])?;
        if !(1e-30..=1e30).contains(&radius) {
            return error("radius", radius, "a length from 1e-30 to 1e30 is expected");
        }
        let Some(normal) = normal.try_normalize() else {
            return error("normal", normal.length(), "a direction is expected");
        };
        Ok(Self::at(center, normal, radius))
    }

    /// Takes what is known to be good; the normal has unit length.
    pub(super) fn at(center: DVec3, normal: DVec3, radius: f64) -> Self {
        Self { center, normal, radius }
    }

    /// Its middle.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Its outward unit normal.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Its radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

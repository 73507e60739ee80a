//! The torus.

use std::f64::consts::TAU;

use bevy_math::DVec2;

use super::parameter::{Profile, turn};
use super::{Parameter, ParametricSurface, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A ring about the Y axis: a tube around a circle in the plane y = 0.
///
/// u runs around the tube from its inside up, v around the ring from +X toward +Z. Of fourth degree, it has no pieces
/// that are quadrics or polynomial patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// The radius of the circle, 1e-30 … 1e30.
    pub radius: f32,
    /// The radius of the tube, less than that of the circle, 1e-30 … 1e30.
    pub tube: f32,
}

impl ParametricSurface for Torus {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, tube) = (f64::from(self.radius), f64::from(self.tube));
        let (sin, cos) = turn(u);
        let normal = DVec2::new(-cos, sin);
        let point = DVec2::new(radius, 0.0) + tube * normal;
        Profile { point, slope: TAU * tube * DVec2::new(sin, cos), normal }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Torus", &[("radius", self.radius), ("tube", self.tube)])?;
        if self.tube < self.radius {
            return Ok(());
        }
        Err(SurfaceError {
            surface: "Torus",
            field: "tube",
            value: f64::from(self.tube),
            expected: format!("less than the radius, {}, is expected", self.radius),
        })
    }

    fn least_counts(&self) -> [u32; 2] {
        [3, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        None
    }
}

//! The circular paraboloid.

use bevy_math::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::Profile;
use super::{Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A circular paraboloid about the Y axis, open below: its top is at y = `height` / 2, its rim at y = −`height` / 2.
///
/// u runs from the top in proportion to the distance from the axis, v around from +X toward +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// The radius of the rim, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
}

impl ParametricSurface for Paraboloid {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height, t) = (f64::from(self.radius), f64::from(self.height), u.value());
        let point = DVec2::new(radius * t, height * (0.5 - t * t));
        Profile::new(point, DVec2::new(radius, -2.0 * height * t)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Paraboloid", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        // (x² + z²)/r² + y/h − 1/2 = 0.
        let across = (radius * radius).recip();
        let mut matrix = DMat4::from_diagonal(DVec4::new(across, 0.0, across, -0.5));
        matrix.y_axis.w = 0.5 / height;
        matrix.w_axis.y = matrix.y_axis.w;
        let corner = DVec3::new(radius, 0.5 * height, radius);
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, -corner, corner))])
    }
}

//! The circular cone.

use bevy_math::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::Profile;
use super::{Disc, Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A circular cone about the Y axis: its tip is at y = `height` / 2, its base at y = −`height` / 2.
///
/// u runs from the tip down, v around from +X toward +Z. At the tip each v has the normal of the line that it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The radius of the base, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
    /// Whether a disc closes the base.
    pub capped: bool,
}

impl ParametricSurface for Cone {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        let point = DVec2::new(radius * u.value(), height * u.before_middle());
        Profile::new(point, DVec2::new(radius, -height)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Cone", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn caps(&self) -> Vec<Disc> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        let base = Disc::at(-half * DVec3::Y, DVec3::NEG_Y, radius);
        self.capped.then_some(base).into_iter().collect()
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        // x² + z² = (r/h)² (y − h/2)².
        let slope2 = (radius / height).powi(2);
        let mut matrix = DMat4::from_diagonal(DVec4::new(1.0, -slope2, 1.0, -0.25 * radius * radius));
        matrix.y_axis.w = 0.5 * slope2 * height;
        matrix.w_axis.y = matrix.y_axis.w;
        let corner = DVec3::new(radius, 0.5 * height, radius);
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, -corner, corner))])
    }
}

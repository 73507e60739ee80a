//! The circular cylinder.

use bevy_math::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::Profile;
use super::{Disc, Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A circular cylinder about the Y axis: x² + z² = `radius`², |y| ≤ `height` / 2.
///
/// u runs down, v around from +X toward +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The radius, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
    /// Whether discs close both ends.
    pub capped: bool,
}

impl ParametricSurface for Cylinder {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, height) = (f64::from(self.radius), f64::from(self.height));
        let point = DVec2::new(radius, height * u.before_middle());
        Profile { point, slope: DVec2::new(0.0, -height), normal: DVec2::X }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Cylinder", &[("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn caps(&self) -> Vec<Disc> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        let ends = if self.capped { &[DVec3::Y, DVec3::NEG_Y][..] } else { &[] };
        ends.iter().map(|&n| Disc::at(half * n, n, radius)).collect()
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.height));
        let matrix = DMat4::from_diagonal(DVec4::new(1.0, 0.0, 1.0, -radius * radius));
        let corner = DVec3::new(radius, half, radius);
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, -corner, corner))])
    }
}

//! The capsule.

use std::f64::consts::{FRAC_PI_2, PI};

use bevy_math::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::Profile;
use super::{Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A cylinder about the Y axis that ends in half spheres: the points at the distance `radius` from a line of `length`
/// along the axis, centred on the origin.
///
/// u runs from top to bottom in proportion to the way along the surface, v around from +X toward +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// The radius, 1e-30 … 1e30.
    pub radius: f32,
    /// The length of the line, 1e-30 … 1e30.
    pub length: f32,
}

impl ParametricSurface for Capsule {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, length) = (f64::from(self.radius), f64::from(self.length));
        let way = PI * radius + length;
        // From the nearer end, so that both ends are alike.
        let up = if u.before_middle() < 0.0 { -1.0 } else { 1.0 };
        let angle = u.value().min(u.complement()) * way / radius;
        let (point, normal) = if angle < FRAC_PI_2 {
            let (sin, cos) = angle.sin_cos();
            (DVec2::new(radius * sin, up * (0.5 * length + radius * cos)), DVec2::new(sin, up * cos))
        } else {
            (DVec2::new(radius, way * u.before_middle()), DVec2::X)
        };
        Profile { point, slope: -way * normal.perp(), normal }.revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Capsule", &[("radius", self.radius), ("length", self.length)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [3, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, half) = (f64::from(self.radius), 0.5 * f64::from(self.length));
        let piece = |matrix, low: f64, high: f64| {
            let (min, max) = (DVec3::new(-radius, low, -radius), DVec3::new(radius, high, radius));
            SurfacePiece::Quadric(Quadric::within(matrix, min, max))
        };
        // x² + (y − c)² + z² = r².
        let ball = |c: f64| {
            let mut matrix = DMat4::from_diagonal(DVec4::new(1.0, 1.0, 1.0, c * c - radius * radius));
            matrix.y_axis.w = -c;
            matrix.w_axis.y = -c;
            matrix
        };
        let side = DMat4::from_diagonal(DVec4::new(1.0, 0.0, 1.0, -radius * radius));
        Some(vec![
            piece(ball(half), half, half + radius),
            piece(side, -half, half),
            piece(ball(-half), -half - radius, -half),
        ])
    }
}

//! The building blocks of surfaces that are parametric surfaces themselves.

use std::f64::consts::TAU;

use glam::DVec3;

use super::parameter::{turn, uv_at};
use super::{BezierPatch, Disc, Parameter, ParametricSurface, SurfacePiece, SurfacePoint};

impl ParametricSurface for BezierPatch {
    /// The normal is +Y if there is none, not even in the limit.
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let [position, du, dv] = self.jet(u, v);
        SurfacePoint { position, du, dv, normal: self.normal(u, v).unwrap_or(DVec3::Y), uv: uv_at(u, v) }
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        Some(vec![SurfacePiece::Patch(self.clone())])
    }
}

impl ParametricSurface for Disc {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        // X for a disc that faces up or down.
        let (a, _) = self.normal().any_orthonormal_pair();
        let b = a.cross(self.normal());
        let (sin, cos) = turn(v);
        let rim = self.radius() * cos * a + self.radius() * sin * b;
        SurfacePoint {
            position: self.center() + u.value() * rim,
            du: rim,
            dv: TAU * u.value() * self.radius() * (cos * b - sin * a),
            normal: self.normal(),
            uv: uv_at(u, v),
        }
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        Some(vec![SurfacePiece::Disc(*self)])
    }
}

//! The ellipsoid.

use glam::{DMat4, DVec3, Vec3};

use super::parameter::{half_turn, turn, uv_at};
use super::{Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, UvSphere, check_lengths};

/// An ellipsoid about the origin: (x/a)² + (y/b)² + (z/c)² = 1.
///
/// u runs from the pole at +Y to that at −Y, v around from +X toward +Z: the point is (a sin θ cos φ, b cos θ,
/// c sin θ sin φ) with θ = πu and φ = 2πv.
///
/// ```
/// use glam::Vec3;
/// use halfway_mesh::{Ellipsoid, ParametricSurface, Tessellation};
///
/// let egg = Ellipsoid { radii: Vec3::new(1.0, 1.5, 1.0) }.mesh(Tessellation::ChordError(0.01))?;
/// assert_eq!(egg.report().closed, 1);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// a, b and c, each 1e-30 … 1e30.
    pub radii: Vec3,
}

impl ParametricSurface for Ellipsoid {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        use std::f64::consts::{PI, TAU};
        let radii = self.radii.as_dvec3();
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (half_turn(u), turn(v));
        let on_unit = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
        SurfacePoint {
            position: on_unit * radii,
            du: PI * DVec3::new(cos_theta * cos_phi, -sin_theta, cos_theta * sin_phi) * radii,
            dv: TAU * sin_theta * DVec3::new(-sin_phi, 0.0, cos_phi) * radii,
            // The gradient is 2 p / radii².
            normal: (on_unit / radii).normalize(),
            uv: uv_at(u, v),
        }
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        let Vec3 { x, y, z } = self.radii;
        check_lengths("Ellipsoid", &[("radii.x", x), ("radii.y", y), ("radii.z", z)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [2, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let radii = self.radii.as_dvec3();
        let matrix = DMat4::from_diagonal((radii * radii).recip().extend(-1.0));
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, -radii, radii))])
    }
}

/// As the [`Ellipsoid`] of three equal radii. The sphere's own counts are used by `Mesh::from` only.
impl ParametricSurface for UvSphere {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        Ellipsoid { radii: Vec3::splat(self.radius) }.at(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        Self::validate(self)
    }

    fn least_counts(&self) -> [u32; 2] {
        [2, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        Some(vec![SurfacePiece::Quadric(Quadric::sphere(f64::from(self.radius)))])
    }
}

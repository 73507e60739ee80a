//! The circular hyperboloids.

use bevy_math::{DMat4, DVec2, DVec3, DVec4};

use super::parameter::Profile;
use super::{Parameter, ParametricSurface, Quadric, SurfaceError, SurfacePiece, SurfacePoint, check_lengths};

/// A circular hyperboloid of one sheet about the Y axis, open at both ends: (x² + z²)/`waist`² − y²/c² = 1, |y| ≤
/// `height` / 2, c such that the rims have the `radius`.
///
/// u runs down, v around from +X toward +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperboloid {
    /// The radius at y = 0, 1e-30 … 1e30.
    pub waist: f32,
    /// The radius of the rims, greater than the waist, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis, 1e-30 … 1e30.
    pub height: f32,
}

impl Hyperboloid {
    /// c².
    fn c2(self) -> f64 {
        let (half, ratio) = (0.5 * f64::from(self.height), f64::from(self.radius) / f64::from(self.waist));
        half * half / (ratio * ratio - 1.0)
    }
}

impl ParametricSurface for Hyperboloid {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (waist, height, c2) = (f64::from(self.waist), f64::from(self.height), self.c2());
        let y = height * u.before_middle();
        let r = waist * (1.0 + y * y / c2).sqrt();
        let dr_by_dy = waist * waist * y / (c2 * r);
        Profile::new(DVec2::new(r, y), -height * DVec2::new(dr_by_dy, 1.0)).revolved(u, v)
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("Hyperboloid", &[("waist", self.waist), ("radius", self.radius), ("height", self.height)])?;
        if self.waist < self.radius {
            return Ok(());
        }
        Err(SurfaceError {
            surface: "Hyperboloid",
            field: "radius",
            value: f64::from(self.radius),
            expected: format!("more than the waist, {}, is expected", self.waist),
        })
    }

    fn least_counts(&self) -> [u32; 2] {
        [2, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (waist, radius, half) = (f64::from(self.waist), f64::from(self.radius), 0.5 * f64::from(self.height));
        let across = (waist * waist).recip();
        let matrix = DMat4::from_diagonal(DVec4::new(across, -self.c2().recip(), across, -1.0));
        let corner = DVec3::new(radius, half, radius);
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, -corner, corner))])
    }
}

/// One of the two sheets of a circular hyperboloid about the Y axis: y²/a² − (x² + z²)/b² = 1, a half the `gap`, b such
/// that the rim has the `radius`.
///
/// Its outward side is the one toward the other sheet. u runs from the tip to the rim in proportion to the distance
/// from the axis; v around from +X, toward +Z on the lower sheet and toward −Z on the upper one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HyperboloidSheet {
    /// The distance between the tips of both sheets, 1e-30 … 1e30.
    pub gap: f32,
    /// The radius of the rim, 1e-30 … 1e30.
    pub radius: f32,
    /// The length along the axis from the tip to the rim, 1e-30 … 1e30.
    pub height: f32,
    /// Whether it is the sheet with positive y, which opens upward.
    pub upper: bool,
}

impl HyperboloidSheet {
    /// a and (radius/b)².
    fn shape(self) -> (f64, f64) {
        let a = 0.5 * f64::from(self.gap);
        let height = f64::from(self.height) / a;
        (a, height * (2.0 + height))
    }
}

impl ParametricSurface for HyperboloidSheet {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (radius, t, (a, steepness)) = (f64::from(self.radius), u.value(), self.shape());
        let y = a * (1.0 + steepness * t * t).sqrt();
        let dy = a * a * steepness * t / y;
        let lower = Profile::new(DVec2::new(radius * t, -y), DVec2::new(radius, -dy)).revolved(u, v);
        if !self.upper {
            return lower;
        }
        // Half a turn about the X axis, so that inside stays inside.
        let turned = |p: DVec3| DVec3::new(p.x, -p.y, -p.z);
        SurfacePoint {
            position: turned(lower.position),
            du: turned(lower.du),
            dv: turned(lower.dv),
            normal: turned(lower.normal),
            uv: lower.uv,
        }
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        check_lengths("HyperboloidSheet", &[("gap", self.gap), ("radius", self.radius), ("height", self.height)])
    }

    fn least_counts(&self) -> [u32; 2] {
        [1, 3]
    }

    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let (radius, height, (a, steepness)) = (f64::from(self.radius), f64::from(self.height), self.shape());
        let across = steepness / (radius * radius);
        let matrix = DMat4::from_diagonal(DVec4::new(across, -(a * a).recip(), across, 1.0));
        let (low, high) = if self.upper { (a, a + height) } else { (-a - height, -a) };
        let (min, max) = (DVec3::new(-radius, low, -radius), DVec3::new(radius, high, radius));
        Some(vec![SurfacePiece::Quadric(Quadric::within(matrix, min, max))])
    }
}

//! Surfaces as functions of two parameters.

use std::f64::consts::TAU;

use bevy_math::{DVec2, DVec3};

use super::{Disc, Parameter, SurfaceError, SurfacePiece, Tessellation, tessellate};
use crate::Mesh;

/// A surface p(u, v), u and v from 0 to 1, in f64.
///
/// u runs from row to row of a mesh of it, v along a row; the outward side is that of ∂p/∂v × ∂p/∂u. Seen from outside
/// with v running left, u runs down: a texture that covers it whole has the coordinates (1 − v, u).
pub trait ParametricSurface {
    /// Everything about the point p(u, v).
    ///
    /// Means nothing where [`validate`](Self::validate) refuses the surface.
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint;

    /// Whether every field is in its range: all lengths from 1e-30 to 1e30, none more than 10⁵ times another, since
    /// `f32` could no longer tell their ends apart.
    ///
    /// # Errors
    /// The first field that is not.
    fn validate(&self) -> Result<(), SurfaceError> {
        Ok(())
    }

    /// The fewest rows and columns of cells that show its shape.
    fn least_counts(&self) -> [u32; 2] {
        [1, 1]
    }

    /// The discs that belong to it as well.
    fn caps(&self) -> Vec<Disc> {
        Vec::new()
    }

    /// The pieces of a [`Surface`](super::Surface) that are exactly p, without the caps; `None` where there are no such.
    fn pieces(&self) -> Option<Vec<SurfacePiece>>;

    /// Its mesh, with its caps: a grid of cells of two triangles each, which at a pole have one.
    ///
    /// Vertices lie row by row; seams and poles are repeated at equal positions for the sake of the texture coordinates.
    /// Triangles that are degenerate in `f32` are left out.
    ///
    /// # Errors
    /// A field of the surface or of the tessellation is out of its range.
    fn mesh(&self, tessellation: Tessellation) -> Result<Mesh, SurfaceError>
    where
        Self: Sized,
    {
        tessellate(&[self], tessellation)
    }
}

/// A point of a [`ParametricSurface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// p.
    pub position: DVec3,
    /// ∂p/∂u; 0 where a column has shrunk to a point.
    pub du: DVec3,
    /// ∂p/∂v; 0 where a row has shrunk to a point.
    pub dv: DVec3,
    /// The outward unit normal: from the formula of the surface, and so also where a partial is 0.
    pub normal: DVec3,
    /// Texture coordinates: (1 − v, u).
    pub uv: DVec2,
}

/// The texture coordinates at (u, v).
pub(super) fn uv_at(u: Parameter, v: Parameter) -> DVec2 {
    DVec2::new(v.complement(), u.value())
}

/// Sine and cosine of a fraction of a turn.
///
/// Exact at the quarters, the last equal to the first: sin π is not 0 in floating point, and poles and seams must close.
/// The complement has the opposite sine and the same cosine, to the bit.
pub(super) fn turn(at: Parameter) -> (f64, f64) {
    let (t, s) = (at.value(), at.complement());
    let (sin, cos) = match 4.0 * t.min(s) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        quarters => (TAU / 4.0 * quarters).sin_cos(),
    };
    (if t > s { -sin } else { sin }, cos)
}

/// Sine and cosine of a fraction of half a turn; exact at its ends and in its middle.
pub(super) fn half_turn(at: Parameter) -> (f64, f64) {
    let (t, s) = (at.value(), at.complement());
    let (sin, cos) = turn((0.5 * t.min(s)).into());
    (sin, if t > s { -cos } else { cos })
}

/// A point of the curve that a surface of revolution is made from: at the distance r from the Y axis, at the height y.
pub(super) struct Profile {
    /// (r, y).
    pub(super) point: DVec2,
    /// Its derivative by u.
    pub(super) slope: DVec2,
    /// Its outward unit normal: the slope (dr, dy) turned to (−dy, dr).
    pub(super) normal: DVec2,
}

impl Profile {
    /// The point after a part v of a turn about the Y axis, from +X toward +Z.
    pub(super) fn revolved(self, u: Parameter, v: Parameter) -> SurfacePoint {
        let (sin, cos) = turn(v);
        let about = |p: DVec2| DVec3::new(p.x * cos, p.y, p.x * sin);
        SurfacePoint {
            position: about(self.point),
            du: about(self.slope),
            dv: TAU * self.point.x * DVec3::new(-sin, 0.0, cos),
            normal: about(self.normal),
            uv: uv_at(u, v),
        }
    }

    /// The normal from the slope.
    pub(super) fn new(point: DVec2, slope: DVec2) -> Self {
        Self { point, slope, normal: slope.perp().normalize() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_of_a_turn_are_exact_and_turns_are_mirrored() {
        for n in [3, 4, 7, 8, 12, 512] {
            assert_eq!(turn(Parameter::fraction(0, n)), (0.0, 1.0));
            assert_eq!(turn(Parameter::fraction(n, n)), (0.0, 1.0));
            for i in 0..=n {
                let at = Parameter::fraction(i, n);
                let (sin, cos) = turn(at);
                let angle = TAU * at.value();
                // sin and cos of the rounded angle are off by at most half a rounding step of the angle (< 2π).
                assert!((sin - angle.sin()).abs() < 1e-15 && (cos - angle.cos()).abs() < 1e-15);
                assert_eq!(turn(Parameter::fraction(n - i, n)), (-sin, cos));
                let (sin, cos) = half_turn(at);
                assert!((sin - (0.5 * angle).sin()).abs() < 1e-15 && (cos - (0.5 * angle).cos()).abs() < 1e-15);
            }
        }
    }
}

//! The flat disc.

use glam::DVec3;

use super::{SurfaceError, check_coordinates};

/// A flat disc, on its own or as a cap of another surface.
///
/// u runs from the middle to the rim, v around: where it faces along the Y axis from +X, toward +Z if it faces up.
///
/// ```
/// use glam::DVec3;
/// use halfway_mesh::{Disc, ParametricSurface, Tessellation};
///
/// let disc = Disc::new(DVec3::ZERO, DVec3::Y, 2.0)?.mesh(Tessellation::Count { rows: 1, columns: 64 })?;
/// assert!((disc.report().area - 4.0 * std::f64::consts::PI).abs() < 0.03);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    center: DVec3,
    normal: DVec3,
    radius: f64,
}

impl Disc {
    /// The disc about `center` that faces along `normal`, which may have any length but 0.
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

    /// From values that are known to be valid; the normal has unit length.
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

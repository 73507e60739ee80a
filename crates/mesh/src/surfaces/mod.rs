//! Surfaces defined by formulas, with their analytic normals.

mod bezier;
mod cuboid;
mod disc;
mod ellipsoid;
mod height_field;
mod icosphere;
mod newell;
mod parameter;
mod pieces;
mod plane;
mod revolution;
mod sphere;
mod surface;
mod teapot;
mod tessellate;

use std::ops::RangeInclusive;

use glam::DVec3;
use thiserror::Error;

pub use bezier::BezierPatch;
pub use cuboid::Cuboid;
pub use disc::Disc;
pub use ellipsoid::Ellipsoid;
pub use height_field::HeightField;
pub use icosphere::Icosphere;
pub use parameter::{Parameter, SurfacePoint};
pub use plane::Plane;
pub use revolution::{Capsule, Cone, Cylinder, Hyperboloid, HyperboloidSheet, Paraboloid, Torus};
pub use sphere::UvSphere;
pub use surface::{Quadric, Surface, SurfacePiece};
pub use teapot::Teapot;
pub use tessellate::{ParametricSurface, Tessellation, tessellate};

/// Why a surface was refused.
///
/// ```
/// use halfway_mesh::Teapot;
///
/// let error = Teapot::new(0).validate().unwrap_err();
/// assert_eq!((error.surface, error.field, error.value), ("Teapot", "divisions", 0.0));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{surface}.{field}: {value}; {expected}")]
pub struct SurfaceError {
    /// The type, as `"UvSphere"`.
    pub surface: &'static str,
    /// The field, as `"radius"`.
    pub field: &'static str,
    /// Its value.
    pub value: f64,
    /// The expected values, as `"a number from 1 to 256 is expected"`.
    pub expected: String,
}

/// The lengths that surfaces may have: every product of them with a unit vector is a normal number, and no box around
/// them overflows.
const LENGTHS: RangeInclusive<f32> = 1e-30..=1e30;

/// The greatest coordinate of a point that defines a surface, so that it and everything between such points can be
/// represented in `f32`.
const FURTHEST: f64 = 1e30;

/// Checks the ranges of coordinates.
fn check_coordinates(
    surface: &'static str,
    field: &'static str,
    points: impl IntoIterator<Item = DVec3>,
) -> Result<(), SurfaceError> {
    let mut coordinates = points.into_iter().flat_map(|p| p.to_array());
    match coordinates.find(|x| !(-FURTHEST..=FURTHEST).contains(x)) {
        None => Ok(()),
        Some(value) => {
            let expected = "coordinates from -1e30 to 1e30 are expected".to_owned();
            Err(SurfaceError { surface, field, value, expected })
        }
    }
}

/// The greatest ratio of two lengths of a surface.
const MOST_TIMES: f32 = 1e5;

/// Checks that all lengths of a surface are in their range and none is too long for another.
fn check_lengths(surface: &'static str, lengths: &[(&'static str, f32)]) -> Result<(), SurfaceError> {
    lengths.iter().try_for_each(|&(name, value)| SurfaceField::length(surface, name, value).check())?;
    let shortest = lengths.iter().map(|length| length.1).fold(f32::MAX, f32::min);
    match lengths.iter().find(|length| length.1 > MOST_TIMES * shortest) {
        None => Ok(()),
        Some(&(field, value)) => Err(SurfaceError {
            surface,
            field,
            value: f64::from(value),
            expected: format!("at most {MOST_TIMES} times the shortest length, {shortest}, is expected"),
        }),
    }
}

/// A field of a surface, to be checked or clamped to its range.
struct SurfaceField {
    surface: &'static str,
    name: &'static str,
    value: f64,
    range: RangeInclusive<f64>,
    expected: String,
}

impl SurfaceField {
    fn length(surface: &'static str, name: &'static str, value: f32) -> Self {
        let range = f64::from(*LENGTHS.start())..=f64::from(*LENGTHS.end());
        let expected = "a length from 1e-30 to 1e30 is expected".to_owned();
        Self { surface, name, value: f64::from(value), range, expected }
    }

    fn count(surface: &'static str, name: &'static str, value: u32, range: RangeInclusive<u32>) -> Self {
        let expected = format!("a number from {} to {} is expected", range.start(), range.end());
        let range = f64::from(*range.start())..=f64::from(*range.end());
        Self { surface, name, value: f64::from(value), range, expected }
    }

    fn check(&self) -> Result<(), SurfaceError> {
        if self.range.contains(&self.value) {
            return Ok(());
        }
        let expected = self.expected.clone();
        Err(SurfaceError { surface: self.surface, field: self.name, value: self.value, expected })
    }

    /// The nearest value in range, 1 for NaN.
    fn nearest(&self) -> f64 {
        let Err(error) = self.check() else { return self.value };
        let nearest = if self.value.is_nan() { 1.0 } else { self.value.clamp(*self.range.start(), *self.range.end()) };
        // As `f32`, the type of lengths.
        log::warn!("{error}; made with {}", nearest as f32);
        nearest
    }
}

/// The triangles of a grid of `columns` × `rows` cells whose vertices lie row by row: for the cell with the vertices
/// a b in one row and c d in the next, (a, c, b) and (b, c, d).
fn grid_indices(columns: u32, rows: u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(6 * columns as usize * rows as usize);
    for row in 0..rows {
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
            indices.extend([a, c, b, b, c, d]);
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_clamped_to_their_range() {
        let length = |value: f32| SurfaceField::length("Test", "length", value).nearest() as f32;
        for (value, nearest) in [
            (2.0, 2.0),
            (0.0, 1e-30),
            (-1.0, 1e-30),
            (f32::INFINITY, 1e30),
            (f32::NEG_INFINITY, 1e-30),
            (f32::NAN, 1.0),
        ] {
            assert_eq!(length(value).to_bits(), f32::to_bits(nearest), "{value}");
        }
        let count = |value: u32| SurfaceField::count("Test", "count", value, 3..=7).nearest() as u32;
        assert_eq!([0, 3, 5, 7, 8, u32::MAX].map(count), [3, 3, 5, 7, 7, 7]);
    }
}

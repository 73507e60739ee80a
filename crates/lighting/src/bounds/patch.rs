//! A patch of surface, as the bounds know it.

use super::angle::{Angle, Cap};
use crate::Faces;
use crate::equations::Real;
use crate::equations::vector::{neg, normalize};

/// A cone that holds all shading normals of a patch.
///
/// Normals that are interpolated between those of vertices, and renormalised, stay in a cone with a half angle below
/// π/2. A wider one must hold the interpolated normals by other reasons, or be omitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalCone<T> {
    /// k, the middle of the normals, in the space of the evaluation. Need not have unit length; 0 stands for "any".
    pub axis: [T; 3],
    /// α in radians: no normal is farther from the axis. 0 for a plane; from π on any normal is possible.
    pub half_angle: T,
}

/// An object or a part of one: bounds of its points and its normals, and its visible sides.
///
/// The bounds hold wherever the equation is evaluated on it: at vertices (an interpolated colour is no brighter than
/// the brightest of its vertices), at fragments, and for flat shading if the cone holds the geometric normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<T> {
    /// c, the middle of a sphere around all points, in the space of the evaluation, where lengths are world units.
    pub center: [T; 3],
    /// r, 0 or more. One that is infinite or not a number bounds nothing: every light may be inside.
    pub radius: T,
    /// The cone of the normals as modelled, those of the front; `None` for any normal.
    pub normals: Option<NormalCone<T>>,
    /// The largest distance of a point from the plane through c across the cone's axis: 0 for a plane, r or more if it
    /// is not known. Lights near a large flat patch are inside its sphere, but still before or behind it, and at a
    /// distance.
    pub half_thickness: T,
    /// The visible sides with these coefficients: a back face is lit with the flipped normal. A patch with a
    /// [`BackMaterial`](crate::BackMaterial) is two patches, one a side.
    pub faces: Faces,
}

impl<T: Real> Patch<T> {
    /// The normals of the visible side; of the front one if both are visible.
    pub(super) fn seen_normals(&self) -> Cap<T> {
        let cap = self.normals.and_then(|cone| {
            normalize(cone.axis).map(|axis| Cap { axis, spread: Angle::from_radians(cone.half_angle) })
        });
        match (cap, self.faces) {
            (None, _) => Cap::everything(),
            (Some(cap), Faces::Front | Faces::Both) => cap,
            (Some(cap), Faces::Back) => Cap { axis: neg(cap.axis), ..cap },
        }
    }
}

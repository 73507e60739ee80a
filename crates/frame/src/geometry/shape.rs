//! Bounds of a piece of a mesh and of its normals, by which its lights are selected.

use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_math::Vec3;
use halfway_lighting::Faces;
use halfway_lighting::bounds::{self, NormalCone};
use halfway_lighting::equations::vector::length;
use halfway_mesh::Bounds;

/// Normals spread wider than this from their mean, in radians, bound nothing. Below π/2 those that are interpolated
/// stay inside the cone of the vertices'.
const WIDEST: f32 = 1.5;
/// The most that rounding in f32 may add to a cone's half angle, in radians.
pub(super) const ANGLE_SLACK: f32 = 2e-3;

/// Bounds of a piece of a mesh, in model space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatchShape {
    pub(super) center: Vec3,
    pub(super) radius: f32,
    /// Of the normals of its triangles; `None` where they are spread too wide.
    pub(super) faces: Option<PatchCone>,
    /// Of the normals of its vertices; `None` where they are spread too wide.
    pub(super) normals: Option<PatchCone>,
}

/// The mean of some normals, and the largest angle between it and one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PatchCone {
    pub(super) axis: Vec3,
    /// In radians.
    pub(super) half_angle: f32,
    /// The largest distance of a vertex from the plane through the patch's centre across the axis.
    pub(super) half_thickness: f32,
}

/// The normals that a patch is lit with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PatchNormals {
    /// The normals of its triangles.
    Faces,
    /// The normals of its vertices.
    Vertices,
}

impl PatchCone {
    fn new(normals: &[Vec3], offsets: &[Vec3]) -> Option<Self> {
        let axis = normals.iter().sum::<Vec3>().normalize_or_zero();
        let least = normals.iter().map(|n| n.dot(axis)).fold(1.0, smaller);
        let half_angle = least.clamp(-1.0, 1.0).acos() + ANGLE_SLACK;
        if axis == Vec3::ZERO || half_angle >= WIDEST {
            return None;
        }
        let farthest = offsets.iter().map(|offset| offset.dot(axis).abs()).fold(0.0, larger);
        Some(Self { axis, half_angle, half_thickness: farthest * (1.0 + 1e-5) })
    }
}

impl PatchShape {
    /// Of triangles whose corners have these offsets from a centre and these normals; `faces` are the normals of those
    /// triangles that have one.
    pub(super) fn new(center: Vec3, offsets: &[Vec3], normals: &[Vec3], faces: &[Vec3]) -> Self {
        Self {
            center,
            radius: radius_of(offsets.iter().copied()),
            faces: PatchCone::new(faces, offsets),
            normals: PatchCone::new(normals, offsets),
        }
    }

    /// Of triangles in a sphere, of whose normals nothing is known.
    pub(super) fn facing_anywhere(center: Vec3, radius: f32) -> Self {
        Self { center, radius, faces: None, normals: None }
    }

    /// Whether a corner with this normal, of a triangle with that, may be a part of it by all that is said of it.
    #[cfg(test)]
    pub(super) fn holds(&self, corner: Vec3, normal: Vec3, face: Option<Vec3>) -> bool {
        let offset = corner - self.center;
        let is_in = |cone: Option<PatchCone>, n: Vec3| {
            cone.is_none_or(|cone| {
                n.dot(cone.axis).clamp(-1.0, 1.0).acos() <= cone.half_angle
                    && offset.dot(cone.axis).abs() <= cone.half_thickness
            })
        };
        offset.length() <= self.radius && is_in(self.normals, normal) && face.is_none_or(|n| is_in(self.faces, n))
    }

    /// The radius of the sphere around it, in the mesh's units.
    pub(crate) fn radius(&self) -> f32 {
        self.radius
    }

    /// The sphere around it in eye space.
    pub(crate) fn sphere(&self, model_view: &ModelView) -> (Vec3, f32) {
        (model_view.eye_from_model.transform_point3(self.center), self.radius * model_view.largest_scale())
    }

    /// The same in eye space, with these normals. Their cone is kept only where the transform scales all directions
    /// alike.
    pub(crate) fn in_eye_space(
        &self,
        model_view: &ModelView,
        normal_matrix: &NormalMatrix,
        faces: Faces,
        normals: PatchNormals,
    ) -> bounds::Patch<f32> {
        let scale = model_view.largest_scale();
        let (center, radius) = self.sphere(model_view);
        let cone = match normals {
            PatchNormals::Faces => self.faces,
            PatchNormals::Vertices => self.normals,
        };
        let cone = cone.filter(|_| model_view.keeps_angles());
        bounds::Patch {
            center: center.to_array(),
            radius,
            normals: cone.map(|PatchCone { axis, half_angle, .. }| NormalCone {
                axis: (normal_matrix.0 * axis).to_array(),
                half_angle,
            }),
            half_thickness: cone.map_or(f32::INFINITY, |cone| cone.half_thickness * scale),
            faces,
        }
    }
}

/// The radius of a sphere that holds points with these offsets from its centre. Measured by the largest coordinate, so
/// that no square over- or underflows.
pub(super) fn radius_of(offsets: impl Iterator<Item = Vec3> + Clone) -> f32 {
    let largest = offsets.clone().map(Vec3::abs).fold(Vec3::ZERO, Vec3::max).max_element();
    if largest == 0.0 {
        return 0.0;
    }
    let farthest2 = offsets.map(|offset| (offset / largest).length_squared()).fold(0.0, larger);
    (largest * (farthest2.sqrt() * (1.0 + 1e-5))).min(f32::MAX)
}

/// The larger of two numbers. An instruction, unlike [`f32::max`], which also says what becomes of NaN.
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// The smaller of two numbers.
pub(super) fn smaller(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// A sphere that holds all of these.
pub(super) fn sphere_around(spheres: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let corners = spheres.clone().flat_map(|(center, radius)| [center - radius, center + radius]);
    let center = Bounds::from_points(corners).map_or(Vec3::ZERO, |bounds| bounds.center());
    let reach = spheres.map(|(at, radius)| length((at - center).to_array()) + radius).fold(0.0, f32::max);
    (center, reach * (1.0 + 1e-5))
}

//! Patches: large meshes in pieces that lie close together, so that each can have light lists of its own and be left out
//! when it is not seen.

use crate::view::camera::View;
use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_math::Vec3;
use halfway_lighting::Faces;
use halfway_lighting::bounds::{self, NormalCone};
use halfway_mesh::{Bounds, Mesh, face_normal};
use std::ops::Range;

/// A mesh of up to this many triangles is one patch: cutting it would cost more draws than it saves.
const WHOLE: usize = 4096;
/// How many triangles a patch has at most. 64 to 256 serve; fewer cut the light lists shorter and cost more draws.
const PATCH: usize = 32;
/// Normals spread wider than this from their mean, in radians, bound nothing. Below π/2 those that are interpolated stay
/// inside the cone of the vertices'.
const WIDEST: f32 = 1.5;
/// What rounding in f32 may add to a cone's half angle, in radians.
const ANGLE_SLACK: f32 = 2e-3;

/// A run of triangles of a mesh and what is known of them, in model space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshPatch {
    /// Its part of the index list.
    pub(crate) indices: Range<u32>,
    center: Vec3,
    radius: f32,
    /// Of the normals of vertices and faces; `None` where they are spread too wide.
    cone: Option<PatchCone>,
    /// How far any vertex is from the plane through the centre across the cone's axis.
    half_thickness: f32,
}

/// The mean of some normals, and how far the farthest is from it in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PatchCone {
    axis: Vec3,
    half_angle: f32,
}

/// Puts triangles of a mesh in an order in which neighbours in the list are neighbours in space, and cuts them into
/// patches, the first of which begins at `first` in the index list. Few triangles are one patch, in their order.
pub(crate) fn cut(mesh: &Mesh, triangles: &mut [[u32; 3]], first: u32) -> Vec<MeshPatch> {
    if triangles.len() <= WHOLE {
        return vec![MeshPatch::new(mesh, triangles, first)];
    }
    let bounds = mesh.bounds();
    let positions = mesh.positions();
    // Stable: what is at one place keeps its order.
    triangles.sort_by_cached_key(|corners| {
        let [a, b, c] = corners.map(|i| positions[i as usize] / 3.0);
        place_on_curve(a + b + c, &bounds)
    });
    (first..).step_by(3 * PATCH).zip(triangles.chunks(PATCH)).map(|(at, run)| MeshPatch::new(mesh, run, at)).collect()
}

/// The mean radius of patches, in the mesh's units.
pub(crate) fn mean_radius(patches: &[MeshPatch]) -> f32 {
    patches.iter().map(|patch| patch.radius).sum::<f32>() / patches.len().max(1) as f32
}

/// Where a point of the box is on the Z-order curve (Morton 1966) through 1024³ cells.
fn place_on_curve(p: Vec3, bounds: &Bounds) -> u32 {
    let extent = (bounds.max - bounds.min).max_element().max(f32::MIN_POSITIVE);
    let cell = (p - bounds.min) / extent * 1024.0;
    // Casts take what is no number, or beside the box by rounding, into the range.
    [cell.x, cell.y, cell.z].iter().enumerate().map(|(axis, cell)| spread((*cell as u32).min(1023)) << axis).sum()
}

/// The ten lowest bits with two zeros between each.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

impl MeshPatch {
    /// What is known of some triangles, which begin at `first` in the index list.
    pub(crate) fn new(mesh: &Mesh, triangles: &[[u32; 3]], first: u32) -> Self {
        let vertices = || triangles.as_flattened().iter().map(|&i| i as usize);
        let points = || vertices().map(|i| mesh.positions()[i]);
        let center = Bounds::from_points(points()).map_or(Vec3::ZERO, |bounds| bounds.center());
        let faces = triangles.iter().filter_map(|corners| {
            let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
            face_normal(a, b, c)
        });
        let normals: Vec<Vec3> = vertices().map(|i| mesh.normals()[i]).chain(faces).collect();
        let axis = normals.iter().sum::<Vec3>().normalize_or_zero();
        let least = normals.iter().map(|n| n.dot(axis)).fold(1.0, f32::min);
        let half_angle = least.clamp(-1.0, 1.0).acos() + ANGLE_SLACK;
        let cone = (axis != Vec3::ZERO && half_angle < WIDEST).then_some(PatchCone { axis, half_angle });
        let farthest = |of: &dyn Fn(Vec3) -> f32| points().map(|p| of(p - center)).fold(0.0, f32::max) * (1.0 + 1e-5);
        Self {
            indices: first..first + 3 * triangles.len() as u32,
            center,
            radius: farthest(&|offset| offset.length()),
            half_thickness: if cone.is_some() { farthest(&|offset| offset.dot(axis).abs()) } else { f32::INFINITY },
            cone,
        }
    }

    /// All of a mesh, of whose normals nothing is known.
    pub(crate) fn whole(mesh: &Mesh) -> Self {
        let center = mesh.bounds().center();
        let farthest = mesh.positions().iter().map(|p| p.distance(center)).fold(0.0, f32::max);
        Self {
            indices: 0..mesh.indices().len() as u32,
            center,
            radius: farthest * (1.0 + 1e-5),
            cone: None,
            half_thickness: f32::INFINITY,
        }
    }

    /// The radius of the sphere around it, in the mesh's units.
    pub(crate) fn radius(&self) -> f32 {
        self.radius
    }

    /// The sphere around it in eye space.
    pub(crate) fn sphere(&self, model_view: &ModelView) -> (Vec3, f32) {
        (model_view.eye_from_model.transform_point3(self.center), self.radius * model_view.largest_scale())
    }

    /// Whether any of it may show: it reaches into the frustum, and not all its triangles turn the side away that is
    /// drawn. Never false for one that shows.
    pub(crate) fn is_seen(
        &self,
        model_view: &ModelView,
        normal_matrix: &NormalMatrix,
        view: &View,
        faces: Faces,
    ) -> bool {
        let (center, radius) = self.sphere(model_view);
        if !view.projection.sees(center, radius) {
            return false;
        }
        let side = match faces {
            Faces::Both => return true,
            Faces::Front => 1.0,
            Faces::Back => -1.0,
        };
        let Some(cone) = self.cone.filter(|_| model_view.keeps_angles()) else { return true };
        // A triangle with normal n at p shows its back where n·p ≥ 0, with the eye at the origin. Over the sphere and the
        // cone n·p is at least D·cos(γ + α) − r, γ the angle between the axis and the way to the centre; that is
        // positive only for γ + α < π/2.
        let axis = (normal_matrix.0 * cone.axis).normalize_or_zero() * side;
        let along = axis.dot(center);
        let across = (center.length_squared() - along * along).max(0.0).sqrt();
        let (sin, cos) = cone.half_angle.sin_cos();
        along * cos - across * sin <= radius * (1.0 + 1e-5)
    }

    /// What bounds of lights know of it, in eye space. The cone of the normals is kept only where the transform turns and
    /// scales all alike.
    pub(crate) fn in_eye_space(
        &self,
        model_view: &ModelView,
        normal_matrix: &NormalMatrix,
        faces: Faces,
    ) -> bounds::Patch<f32> {
        let scale = model_view.largest_scale();
        let (center, radius) = self.sphere(model_view);
        let cone = self.cone.filter(|_| model_view.keeps_angles());
        bounds::Patch {
            center: center.to_array(),
            radius,
            normals: cone.map(|PatchCone { axis, half_angle }| NormalCone {
                axis: (normal_matrix.0 * axis).to_array(),
                half_angle,
            }),
            half_thickness: if cone.is_some() { self.half_thickness * scale } else { f32::INFINITY },
            faces,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::{Plane, UvSphere};

    fn cut_whole(mesh: &Mesh) -> (Vec<[u32; 3]>, Vec<MeshPatch>) {
        let mut triangles: Vec<_> = mesh.triangles().collect();
        let patches = cut(mesh, &mut triangles, 0);
        (triangles, patches)
    }

    #[test]
    fn small_meshes_are_whole_and_in_order() {
        let mesh = Mesh::from(UvSphere::new(1.0, 32, 16));
        let (triangles, patches) = cut_whole(&mesh);
        assert_eq!(triangles, mesh.triangles().collect::<Vec<_>>());
        assert_eq!(patches.len(), 1);
        assert_eq!(patches[0].indices, 0..mesh.indices().len() as u32);
    }

    #[test]
    fn patches_hold_every_triangle_once_and_all_that_is_said_of_them() {
        for mesh in [Mesh::from(UvSphere::new(2.0, 96, 48)), Mesh::from(Plane { size: 200.0, divisions: 64 })] {
            let (triangles, patches) = cut_whole(&mesh);
            let sorted = |mut triangles: Vec<[u32; 3]>| {
                triangles.sort_unstable();
                triangles
            };
            assert_eq!(sorted(triangles.clone()), sorted(mesh.triangles().collect()));
            let mut end = 0;
            for patch in &patches {
                assert_eq!(patch.indices.start, end);
                end = patch.indices.end;
                let cone = patch.cone.expect("normals that lie together");
                for &i in &triangles.as_flattened()[patch.indices.start as usize..end as usize] {
                    let (p, n) = (mesh.positions()[i as usize], mesh.normals()[i as usize]);
                    assert!(p.distance(patch.center) <= patch.radius);
                    assert!((p - patch.center).dot(cone.axis).abs() <= patch.half_thickness);
                    assert!(n.dot(cone.axis).clamp(-1.0, 1.0).acos() <= cone.half_angle);
                }
            }
            assert_eq!(end as usize, 3 * triangles.len());
        }
    }

    #[test]
    fn patches_are_small() {
        let (_, patches) = cut_whole(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        // 32 triangles are 16 cells of edge 1: a square of 4 × 4, with half a diagonal of 2.8. On the curve one cut
        // elsewhere has at most two of these.
        assert!(patches.iter().all(|patch| patch.radius < 6.0), "{patches:?}");
        assert!(patches.iter().all(|patch| patch.half_thickness == 0.0));
    }
}

//! Patches: large meshes in pieces that lie close together and face alike, so that each can have light lists of its own
//! and be left out when it is not seen.

use crate::geometry::outlines::{Facing, Outline, Sight};
use crate::geometry::shape::PatchShape;
use crate::lights::gains::Extent;
use crate::view::camera::View;
use bevy_math::Vec3;
use halfway_mesh::{Bounds, Mesh, face_normal};

/// A run of triangles of a mesh and what is known of them, in model space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshPatch {
    pub(crate) shape: PatchShape,
    /// The sum of the areas of its triangles, and how many vertices they have.
    area: f32,
    vertices: u32,
}

impl MeshPatch {
    /// What is known of some triangles.
    pub(crate) fn new(mesh: &Mesh, triangles: &[[u32; 3]]) -> (Self, Outline) {
        let vertices = || triangles.as_flattened().iter().map(|&i| i as usize);
        let points = || vertices().map(|i| mesh.positions()[i]);
        let center = Bounds::from_points(points()).map_or(Vec3::ZERO, |bounds| bounds.center());
        let faces = triangles.iter().filter_map(|corners| {
            let corners = corners.map(|i| mesh.positions()[i as usize]);
            let n = face_normal(corners[0], corners[1], corners[2])?;
            Some((n, corners.map(|p| p - center)))
        });
        let faces: Vec<(Vec3, [Vec3; 3])> = faces.collect();
        let facing = Facing::new(faces.iter().copied());
        let faces: Vec<Vec3> = faces.into_iter().map(|(n, _)| n).collect();
        let area = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        });
        let area = area.sum();
        let shape = PatchShape::new(mesh, triangles, center, &faces);
        let outline = Outline::new(&shape, facing);
        (Self { shape, area, vertices: count_of(vertices()) }, outline)
    }

    /// About how many pixels its triangles cover, where nothing hides them; and its vertices.
    pub(crate) fn extent(&self, sight: &Sight) -> Extent {
        let View { projection, pixels_at_unit_depth, .. } = sight.view;
        let (center, _) = self.shape.sphere(sight.model_view);
        let depth = (-center.z).max(projection.near);
        let pixels = sight.model_view.largest_scale() * pixels_at_unit_depth / depth;
        let facing = sight
            .eye
            .zip(self.shape.faces)
            .map_or(0.5, |((eye, _), cone)| (eye - self.shape.center).normalize_or_zero().dot(cone.axis).abs());
        Extent { pixels: self.area * facing * pixels * pixels, vertices: self.vertices as f32 }
    }
}

fn count_of(vertices: impl Iterator<Item = usize>) -> u32 {
    let mut numbers: Vec<usize> = vertices.collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.len() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::detail::MeshTriangles;
    use halfway_mesh::{Plane, UvSphere};

    #[test]
    fn small_meshes_are_whole_and_in_order() {
        let mesh = Mesh::from(UvSphere::new(1.0, 32, 16));
        let MeshTriangles { corners, detail, .. } = MeshTriangles::in_patches(&mesh);
        assert_eq!(*corners, mesh.triangles().collect::<Vec<_>>());
        assert_eq!(detail.patches().len(), 1);
        assert_eq!(detail.indices(0), 0..mesh.indices().len() as u32);
    }

    #[test]
    fn patches_hold_every_triangle_once_and_all_that_is_said_of_them() {
        for mesh in [Mesh::from(UvSphere::new(2.0, 96, 48)), Mesh::from(Plane { size: 200.0, divisions: 64 })] {
            let MeshTriangles { corners: triangles, detail, .. } = MeshTriangles::in_patches(&mesh);
            let sorted = |mut triangles: Vec<[u32; 3]>| {
                triangles.sort_unstable();
                triangles
            };
            assert_eq!(sorted(triangles.to_vec()), sorted(mesh.triangles().collect()));
            let mut end = 0;
            for (number, patch) in (0..).zip(detail.patches()) {
                assert_eq!(detail.indices(number).start, end);
                end = detail.indices(number).end;
                let run = detail.indices(number).start as usize / 3..end as usize / 3;
                assert!(patch.shape.faces.is_some() && patch.shape.normals.is_some(), "they lie together");
                for corners in &triangles[run] {
                    let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
                    let face = face_normal(a, b, c);
                    for i in corners.map(|i| i as usize) {
                        assert!(patch.shape.holds(mesh.positions()[i], mesh.normals()[i], face));
                    }
                }
            }
            assert_eq!(end as usize, 3 * triangles.len());
        }
    }

    #[test]
    fn patches_are_small() {
        let MeshTriangles { detail, .. } = MeshTriangles::in_patches(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        let patches = detail.patches();
        // 64 triangles are 32 cells of edge 1: at most 4 × 8 of them, with half a diagonal of 4.5, or 11 × 3.
        assert!(patches.iter().all(|patch| patch.shape.radius < 6.0), "{patches:?}");
        assert!(patches.iter().all(|patch| patch.shape.normals.is_some_and(|cone| cone.half_thickness == 0.0)));
    }
}

//! Patches: runs of neighbouring triangles of a mesh, each of which is culled by itself and has its own light lists.

use crate::geometry::outlines::{Facing, Outline, Sight};
use crate::geometry::shape::PatchShape;
use bevy_math::Vec3;
use halfway_mesh::{Bounds, Mesh, face_normal};
use std::ops::Range;
use std::sync::Arc;

/// A mesh's triangles in the order in which they are drawn: patch by patch. A clone shares them.
#[derive(Clone, Debug)]
pub(crate) struct MeshTriangles {
    pub(crate) corners: Arc<Vec<[u32; 3]>>,
    pub(crate) patches: Arc<Patches>,
}

/// The patches of a mesh.
#[derive(Debug)]
pub(crate) struct Patches {
    shapes: Vec<PatchShape>,
    outlines: Vec<Outline>,
    /// Where the indices of each patch begin, and where those of the last end.
    starts: Vec<u32>,
    /// The outlines of each [`GROUP`] neighbouring patches together.
    groups: Vec<Outline>,
    /// The outline of the whole mesh.
    pub(crate) whole: Outline,
}

/// So many neighbouring patches are culled together before each is looked at.
const GROUP: usize = 8;

impl MeshTriangles {
    /// The mesh as a single patch, in the order of its triangles.
    pub(crate) fn in_order(mesh: &Mesh) -> Self {
        let corners: Vec<_> = mesh.triangles().collect();
        let patches = Patches::new(mesh, &corners, std::iter::once(0..corners.len()));
        Self { corners: Arc::new(corners), patches: Arc::new(patches) }
    }

    /// The mesh cut into patches.
    pub(crate) fn in_patches(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let runs = mesh.cut_into_patches(&mut corners, mesh.triangles_of_a_patch());
        let patches = Patches::new(mesh, &corners, runs.into_iter());
        Self { corners: Arc::new(corners), patches: Arc::new(patches) }
    }
}

impl Patches {
    /// Patches of these runs of triangles, which follow each other.
    fn new(mesh: &Mesh, triangles: &[[u32; 3]], runs: impl Iterator<Item = Range<usize>>) -> Self {
        let mut starts = vec![0];
        let (shapes, outlines): (Vec<_>, Vec<_>) = runs
            .map(|run| {
                starts.push(3 * run.end as u32);
                measure(mesh, &triangles[run])
            })
            .unzip();
        let groups = outlines.chunks(GROUP).map(Outline::around).collect();
        Self { shapes, outlines, starts, groups, whole: Outline::whole(mesh) }
    }

    /// The number of patches.
    pub(crate) fn len(&self) -> usize {
        self.shapes.len()
    }

    /// The shape of a patch.
    pub(crate) fn shape(&self, patch: u32) -> &PatchShape {
        &self.shapes[patch as usize]
    }

    /// The range of a patch's indices among those of the mesh as it is drawn.
    pub(crate) fn indices(&self, patch: u32) -> Range<u32> {
        self.starts[patch as usize]..self.starts[patch as usize + 1]
    }

    /// Fills `seen` with the numbers of the patches that may show, in ascending order. A mesh that is a single patch is
    /// taken to be seen: it has been culled as an object.
    pub(crate) fn see(&self, sight: &Sight, seen: &mut Vec<u32>) {
        seen.clear();
        if self.len() == 1 {
            seen.push(0);
            return;
        }
        for (first, group) in (0..).step_by(GROUP).zip(&self.groups) {
            if group.is_seen(sight) {
                let outlines = (first..).zip(&self.outlines[first as usize..]).take(GROUP);
                seen.extend(outlines.filter(|(_, outline)| outline.is_seen(sight)).map(|(patch, _)| patch));
            }
        }
    }
}

/// The shape and the outline of some triangles.
fn measure(mesh: &Mesh, triangles: &[[u32; 3]]) -> (PatchShape, Outline) {
    let points = triangles.as_flattened().iter().map(|&i| mesh.positions()[i as usize]);
    let center = Bounds::from_points(points).map_or(Vec3::ZERO, |bounds| bounds.center());
    let faces = triangles.iter().filter_map(|corners| {
        let corners = corners.map(|i| mesh.positions()[i as usize]);
        let n = face_normal(corners[0], corners[1], corners[2])?;
        Some((n, corners.map(|p| p - center)))
    });
    let faces: Vec<(Vec3, [Vec3; 3])> = faces.collect();
    let facing = Facing::new(faces.iter().copied());
    let faces: Vec<Vec3> = faces.into_iter().map(|(n, _)| n).collect();
    let shape = PatchShape::new(mesh, triangles, center, &faces);
    let outline = Outline::new(&shape, facing);
    (shape, outline)
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::{Plane, UvSphere};

    #[test]
    fn small_meshes_are_whole_and_in_order() {
        let mesh = Mesh::from(UvSphere::new(1.0, 32, 16));
        let MeshTriangles { corners, patches } = MeshTriangles::in_patches(&mesh);
        assert_eq!(*corners, mesh.triangles().collect::<Vec<_>>());
        assert_eq!(patches.len(), 1);
        assert_eq!(patches.indices(0), 0..mesh.indices().len() as u32);
    }

    #[test]
    fn patches_hold_every_triangle_once_and_all_that_is_said_of_them() {
        for mesh in [Mesh::from(UvSphere::new(2.0, 96, 48)), Mesh::from(Plane { size: 200.0, divisions: 64 })] {
            let MeshTriangles { corners: triangles, patches } = MeshTriangles::in_patches(&mesh);
            let sorted = |mut triangles: Vec<[u32; 3]>| {
                triangles.sort_unstable();
                triangles
            };
            assert_eq!(sorted(triangles.to_vec()), sorted(mesh.triangles().collect()));
            let mut end = 0;
            for patch in 0..patches.len() as u32 {
                assert_eq!(patches.indices(patch).start, end);
                end = patches.indices(patch).end;
                let run = patches.indices(patch).start as usize / 3..end as usize / 3;
                let shape = patches.shape(patch);
                assert!(shape.faces.is_some() && shape.normals.is_some(), "they lie together");
                for corners in &triangles[run] {
                    let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
                    let face = face_normal(a, b, c);
                    for i in corners.map(|i| i as usize) {
                        assert!(shape.holds(mesh.positions()[i], mesh.normals()[i], face));
                    }
                }
            }
            assert_eq!(end as usize, 3 * triangles.len());
        }
    }

    #[test]
    fn patches_are_small() {
        let MeshTriangles { patches, .. } = MeshTriangles::in_patches(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        // 64 triangles are 32 cells of edge 1: at most 4 × 8 of them, with half a diagonal of 4.5, or 11 × 3.
        let shapes = || (0..patches.len() as u32).map(|patch| patches.shape(patch));
        assert!(shapes().all(|shape| shape.radius < 6.0), "{patches:?}");
        assert!(shapes().all(|shape| shape.normals.is_some_and(|cone| cone.half_thickness == 0.0)));
    }
}

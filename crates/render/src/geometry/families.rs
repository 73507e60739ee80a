//! Families: patches that follow each other and lie together, of which any number may be looked at as one.

use crate::geometry::patches::MeshPatch;
use crate::geometry::shape::PatchShape;
use std::ops::Range;

/// The families of a mesh's patches. Each patch is in one.
#[derive(Debug)]
pub(crate) struct Families {
    /// Of each patch the number of its family.
    of: Vec<u32>,
    families: Vec<Family>,
}

/// What is known of some patches together, and of each half of them, and so on; `None` of what is one patch.
#[derive(Debug)]
struct Family {
    patches: Range<u32>,
    /// Of all; then of the halves of each, the first half of i at 2i + 1.
    shapes: Box<[Option<PatchShape>]>,
}

/// A family has no more patches than this, a power of two.
pub(crate) const MOST: usize = 16;

/// A part of a family: all, a half, a half of that, and so on.
#[derive(Clone, Debug)]
pub(crate) struct FamilyPart {
    family: u32,
    node: usize,
    /// The numbers of its patches.
    pub(crate) patches: Range<u32>,
}

impl Families {
    /// Of these patches.
    pub(crate) fn new(patches: &[MeshPatch]) -> Self {
        let mut all = Self { of: Vec::with_capacity(patches.len()), families: Vec::new() };
        let mut start = 0;
        while start < patches.len() {
            let mut end = start + 1;
            while end < patches.len().min(start + MOST) && are_compact(&patches[start..=end]) {
                end += 1;
            }
            all.of.resize(end, all.families.len() as u32);
            let mut shapes = Vec::new();
            note(&patches[start..end], 0, &mut shapes);
            all.families.push(Family { patches: start as u32..end as u32, shapes: shapes.into() });
            start = end;
        }
        all
    }

    /// The family of a patch.
    pub(crate) fn of(&self, patch: u32) -> FamilyPart {
        let family = self.of[patch as usize];
        FamilyPart { family, node: 0, patches: self.families[family as usize].patches.clone() }
    }

    /// What is known of a part; `None` of a patch by itself.
    pub(crate) fn shape(&self, part: &FamilyPart) -> Option<&PatchShape> {
        self.families[part.family as usize].shapes.get(part.node)?.as_ref()
    }
}

impl FamilyPart {
    /// Both halves of what is more than one patch.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let Range { start, end } = self.patches;
        let middle = start + (end - start) / 2;
        let half = |node, patches| Self { family: self.family, node, patches };
        [half(2 * self.node + 1, start..middle), half(2 * self.node + 2, middle..end)]
    }
}

fn around(patches: &[MeshPatch]) -> PatchShape {
    PatchShape::around(patches.iter().map(|patch| &patch.shape))
}

fn are_compact(patches: &[MeshPatch]) -> bool {
    around(patches).is_compact(patches.iter().map(|patch| &patch.shape))
}

/// Notes what is known of patches at a place, and of their halves.
fn note(patches: &[MeshPatch], place: usize, shapes: &mut Vec<Option<PatchShape>>) {
    if patches.len() > 1 {
        shapes.resize(shapes.len().max(place + 1), None);
        shapes[place] = Some(around(patches));
        let (first, second) = patches.split_at(patches.len() / 2);
        note(first, 2 * place + 1, shapes);
        note(second, 2 * place + 2, shapes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::detail::MeshTriangles;
    use bevy_math::{Quat, Vec3};
    use halfway_mesh::{Mesh, Plane, Teapot, UvSphere, face_normal};

    /// All that is known of more than one patch, with the triangles that it is known of.
    fn joined(mesh: &Mesh) -> Vec<(PatchShape, Vec<[u32; 3]>)> {
        let MeshTriangles { corners, detail, .. } = MeshTriangles::in_patches(mesh);
        let mut found = Vec::new();
        let mut end = 0;
        while end < detail.patches().len() as u32 {
            let family = detail.families.of(end);
            assert_eq!(family.patches.start, end, "each patch is in one family, and they follow each other");
            end = family.patches.end;
            assert!(family.patches.len() <= MOST);
            let mut parts = vec![family];
            while let Some(part) = parts.pop() {
                let Some(shape) = detail.families.shape(&part) else {
                    assert_eq!(part.patches.len(), 1);
                    continue;
                };
                let indices = detail.indices(part.patches.start).start..detail.indices(part.patches.end - 1).end;
                found.push((*shape, corners[indices.start as usize / 3..indices.end as usize / 3].to_vec()));
                let halves = part.halves();
                assert_eq!(halves[0].patches.end, halves[1].patches.start);
                assert_eq!(halves.iter().map(|half| half.patches.len()).sum::<usize>(), part.patches.len());
                parts.extend(halves);
            }
        }
        found
    }

    /// How many corners, normals and triangles are not as is said of what they are part of.
    fn wrong(mesh: &Mesh, shape: &PatchShape, triangles: &[[u32; 3]]) -> usize {
        let of_triangle = |corners: &[u32; 3]| {
            let at = corners.map(|i| mesh.positions()[i as usize]);
            let corners = corners.map(|i| (mesh.positions()[i as usize], mesh.normals()[i as usize]));
            let face = face_normal(at[0], at[1], at[2]);
            corners.into_iter().filter(|&(p, n)| !shape.holds(p, n, face)).count()
        };
        triangles.iter().map(of_triangle).sum()
    }

    #[test]
    fn what_is_said_of_many_patches_is_so_of_all_that_they_are() {
        let meshes = [
            Mesh::from(UvSphere::new(2.0, 192, 96)),
            Mesh::from(Plane { size: 200.0, divisions: 96 }),
            Mesh::from(Teapot { divisions: 24 }),
        ];
        for mesh in meshes {
            let joined = joined(&mesh);
            assert!(joined.len() > 20, "{}", joined.len());
            assert!(joined.iter().all(|(shape, triangles)| wrong(&mesh, shape, triangles) == 0));
            // A planted fault: what is said of a part of them, in place of all.
            let of_fewer = || joined.windows(2).filter(|pair| pair[1].1.len() < pair[0].1.len());
            let found = of_fewer().filter(|pair| wrong(&mesh, &pair[1].0, &pair[0].1) > 0).count();
            assert!(found > 20 && 10 * found > 9 * of_fewer().count(), "{found} of {}", of_fewer().count());
        }
    }

    #[test]
    fn what_lies_apart_or_faces_elsewhere_is_no_family() {
        let flat = Mesh::from(Plane { size: 1.0, divisions: 1 });
        let patch = |at: Vec3, turn: Quat| {
            let positions = flat.positions().iter().map(|&p| turn * p + at).collect();
            let normals = flat.normals().iter().map(|&n| turn * n).collect();
            let mesh = Mesh::from_parts(positions, Some(normals), None, flat.indices().to_vec());
            MeshPatch::new(&mesh.expect("it is as before"), &[[0, 1, 2]]).0
        };
        let here = || patch(Vec3::ZERO, Quat::IDENTITY);
        assert!(are_compact(&[here(), patch(0.3 * Vec3::X, Quat::from_rotation_x(0.1))]));
        assert!(!are_compact(&[here(), patch(3.0 * Vec3::X, Quat::IDENTITY)]), "apart");
        let elsewhere = [here(), patch(Vec3::ZERO, Quat::from_rotation_x(0.8))];
        assert!(!are_compact(&elsewhere));
    }
}

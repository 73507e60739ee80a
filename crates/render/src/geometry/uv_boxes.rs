//! Where patches lie on images: the least and the largest of their texture coordinates.

use crate::geometry::patches::MeshPatch;
use bevy_math::{Vec2, Vec4};
use halfway_mesh::Mesh;

/// The least and the largest coordinates of some vertices, of both sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvBox {
    pub(crate) low: Vec4,
    pub(crate) high: Vec4,
}

/// Those of a mesh's patches, by where they begin in the index list.
#[derive(Debug, Default)]
pub(crate) struct UvBoxes(Vec<(u32, UvBox)>);

impl UvBoxes {
    /// Of a mesh with these triangles in these patches.
    pub(crate) fn new(mesh: &Mesh, triangles: &[[u32; 3]], patches: &[MeshPatch]) -> Self {
        let uvs = both_uvs(mesh);
        let of = |patch: &MeshPatch| {
            let indices = &triangles.as_flattened()[patch.indices.start as usize..patch.indices.end as usize];
            let points = indices.iter().map(|&vertex| uvs[vertex as usize]);
            let nowhere = UvBox { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };
            let around = |of: UvBox, uv: Vec4| UvBox { low: of.low.min(uv), high: of.high.max(uv) };
            (patch.indices.start, points.fold(nowhere, around))
        };
        Self(patches.iter().map(of).collect())
    }

    /// That of a patch; `None` where it is not known.
    pub(crate) fn of(&self, patch: &MeshPatch) -> Option<UvBox> {
        let at = self.0.binary_search_by_key(&patch.indices.start, |(start, _)| *start).ok()?;
        let is_whole = self.0.get(at + 1).is_none_or(|(next, _)| *next >= patch.indices.end);
        is_whole.then_some(self.0[at].1)
    }
}

/// The coordinates of both sets, zeros where there are none.
pub(crate) fn both_uvs(mesh: &Mesh) -> Vec<Vec4> {
    let of = |set: usize, vertex: usize| mesh.uv_set(set).map_or(Vec2::ZERO, |uvs| uvs[vertex]);
    let both = |vertex| {
        let ([u, v], [s, t]) = (of(0, vertex).to_array(), of(1, vertex).to_array());
        Vec4::new(u, v, s, t)
    };
    (0..mesh.positions().len()).map(both).collect()
}

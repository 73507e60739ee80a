//! Where patches lie on images: the least and the largest of their texture coordinates.

use crate::geometry::detail::Detail;
use bevy_math::{Vec2, Vec4};
use halfway_mesh::Mesh;

/// The least and the largest coordinates of some vertices, of both sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvBox {
    pub(crate) low: Vec4,
    pub(crate) high: Vec4,
}

/// Those of a mesh's patches, by their numbers.
#[derive(Debug, Default)]
pub(crate) struct UvBoxes(Vec<UvBox>);

impl UvBoxes {
    /// Of a mesh with these triangles in patches.
    pub(crate) fn new(mesh: &Mesh, triangles: &[[u32; 3]], detail: &Detail) -> Self {
        let uvs = both_uvs(mesh);
        let of = |number: u32| {
            let indices = detail.indices(number);
            let vertices = &triangles.as_flattened()[indices.start as usize..indices.end as usize];
            let points = vertices.iter().map(|&vertex| uvs[vertex as usize]);
            let nowhere = UvBox { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };
            let around = |of: UvBox, uv: Vec4| UvBox { low: of.low.min(uv), high: of.high.max(uv) };
            points.fold(nowhere, around)
        };
        Self((0..detail.patches().len() as u32).map(of).collect())
    }

    /// That of a patch; `None` where it is not known.
    pub(crate) fn of(&self, patch: u32) -> Option<UvBox> {
        self.0.get(patch as usize).copied()
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

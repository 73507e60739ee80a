//! The edges of a mesh, with the angles between its triangles.

use glam::Vec3;

use crate::mesh::Mesh;
use crate::normals::face_normal;

/// An edge of a mesh, with the triangles along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshEdge {
    /// The vertices at its ends; of several in one place, that of its first triangle.
    pub ends: [u32; 2],
    /// Two of its triangles, the first one first. A border has only one, which stands in both places.
    pub triangles: [u32; 2],
    /// The angle between the normals of its two triangles, in radians from 0 (they are in one plane) to π. It is π at
    /// borders, where more than two triangles meet, where two wind in opposite ways, and beside triangles without area.
    pub angle: f32,
}

impl MeshEdge {
    /// Whether only one triangle has it.
    pub fn is_border(&self) -> bool {
        self.triangles[0] == self.triangles[1]
    }
}

impl Mesh {
    /// The edges of the mesh. Vertices in one place count as one, so that a seam in normals or texture coordinates is no
    /// border.
    ///
    /// ```
    /// use halfway_mesh::{Cuboid, Mesh};
    /// use std::f32::consts::FRAC_PI_2;
    ///
    /// let edges = Mesh::from(Cuboid::default()).edges();
    /// // Twelve at right angles, and the diagonals of six faces.
    /// let sharp = edges.iter().filter(|edge| (edge.angle - FRAC_PI_2).abs() < 1e-6).count();
    /// assert_eq!((sharp, edges.len()), (12, 18));
    /// assert!(edges.iter().all(|edge| !edge.is_border()));
    /// ```
    pub fn edges(&self) -> Vec<MeshEdge> {
        let (_, edges) = self.position_edges();
        let vertex = |corner: u32| self.indices()[corner as usize];
        let normal = |triangle: u32| -> Option<Vec3> {
            let [a, b, c] = [0, 1, 2].map(|corner| self.positions()[vertex(3 * triangle + corner) as usize]);
            face_normal(a, b, c)
        };
        let angle = |[a, b]: [u32; 2]| normal(a).zip(normal(b)).map(|(a, b)| a.angle_between(b));
        let found = edges.iter().map(|edge| {
            let first = edge.passes[0];
            let triangles = [first, *edge.passes.get(1).unwrap_or(&first)].map(|pass| pass / 3);
            let between = edges.regular(&edge).and_then(|passes| angle(passes.map(|pass| pass / 3)));
            let ends = edges.corners(first).map(vertex);
            MeshEdge { ends, triangles, angle: between.unwrap_or(std::f32::consts::PI) }
        });
        found.collect()
    }
}

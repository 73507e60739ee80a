//! A mesh with other normals.

use super::{NormalReport, Normals, creased_normals, face_normals, vertex_normals};
use crate::Mesh;

impl Mesh {
    /// The mesh with its normals by the policy, and what had to be left out or made up.
    ///
    /// [`Normals::Keep`] changes nothing. [`Normals::Face`] gives every triangle three vertices of its own, and +Y to
    /// degenerate ones, which show nothing. [`Normals::Weighted`] keeps vertices and triangles. [`Normals::Creased`]
    /// keeps the triangles, splits vertices and leaves out those of no triangle. All but `Keep` drop the tangents.
    #[must_use]
    pub fn with_normals(self, policy: Normals) -> (Self, NormalReport) {
        match policy {
            Normals::Keep => (self, NormalReport::default()),
            Normals::Face => {
                let (face, report) = face_normals(self.positions(), self.indices());
                let normals = face.into_iter().flat_map(|n| [n; 3]).collect();
                let corners = (0..self.indices().len() as u32).collect();
                (self.selected(self.indices(), corners).with_given_normals(normals), report)
            }
            Normals::Weighted(weighting) => {
                let (normals, report) = vertex_normals(self.positions(), self.indices(), weighting);
                (self.with_given_normals(normals), report)
            }
            Normals::Creased { angle, weighting } => creased_normals(&self, angle, weighting),
        }
    }
}

//! A mesh with other normals.

use glam::Vec3;

use super::{NormalReport, NormalWeighting, Normals, creased_normals, face_normals, vertex_normals};
use crate::Mesh;

impl Mesh {
    /// The mesh with its normals by the policy, and a report of triangles left out and normals filled in.
    ///
    /// [`Normals::Keep`] changes nothing. [`Normals::Face`] gives every triangle three vertices of its own, and +Y to
    /// degenerate ones, which are invisible. [`Normals::Weighted`] keeps vertices and triangles. [`Normals::Creased`]
    /// keeps the triangles, splits vertices and drops unused ones. [`Normals::Auto`] is `Keep` or `Creased`. All but
    /// `Keep` drop the tangents.
    #[must_use]
    pub fn with_normals(self, policy: Normals) -> (Self, NormalReport) {
        match policy {
            Normals::Keep => (self, NormalReport::default()),
            Normals::Face => {
                let faces = face_normals(self.positions(), self.indices());
                let is_degenerate = |n: &Vec3| *n == Vec3::ZERO;
                let degenerate_triangles = faces.iter().filter(|n| is_degenerate(n)).count();
                let normals =
                    faces.into_iter().flat_map(|n| [if is_degenerate(&n) { Vec3::Y } else { n }; 3]).collect();
                let corners = (0..self.indices().len() as u32).collect();
                let mesh = self.selected(self.indices(), corners).with_given_normals(normals);
                (mesh, NormalReport { degenerate_triangles, ..NormalReport::default() })
            }
            Normals::Weighted(weighting) => {
                let known = self.report_of_default_normals().filter(|_| weighting == NormalWeighting::default());
                if let Some(report) = known {
                    return (self.with_normals_as_given(), report);
                }
                let (normals, report) = vertex_normals(self.positions(), &self.points(), self.indices(), weighting);
                (self.with_given_normals(normals), report)
            }
            Normals::Creased { angle, weighting } => creased_normals(&self, angle, weighting),
            Normals::Auto if self.has_given_normals() => (self, NormalReport::default()),
            Normals::Auto => {
                let suited = self.suited_normals();
                self.with_normals(suited)
            }
        }
    }
}

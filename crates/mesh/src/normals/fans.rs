//! Fans: the parts into which creases cut the triangles around a vertex.

use glam::Vec3;

use super::face::face_normals;
use super::split::split_normals;
use super::{NormalReport, NormalWeighting};
use crate::Mesh;
use crate::classes::Classes;
use crate::edges::Edges;

/// The accuracy of the angle between two normals from `f32` positions; flat edges stay smooth at angle 0.
const ANGLE_ROUNDING: f64 = 1e-6;

/// Pairs are compared up to this number of triangles an edge, so that no file makes their number quadratic in its
/// size.
const CROWD: usize = 16;

/// The mesh with creased normals; see [`Normals::Creased`](super::Normals::Creased).
pub(crate) fn creased_normals(mesh: &Mesh, angle: f32, weighting: NormalWeighting) -> (Mesh, NormalReport) {
    let (_, edges) = mesh.position_edges();
    let normals = face_normals(mesh.positions(), mesh.indices());
    let limit = f64::from(angle) + ANGLE_ROUNDING;
    let smooth = |a: usize, b: usize| {
        let (a, b) = (normals[a].as_dvec3(), normals[b].as_dvec3());
        let sound = a.length_squared() > 0.0 && b.length_squared() > 0.0;
        // Not `acos`, which loses small angles.
        sound && a.cross(b).length().atan2(a.dot(b)) <= limit
    };
    let mut fans = Fans::new(&edges);
    for edge in edges.iter().filter(|edge| edge.passes.len() <= CROWD) {
        for (i, &pass) in edge.passes.iter().enumerate() {
            let others = edge.passes[..i].iter().filter(|&&other| smooth(pass as usize / 3, other as usize / 3));
            others.for_each(|&other| fans.join(&edges, pass, other));
        }
    }
    fans.normals(mesh, edges, normals, weighting)
}

/// Corners that share a normal: at first, each is alone.
pub(crate) struct Fans(Classes);

impl Fans {
    /// Each corner in a fan of its own.
    pub(crate) fn new(edges: &Edges) -> Self {
        Self(Classes::new(3 * edges.triangles().len()))
    }

    /// Joins the corners of two passes of one edge, at both of its ends.
    pub(crate) fn join(&mut self, edges: &Edges, pass: u32, other: u32) {
        let (a, b) = (edges.corners(pass), edges.corners(other));
        self.0.join(a[0], b[0]);
        self.0.join(a[1], b[1]);
    }

    /// Degenerate triangles are invisible: their corners join any fan at their position, so that no vertex is made for
    /// them. `normals` are those of the faces, zero for degenerate ones.
    fn adopt_degenerate(&mut self, edges: &Edges, normals: &[Vec3]) {
        if normals.iter().all(|n| *n != Vec3::ZERO) {
            return;
        }
        let corners = || 0..3 * edges.triangles().len() as u32;
        let is_degenerate = |corner: &u32| normals[*corner as usize / 3] == Vec3::ZERO;
        let points = edges.triangles().iter().flatten().max().map_or(0, |&most| most as usize + 1);
        let mut sound = vec![None; points];
        for corner in corners().filter(|corner| !is_degenerate(corner)) {
            sound[edges.point(corner) as usize].get_or_insert(corner);
        }
        for corner in corners().filter(is_degenerate) {
            if let Some(other) = sound[edges.point(corner) as usize] {
                self.0.join(corner, other);
            }
        }
    }

    /// The mesh with the mean normals of the fans. `faces` are the normals of its triangles, zero for degenerate ones.
    pub(crate) fn normals(
        mut self,
        mesh: &Mesh,
        edges: Edges,
        faces: Vec<Vec3>,
        weighting: NormalWeighting,
    ) -> (Mesh, NormalReport) {
        self.adopt_degenerate(&edges, &faces);
        drop((edges, faces));
        let (classes, count) = self.0.numbers();
        split_normals(mesh, &classes, count, weighting)
    }
}

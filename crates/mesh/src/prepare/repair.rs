//! Repair: drops triangles that are invisible, orients the others consistently and outward.

use std::fmt;

use super::components::Components;
use crate::edges::Edges;
use crate::numbering::Numbering;
use crate::{Mesh, MeshError, face_normal};

/// The changes made by [`Mesh::repaired`], and the faults that remain. `Display` lists the counts, or `nothing`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RepairReport {
    /// Degenerate triangles that were left out.
    pub removed_degenerate: usize,
    /// Triangles left out because they have the three positions of an earlier one, whichever way they wind.
    pub removed_duplicate: usize,
    /// Vertices left out because no triangle is left that uses them.
    pub removed_vertices: usize,
    /// Triangles flipped.
    pub turned: usize,
    /// Edges whose two triangles cannot be oriented consistently, because their component is not orientable.
    pub conflicts: usize,
    /// Triangles whose front faces away from the mean of their vertex normals after the repair.
    pub against_normals: usize,
}

impl fmt::Display for RepairReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.removed_degenerate, "degenerate triangles left out"),
            (self.removed_duplicate, "duplicate triangles left out"),
            (self.removed_vertices, "unused vertices left out"),
            (self.turned, "triangles turned over"),
            (self.conflicts, "edges that cannot be wound alike"),
            (self.against_normals, "triangles against their vertex normals"),
        ];
        let found = counts.into_iter().filter(|&(count, _)| count > 0);
        let found: Vec<String> = found.map(|(count, what)| format!("{count} {what}")).collect();
        if found.is_empty() { f.write_str("nothing") } else { f.write_str(&found.join(", ")) }
    }
}

impl Mesh {
    /// The mesh without degenerate and duplicate triangles and unused vertices, with each connected component oriented
    /// consistently.
    ///
    /// Components are joined by edges of exactly two triangles; edges are told apart by the positions of their ends. A
    /// closed component is turned outward by the sign of its volume, also if it lies inside another; an open one keeps
    /// the winding of most of its triangles. Normals stay as they are: where the report counts triangles against them,
    /// [`with_normals`](Self::with_normals) makes new ones.
    ///
    /// ```
    /// use glam::Vec3;
    /// use halfway_mesh::Mesh;
    ///
    /// // Two triangles of opposite winding, and a degenerate one.
    /// let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    /// let mesh = Mesh::new(corners, vec![0, 1, 2, 1, 2, 3, 0, 0, 1])?;
    /// let (repaired, report) = mesh.repaired()?;
    /// assert_eq!((report.removed_degenerate, report.turned), (1, 1));
    /// assert_eq!(repaired.report().problems.misoriented_edges, 0);
    /// # Ok::<(), halfway_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Every triangle is degenerate.
    pub fn repaired(&self) -> Result<(Self, RepairReport), MeshError> {
        let mut report = RepairReport::default();
        let groups = self.points();
        let sound = self.sound_triangles(&groups, &mut report);
        if sound.is_empty() {
            return Err(MeshError::NoTriangles);
        }
        let points = sound.iter().map(|triangle| triangle.map(|i| groups.numbers[i as usize])).collect();
        let edges = Edges::new(points);
        let position = |point: u32| self.positions()[groups.firsts[point as usize] as usize];
        let components = Components::new(&edges, position);
        report.conflicts = components.conflicts;
        report.turned = components.turn.iter().filter(|&&turn| turn).count();
        let wound =
            sound.iter().zip(&components.turn).map(|(&[a, b, c], &turn)| if turn { [a, c, b] } else { [a, b, c] });
        let indices: Vec<u32> = wound.flatten().collect();
        let mesh = self.in_order_of_use(&indices);
        report.removed_vertices = self.positions().len() - mesh.positions().len();
        report.against_normals = mesh.against_normals();
        Ok((mesh, report))
    }

    /// The triangles that have a normal and are the first with their positions.
    fn sound_triangles(&self, groups: &Numbering, report: &mut RepairReport) -> Vec<[u32; 3]> {
        let mut sound: Vec<[u32; 3]> = Vec::with_capacity(self.triangle_count());
        sound.extend(self.triangles().filter(|triangle| {
            let [a, b, c] = triangle.map(|i| self.positions()[i as usize]);
            face_normal(a, b, c).is_some()
        }));
        report.removed_degenerate = self.triangle_count() - sound.len();
        let distinct = Numbering::new(sound.len(), |triangle| {
            let mut points = sound[triangle].map(|i| groups.numbers[i as usize]);
            points.sort_unstable();
            points
        });
        report.removed_duplicate = sound.len() - distinct.count();
        distinct.firsts.iter().map(|&first| sound[first as usize]).collect()
    }

    /// How many triangles face away from the sum of their vertex normals.
    pub(super) fn against_normals(&self) -> usize {
        let against = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.positions()[i as usize]);
            let sum = triangle.iter().map(|&i| self.normals()[i as usize]).sum();
            face_normal(a, b, c).is_some_and(|n| n.dot(sum) < 0.0)
        };
        self.triangles().filter(against).count()
    }
}

//! Problems of a mesh that can be drawn all the same.

use std::fmt;

use crate::Mesh;
use crate::buckets::Buckets;
use crate::edges::{Edge, Edges};
use crate::normals::{NormalWeighting, vertex_normals};
use crate::numbering::Numbering;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The problems that [`Mesh::report`] found; none of them keeps the mesh from being drawn.
///
/// Edges are told apart by the positions of their ends, so that a seam in the texture coordinates is no border.
/// `Display` lists the counts, as `3 degenerate triangles, 12 open edges`, or `none`.
///
/// ```
/// use halfway_mesh::{Mesh, Plane};
///
/// let problems = Mesh::from(Plane::default()).report().problems;
/// assert_eq!(problems.to_string(), "4 open edges");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Problems {
    /// Triangles without a normal (see [`face_normal`](crate::face_normal)).
    pub degenerate_triangles: usize,
    /// Triangles with the same three positions as an earlier one, whichever way they wind.
    pub duplicate_triangles: usize,
    /// Vertices that equal an earlier one in all attributes.
    pub duplicate_vertices: usize,
    /// Vertices of no triangle.
    pub unused_vertices: usize,
    /// Vertices at which the faces around cancel out, so that their mean has no direction.
    pub cancelled_normals: usize,
    /// Edges of one triangle only: the border of a surface that is not closed.
    pub open_edges: usize,
    /// Edges of more than two triangles.
    pub crowded_edges: usize,
    /// Edges whose two triangles have opposite windings, so that one of them shows its back.
    pub misoriented_edges: usize,
}

impl Problems {
    /// Whether all counts are 0.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    fn named(&self) -> [(usize, &'static str, &'static str); 8] {
        [
            (self.degenerate_triangles, "degenerate triangle", "degenerate triangles"),
            (self.duplicate_triangles, "duplicate triangle", "duplicate triangles"),
            (self.duplicate_vertices, "duplicate vertex", "duplicate vertices"),
            (self.unused_vertices, "unused vertex", "unused vertices"),
            (self.cancelled_normals, "vertex whose faces cancel out", "vertices whose faces cancel out"),
            (self.open_edges, "open edge", "open edges"),
            (self.crowded_edges, "edge of more than two triangles", "edges of more than two triangles"),
            (self.misoriented_edges, "edge between opposite windings", "edges between opposite windings"),
        ]
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_none() {
            return f.write_str("none");
        }
        let mut separator = "";
        for (count, one, many) in self.named() {
            if count > 0 {
                write!(f, "{separator}{count} {}", if count == 1 { one } else { many })?;
                separator = ", ";
            }
        }
        Ok(())
    }
}

impl Mesh {
    /// The problems, from the positions' numbers and the edges between them.
    pub(crate) fn problems(&self, groups: &Numbering, edges: &Edges) -> Problems {
        let weigh = || vertex_normals(self.positions(), groups, self.indices(), NormalWeighting::default()).1;
        let report = self.report_of_default_normals().unwrap_or_else(weigh);
        let mut used = vec![false; self.positions().len()];
        for &i in self.indices() {
            used[i as usize] = true;
        }
        let count = |holds: fn(&Edges, &Edge) -> bool| edges.iter().filter(|edge| holds(edges, edge)).count();
        Problems {
            degenerate_triangles: report.degenerate_triangles,
            duplicate_triangles: duplicate_triangles(edges.triangles()),
            duplicate_vertices: if groups.are_distinct() {
                0
            } else {
                self.positions().len() - self.identical_vertices(&groups.numbers).count()
            },
            unused_vertices: used.iter().filter(|&&used| !used).count(),
            cancelled_normals: report.cancelled,
            open_edges: count(|_, edge| edge.passes.len() == 1),
            crowded_edges: count(|_, edge| edge.passes.len() > 2),
            misoriented_edges: count(|edges, edge| edge.passes.len() == 2 && edges.regular(edge).is_none()),
        }
    }
}

/// How many triangles have the points of an earlier one.
fn duplicate_triangles(triangles: &[[u32; 3]]) -> usize {
    let sorted = |triangle: u32| {
        let mut sorted = triangles[triangle as usize];
        sorted.sort_unstable();
        sorted
    };
    let points = triangles.as_flattened().iter().max().map_or(0, |&most| most as usize + 1);
    let lowest = |&[a, b, c]: &[u32; 3]| Some(a.min(b).min(c));
    let mut buckets = Buckets::new(points, triangles.iter().map(lowest));
    let count = AtomicUsize::new(0);
    buckets.par_each(Vec::new, |seen, own| {
        seen.clear();
        seen.extend(own.iter().map(|&triangle| sorted(triangle)));
        seen.sort_unstable();
        seen.dedup();
        count.fetch_add(own.len() - seen.len(), Ordering::Relaxed);
    });
    count.into_inner()
}

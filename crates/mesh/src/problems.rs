//! What is wrong with a mesh that can be drawn all the same.

use std::collections::{HashMap, HashSet};
use std::fmt;

use crate::Mesh;
use crate::normals::{NormalWeighting, position_groups, vertex_normals};

/// What a look over a mesh found: nothing of it keeps the mesh from being drawn.
///
/// Edges are told apart by the positions of their ends, so that a seam in the texture coordinates is no border. Shown
/// as text it lists what there is, as `3 degenerate triangles, 12 open edges`, or `none`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Problems {
    /// Triangles without a normal (see [`face_normal`](crate::face_normal)).
    pub degenerate_triangles: usize,
    /// Triangles with the same three positions as an earlier one, whichever way they wind.
    pub duplicate_triangles: usize,
    /// Vertices that equal an earlier one in position, normal and texture coordinates.
    pub duplicate_vertices: usize,
    /// Vertices of no triangle.
    pub unused_vertices: usize,
    /// Vertices at which the faces around cancel out, so that their mean has no direction.
    pub cancelled_normals: usize,
    /// Edges of one triangle only: the border of a surface that is not closed.
    pub open_edges: usize,
    /// Edges of more than two triangles.
    pub crowded_edges: usize,
    /// Edges whose two triangles wind opposite ways, so that one of them shows its back.
    pub misoriented_edges: usize,
}

impl Problems {
    /// Whether nothing was found.
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
    /// Looks the mesh over. Takes time and memory in proportion to its size.
    pub fn problems(&self) -> Problems {
        let (groups, group_count) = position_groups(self.positions());
        let (_, report) = vertex_normals(self.positions(), self.indices(), NormalWeighting::default());
        let mut used = vec![false; self.positions().len()];
        for &i in self.indices() {
            used[i as usize] = true;
        }
        let triangles: Vec<[u32; 3]> = self.triangles().map(|triangle| triangle.map(|i| groups[i as usize])).collect();
        let edges = Edges::of(&triangles);
        Problems {
            degenerate_triangles: report.degenerate_triangles,
            duplicate_triangles: duplicate_triangles(&triangles, group_count),
            duplicate_vertices: self.duplicate_vertices(&groups),
            unused_vertices: used.iter().filter(|&&used| !used).count(),
            cancelled_normals: report.cancelled,
            open_edges: edges.open,
            crowded_edges: edges.crowded,
            misoriented_edges: edges.misoriented,
        }
    }

    fn duplicate_vertices(&self, groups: &[u32]) -> usize {
        let mut seen = HashSet::with_capacity(groups.len());
        groups
            .iter()
            .enumerate()
            .filter(|&(vertex, &group)| {
                let n = self.normals()[vertex].to_array().map(f32::to_bits);
                let uv = self.uvs().map(|uvs| uvs[vertex].to_array().map(f32::to_bits));
                !seen.insert((group, n, uv))
            })
            .count()
    }
}

fn duplicate_triangles(triangles: &[[u32; 3]], group_count: usize) -> usize {
    let mut seen = HashSet::with_capacity(group_count);
    triangles
        .iter()
        .filter(|triangle| {
            let mut sorted = **triangle;
            sorted.sort_unstable();
            !seen.insert(sorted)
        })
        .count()
}

/// How the edges of a surface meet.
struct Edges {
    open: usize,
    crowded: usize,
    misoriented: usize,
}

impl Edges {
    fn of(triangles: &[[u32; 3]]) -> Self {
        // How many triangles pass an edge upward and downward, by the numbers of its ends.
        let mut passes: HashMap<(u32, u32), (usize, usize)> = HashMap::new();
        for &[a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                match from.cmp(&to) {
                    std::cmp::Ordering::Less => passes.entry((from, to)).or_default().0 += 1,
                    std::cmp::Ordering::Greater => passes.entry((to, from)).or_default().1 += 1,
                    std::cmp::Ordering::Equal => {}
                }
            }
        }
        let count = |holds: fn(usize, usize) -> bool| passes.values().filter(|&&(up, down)| holds(up, down)).count();
        Self {
            open: count(|up, down| up + down == 1),
            crowded: count(|up, down| up + down > 2),
            misoriented: count(|up, down| up + down == 2 && up != down),
        }
    }
}

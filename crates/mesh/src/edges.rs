//! The edges of a list of triangles.

use rayon::prelude::*;

use crate::buckets::Buckets;

/// The edges between numbered points, and the triangles along them.
///
/// A pass is 3·triangle + corner: that triangle runs along the edge from that corner to the next. A side between a
/// point and itself is not an edge.
pub(crate) struct Edges {
    triangles: Vec<[u32; 3]>,
    /// All passes in buckets by the lower end, sorted by the higher end, then their own number.
    passes: Buckets,
}

/// An edge, and the passes along it.
pub(crate) struct Edge<'a> {
    /// Its ends, the lower first.
    pub(crate) ends: [u32; 2],
    /// At least one pass, in the order of the triangles.
    pub(crate) passes: &'a [u32],
}

/// The corner after this one in its triangle, both as 3·triangle + corner.
pub(crate) fn next_corner(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

impl Edges {
    /// The edges of triangles; fewer than 2³² corners in all.
    pub(crate) fn new(triangles: Vec<[u32; 3]>) -> Self {
        Self::at_points(triangles, |_| true)
    }

    /// The edges whose lower end is among these points.
    pub(crate) fn at_points(triangles: Vec<[u32; 3]>, is_among: impl Fn(u32) -> bool + Copy) -> Self {
        let points = triangles.as_flattened().iter().max().map_or(0, |&most| most as usize + 1);
        let lower_ends = |&[a, b, c]: &[u32; 3]| {
            [[a, b], [b, c], [c, a]].map(|[from, to]| Some(from.min(to)).filter(|&lower| from != to && is_among(lower)))
        };
        let mut passes = Buckets::new(points, triangles.iter().flat_map(lower_ends));
        passes.sort_each(|pass| {
            let triangle = triangles[pass as usize / 3];
            let (from, to) = (triangle[pass as usize % 3], triangle[next_corner(pass) as usize % 3]);
            from.max(to)
        });
        Self { triangles, passes }
    }

    /// The triangles by the numbers of their points.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The point at a corner.
    pub(crate) fn point(&self, corner: u32) -> u32 {
        self.triangles[corner as usize / 3][corner as usize % 3]
    }

    fn ends(&self, pass: u32) -> [u32; 2] {
        let (from, to) = (self.point(pass), self.point(next_corner(pass)));
        [from.min(to), from.max(to)]
    }

    /// Whether the pass goes from the lower end to the higher.
    pub(crate) fn is_upward(&self, pass: u32) -> bool {
        self.point(pass) < self.point(next_corner(pass))
    }

    /// The corners of a pass at the lower and at the higher end.
    pub(crate) fn corners(&self, pass: u32) -> [u32; 2] {
        let next = next_corner(pass);
        if self.is_upward(pass) { [pass, next] } else { [next, pass] }
    }

    /// The point of the pass's triangle that is not on the edge.
    pub(crate) fn opposite(&self, pass: u32) -> u32 {
        self.point(next_corner(next_corner(pass)))
    }

    /// All edges, in the order of their ends.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Edge<'_>> {
        self.edges_of(self.passes.things())
    }

    /// The same in parts, which threads share.
    pub(crate) fn par_parts(&self) -> impl ParallelIterator<Item = impl Iterator<Item = Edge<'_>>> {
        self.passes.parts().into_par_iter().map(|passes| self.edges_of(&self.passes.things()[passes]))
    }

    fn edges_of<'a>(&'a self, passes: &'a [u32]) -> impl Iterator<Item = Edge<'a>> {
        let edges = passes.chunk_by(|&a, &b| self.ends(a) == self.ends(b));
        edges.map(|passes| Edge { ends: self.ends(passes[0]), passes })
    }

    /// The two passes of an edge between two triangles of the same winding, which run along it in opposite directions.
    pub(crate) fn regular(&self, edge: &Edge) -> Option<[u32; 2]> {
        match *edge.passes {
            [a, b] if self.is_upward(a) != self.is_upward(b) => Some([a, b]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_and_their_passes() {
        // Two triangles of the same winding, one of the opposite, and one with a side of no length.
        let edges = Edges::new(vec![[0, 1, 2], [2, 1, 3], [1, 3, 4], [5, 5, 0]]);
        let found: Vec<_> = edges.iter().map(|edge| (edge.ends, edge.passes.to_vec())).collect();
        let expected = [
            ([0, 1], vec![0]),
            ([0, 2], vec![2]),
            ([0, 5], vec![10, 11]),
            ([1, 2], vec![1, 3]),
            ([1, 3], vec![4, 6]),
            ([1, 4], vec![8]),
            ([2, 3], vec![5]),
            ([3, 4], vec![7]),
        ];
        assert_eq!(found, expected);
        let regular: Vec<_> = edges.iter().filter_map(|edge| edges.regular(&edge)).collect();
        assert_eq!(regular, [[10, 11], [1, 3]]);
        assert_eq!(edges.corners(3), [4, 3]);
    }
}

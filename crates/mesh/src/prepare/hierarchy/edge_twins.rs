//! Which edges of triangles meet.

/// The twin of an edge that has none.
pub(super) const NO_TWIN: u32 = u32::MAX;

/// The twin of each edge of each triangle, those from its first, its second and its third corner: an edge that passes
/// the other way between the same corners, by three times the number of its triangle and its own. Twins are each
/// other's.
///
/// Triangles are between corners numbered below `count`.
pub(super) fn edge_twins(triangles: &[[u32; 3]], count: usize) -> Vec<u32> {
    let mut twins = vec![NO_TWIN; 3 * triangles.len()];
    // From each corner the edge without a twin that came last, and of each such edge the one before it.
    let mut last = vec![NO_TWIN; count];
    let mut before = vec![NO_TWIN; 3 * triangles.len()];
    let end = |edge: u32| triangles[edge as usize / 3][(edge as usize + 1) % 3];
    for (edge, &from) in (0..).zip(triangles.as_flattened()) {
        let to = end(edge);
        let (mut later, mut other) = (NO_TWIN, last[to as usize]);
        while other != NO_TWIN && end(other) != from {
            (later, other) = (other, before[other as usize]);
        }
        if other == NO_TWIN {
            before[edge as usize] = std::mem::replace(&mut last[from as usize], edge);
            continue;
        }
        let earlier = before[other as usize];
        let link = if later == NO_TWIN { &mut last[to as usize] } else { &mut before[later as usize] };
        *link = earlier;
        (twins[edge as usize], twins[other as usize]) = (other, edge);
    }
    twins
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_edge_has_one_twin_at_most() {
        // A tetrahedron; then three triangles on one edge, of which two have it the same way.
        let closed = edge_twins(&[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]], 4);
        assert_eq!(closed, [5, 8, 11, 10, 6, 0, 4, 9, 1, 7, 3, 2]);
        let three = edge_twins(&[[0, 1, 2], [0, 1, 3], [1, 0, 4]], 5);
        let none = NO_TWIN;
        assert_eq!(three, [none, none, none, 6, none, none, 3, none, none]);
    }
}

//! The edges that other meshes may share.

use super::stand_ins::StandIns;
use crate::Mesh;

/// Whether each place is on an edge of one triangle only, or of more than two.
pub(super) fn open_border(mesh: &Mesh, stand_ins: &StandIns) -> Vec<bool> {
    let drawn: Vec<[u32; 3]> = mesh.triangles().collect();
    let triangles =
        || stand_ins.triangles(&drawn).map(|triangle| triangle.map(|vertex| stand_ins.places[vertex as usize]));
    let edges =
        || triangles().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)]));
    // Where the edges from each place to those of greater numbers begin; then where they end.
    let mut ends = vec![0_usize; stand_ins.places.len()];
    for [from, _] in edges() {
        ends[from as usize] += 1;
    }
    let mut before = 0;
    for end in &mut ends {
        before += std::mem::replace(end, before);
    }
    let mut others = vec![0; before];
    for [from, to] in edges() {
        let end = &mut ends[from as usize];
        others[*end] = to;
        *end += 1;
    }
    let mut stays = vec![false; stand_ins.places.len()];
    let mut start = 0;
    for (from, end) in ends.into_iter().enumerate() {
        let others = &mut others[std::mem::replace(&mut start, end)..end];
        others.sort_unstable();
        for edge in others.chunk_by(|a, b| a == b).filter(|edge| edge.len() != 2) {
            stays[from] = true;
            stays[edge[0] as usize] = true;
        }
    }
    stays
}

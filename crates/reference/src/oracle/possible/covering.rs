//! The surfaces that cover a point however a renderer rounds their vertices.

use std::collections::HashMap;

use halfway_lighting::Faces;

use super::footprint::Footprint;
use crate::oracle::scene::OracleScene;

/// Triangles that are connected within a disc: neighbours share an edge that crosses it.
///
/// A renderer moves vertices by less than the disc's radius, coincident ones together. An edge outside the disc then
/// does not pass its centre. So where two triangles share each edge inside, a surface that covers the centre still does
/// after rounding: the winding number around the centre does not change.
#[derive(Debug)]
pub(super) struct CoveringGroup {
    /// Indices of footprints.
    pub(super) members: Vec<usize>,
    /// Whether a visible member covers the centre under any rounding.
    pub(super) is_certain: bool,
    /// Whether exactly one does, and all face the same way.
    pub(super) is_single: bool,
    /// Whether rounding may flip some members, so that the surface folds over itself.
    pub(super) may_fold: bool,
}

/// A shared edge: the [`group`] of its triangles, and its ends, the smaller one first.
type SharedEdge = (usize, [u64; 3], [u64; 3]);

/// The number of triangles that use an edge in either direction.
#[derive(Default)]
struct Uses {
    forward: Vec<usize>,
    backward: Vec<usize>,
}

/// The coverings of a disc.
pub(super) fn coverings(scene: &OracleScene, footprints: &[Footprint]) -> Vec<CoveringGroup> {
    let mut edges: HashMap<SharedEdge, Uses> = HashMap::new();
    for (number, footprint) in footprints.iter().enumerate() {
        let group = group(scene, footprints, footprint.solid);
        for i in (0..3).filter(|i| footprint.edges[*i]) {
            let (from, to) = (footprint.corners[i], footprint.corners[(i + 1) % 3]);
            let uses = edges.entry((group, from.min(to), from.max(to))).or_default();
            if from < to { uses.forward.push(number) } else { uses.backward.push(number) }
        }
    }
    let mut leaders: Vec<usize> = (0..footprints.len()).collect();
    for uses in edges.values() {
        let mut users = uses.forward.iter().chain(&uses.backward);
        if let Some(first) = users.next() {
            users.for_each(|user| unite(&mut leaders, *first, *user));
        }
    }
    let mut rims: Vec<Rim> =
        footprints.iter().map(|footprint| Rim { is_open: footprint.cut, ..Rim::default() }).collect();
    for uses in edges.values() {
        let (forward, backward) = (uses.forward.len(), uses.backward.len());
        let user = uses.forward.first().or(uses.backward.first()).expect("an edge is noted with its triangle");
        rims[*user].is_open |= (forward + backward) % 2 == 1;
        rims[*user].is_unbalanced |= forward != backward;
    }
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); footprints.len()];
    for number in 0..footprints.len() {
        let leader = leader(&mut leaders, number);
        members[leader].push(number);
    }
    members.retain(|members| !members.is_empty());
    members.into_iter().map(|members| covering(scene, footprints, &rims, members)).collect()
}

/// The state of the edges of a group that cross the disc.
#[derive(Clone, Copy, Default)]
struct Rim {
    /// An edge is a border of the surface.
    is_open: bool,
    /// An edge is used in one direction more often than in the other.
    is_unbalanced: bool,
}

fn covering(scene: &OracleScene, footprints: &[Footprint], rims: &[Rim], members: Vec<usize>) -> CoveringGroup {
    let is_open = members.iter().any(|member| rims[*member].is_open);
    let is_balanced = !members.iter().any(|member| rims[*member].is_unbalanced);
    let at_centre: Vec<&Footprint> = members.iter().map(|m| &footprints[*m]).filter(|it| it.at_centre).collect();
    let turns: i32 = at_centre.iter().map(|it| if it.counter_clockwise { 1 } else { -1 }).sum();
    let first = &scene.solids[footprints[members[0]].solid];
    let shown = |turns: i32| turns != 0 && first.side((turns > 0) != first.mirrored).shown;
    let by_turns = is_balanced && shown(turns);
    let by_number = first.faces == Faces::Both && at_centre.len() % 2 == 1;
    let one_sided =
        members.iter().all(|m| footprints[*m].counter_clockwise == footprints[members[0]].counter_clockwise);
    let is_certain = !is_open && (by_turns || by_number);
    let may_fold = members.iter().any(|member| footprints[*member].thin);
    let is_single = one_sided && is_certain && at_centre.len() == 1 && !may_fold;
    CoveringGroup { members, is_certain, is_single, may_fold }
}

/// Triangles of one group number can be connected: those of opaque objects that show the same sides and have equal
/// transforms, so that a renderer rounds equal corners alike; or those of one blended object.
fn group(scene: &OracleScene, footprints: &[Footprint], solid: usize) -> usize {
    let own = &scene.solids[solid];
    let is_like = |number: usize| {
        let other = &scene.solids[number];
        !other.blend && other.faces == own.faces && other.eye_from_model == own.eye_from_model
    };
    if own.blend {
        return solid;
    }
    footprints.iter().map(|footprint| footprint.solid).find(|number| is_like(*number)).unwrap_or(solid)
}

fn unite(leaders: &mut [usize], a: usize, b: usize) {
    let (a, b) = (leader(leaders, a), leader(leaders, b));
    leaders[a.max(b)] = a.min(b);
}

fn leader(leaders: &mut [usize], mut number: usize) -> usize {
    while leaders[number] != number {
        leaders[number] = leaders[leaders[number]];
        number = leaders[number];
    }
    number
}

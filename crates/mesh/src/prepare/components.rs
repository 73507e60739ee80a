//! The connected components of a mesh, and their orientation.

use glam::{DVec3, Vec3};

use crate::edges::Edges;

/// A closed component whose volume is a smaller fraction of the cube around it than this counts as flat.
const FLAT: f64 = 1e-9;

/// The connected components of a mesh: triangles joined by edges that exactly two of them share.
pub(super) struct Components {
    /// Whether each triangle has to be flipped so that its component is oriented consistently and, if closed, outward.
    pub(super) turn: Vec<bool>,
    /// The components, by their first triangle.
    pub(super) pieces: Vec<ConnectedPiece>,
    /// Pairs of adjacent triangles that cannot be oriented consistently, as on a Möbius strip.
    pub(super) conflicts: usize,
}

/// A connected component.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ConnectedPiece {
    /// Whether every edge has two triangles and the component is orientable.
    pub(super) closed: bool,
    /// Whether it is closed and, oriented consistently, has more triangles that face in than out.
    pub(super) inward: bool,
    /// The enclosed volume, if closed.
    pub(super) volume: f64,
}

impl Components {
    /// The components; `positions` are those of the points that the edges join.
    pub(super) fn new(edges: &Edges, positions: impl Fn(u32) -> Vec3) -> Self {
        let neighbours = Neighbours::new(edges);
        let count = edges.triangles().len();
        let mut components = Self { turn: vec![false; count], pieces: Vec::new(), conflicts: 0 };
        let mut seen = vec![false; count];
        for seed in 0..count {
            if seen[seed] {
                continue;
            }
            seen[seed] = true;
            let mut members = vec![seed as u32];
            let mut next = 0;
            let mut conflicts = 0;
            while let Some(&triangle) = members.get(next) {
                next += 1;
                for (other, alike) in neighbours.around(edges, triangle) {
                    let turn = components.turn[triangle as usize] == alike;
                    if !seen[other as usize] {
                        seen[other as usize] = true;
                        components.turn[other as usize] = turn;
                        members.push(other);
                    } else if components.turn[other as usize] != turn && other > triangle {
                        conflicts += 1;
                    }
                }
            }
            components.conflicts += conflicts;
            components.finish(edges, &positions, &neighbours, &members, conflicts == 0);
        }
        components
    }

    /// Chooses the orientation of a component: outward if closed, else that of most of its triangles.
    fn finish(
        &mut self,
        edges: &Edges,
        positions: impl Fn(u32) -> Vec3,
        neighbours: &Neighbours,
        members: &[u32],
        two_sided: bool,
    ) {
        let turned = members.iter().filter(|&&triangle| self.turn[triangle as usize]).count();
        let mut invert = 2 * turned > members.len();
        let closed = two_sided && members.iter().all(|&triangle| neighbours.is_enclosed(triangle));
        let mut piece = ConnectedPiece { closed, ..ConnectedPiece::default() };
        if piece.closed {
            let corners = |triangle: u32| edges.triangles()[triangle as usize].map(|i| positions(i).as_dvec3());
            let origin = corners(members[0])[0];
            let (mut volume, mut reach) = (0.0, 0.0_f64);
            for &triangle in members {
                let [a, b, c] = corners(triangle).map(|p| p - origin);
                let sign = if self.turn[triangle as usize] { -1.0 } else { 1.0 };
                volume += sign * a.dot(b.cross(c)) / 6.0;
                reach = [a, b, c].iter().fold(reach, |most, p: &DVec3| most.max(p.abs().max_element()));
            }
            piece.volume = volume.abs();
            if volume.abs() > FLAT * reach.powi(3) {
                piece.inward = (volume < 0.0) != invert;
                invert = volume < 0.0;
            }
        }
        if invert {
            for &triangle in members {
                self.turn[triangle as usize] ^= true;
            }
        }
        self.pieces.push(piece);
    }
}

/// The neighbours across the three sides of each triangle.
struct Neighbours {
    /// The pass on the other side, or a mark.
    across: Vec<[u32; 3]>,
}

/// No other triangle, or more than one.
const NONE: u32 = u32::MAX;

impl Neighbours {
    fn new(edges: &Edges) -> Self {
        let mut across = vec![[NONE; 3]; edges.triangles().len()];
        for edge in edges.iter() {
            if let [a, b] = *edge.passes {
                across[a as usize / 3][a as usize % 3] = b;
                across[b as usize / 3][b as usize % 3] = a;
            }
        }
        Self { across }
    }

    /// The adjacent triangles, and whether they have the same orientation.
    fn around(&self, edges: &Edges, triangle: u32) -> impl Iterator<Item = (u32, bool)> {
        let passes = (3 * triangle..).zip(self.across[triangle as usize]).filter(|&(_, other)| other != NONE);
        passes.map(|(pass, other)| (other / 3, edges.is_upward(pass) != edges.is_upward(other)))
    }

    /// Whether there is exactly one triangle across each side.
    fn is_enclosed(&self, triangle: u32) -> bool {
        self.across[triangle as usize].iter().all(|&other| other != NONE)
    }
}

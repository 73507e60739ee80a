//! A fine surface, as seen from over one triangle after the other of a coarse one.

use std::ops::Range;

use bevy_math::{DVec2, DVec3, Vec3A};

use super::box_grid::BoxGrid;
use super::clip::third;
use super::edge_twins::{NO_TWIN, edge_twins};
use super::frame::{Frame, QuickWay, reached};
use super::triangle_fans::TriangleFans;
use crate::Mesh;
use crate::prepare::nearest::TriangleCorners;

/// Two surfaces between a mesh's vertices.
pub(super) struct Surfaces<'a> {
    pub(super) mesh: &'a Mesh,
    /// Of each vertex of the mesh, the first with its position.
    pub(super) places: &'a [u32],
    pub(super) coarse: &'a [[u32; 3]],
    /// Runs of the coarse ones, one behind the other.
    pub(super) runs: &'a [Range<usize>],
    pub(super) fine: &'a [[u32; 3]],
    /// The vertices of the fine one for which the coarse one stands; it may have others at its border.
    pub(super) covered: &'a [u32],
}

/// What is within a triangle by no more than this part of its height lies on its rim: there parts may lack that only
/// rounding keeps from being there.
const RIM: f64 = 1e-8;

/// The triangles of a fine surface, with numbers of their own for the vertices.
pub(super) struct FineSurface {
    /// Of each vertex, the covered ones first.
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<DVec3>,
    /// The corner first whose vertex has the least number in the mesh.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Of each vertex its place, as a number of their own.
    place_numbers: Vec<u32>,
    /// Of each place the triangles around it, and the sum of their normals, each as long as twice the area.
    fans: TriangleFans,
    areas: Vec<DVec3>,
    /// Of each edge of each triangle, by places.
    twins: Vec<u32>,
    /// Of each triangle the corners in single precision.
    points: Vec<[Vec3A; 3]>,
    /// What was seen of each vertex last.
    vertices: Vec<SeenVertex>,
    /// Of each triangle from which coarse one it was come to last, over edges.
    come_to: Vec<u32>,
    /// Those that were come to and not looked at.
    waiting: Vec<u32>,
    /// Of each triangle from which coarse one it was seen last to lie over that, facing the same way.
    over: Vec<u32>,
    /// Those that lie over the coarse one from which is looked now.
    pub(super) over_this: Vec<u32>,
}

/// A vertex of the fine surface as seen from a coarse triangle.
#[derive(Clone, Copy)]
pub(super) struct SeenVertex {
    /// The number of that triangle.
    from: u32,
    /// Whether `turn` is of this triangle.
    is_turned: bool,
    /// Whether it was [told](FineSurface::told_first) from this triangle.
    is_told: bool,
    /// The weights of the triangle's second and third corner.
    pub(super) at: DVec2,
    /// How far above the triangle it is.
    pub(super) height: f64,
    /// The square of the difference from the triangle's normal there, and the part along the triangle's mean normal.
    pub(super) turn: [f64; 2],
}

impl SeenVertex {
    /// Whether it lies over the triangle or on its sides.
    fn is_over(&self) -> bool {
        self.at.x >= 0.0 && self.at.y >= 0.0 && third(self.at) >= 0.0
    }
}

impl FineSurface {
    /// The fine one of two surfaces, and the coarse triangles by its numbers, `u32::MAX` where it has no such vertex,
    /// likewise the corner first that has the least number in the mesh. `slots` has `u32::MAX` for every vertex, before
    /// and after.
    pub(super) fn new(surfaces: &Surfaces, slots: &mut [u32]) -> (Self, Vec<[u32; 3]>) {
        let Surfaces { mesh, places, coarse, fine, covered, .. } = surfaces;
        let mut vertices = covered.to_vec();
        for (slot, &vertex) in (0..).zip(&vertices) {
            slots[vertex as usize] = slot;
        }
        for &vertex in fine.as_flattened() {
            let slot = &mut slots[vertex as usize];
            if *slot == u32::MAX {
                *slot = vertices.len() as u32;
                vertices.push(vertex);
            }
        }
        let numbered = |triangle: &[u32; 3]| first_least(*triangle).map(|vertex| slots[vertex as usize]);
        let triangles: Vec<[u32; 3]> = fine.iter().map(numbered).collect();
        let coarse = coarse.iter().map(numbered).collect();
        for &vertex in &vertices {
            slots[vertex as usize] = u32::MAX;
        }
        // By places, so that what is on both sides of a seam is one edge.
        let mut count = 0;
        let number = |vertex: &u32| {
            let slot = &mut slots[places[*vertex as usize] as usize];
            if *slot == u32::MAX {
                *slot = count;
                count += 1;
            }
            *slot
        };
        let numbers: Vec<u32> = vertices.iter().map(number).collect();
        for &vertex in &vertices {
            slots[places[vertex as usize] as usize] = u32::MAX;
        }
        let by_places: Vec<[u32; 3]> =
            triangles.iter().map(|triangle| triangle.map(|vertex| numbers[vertex as usize])).collect();
        let mut areas = vec![DVec3::ZERO; count as usize];
        for (&triangle, places) in fine.iter().zip(&by_places) {
            let [a, b, c] = mesh.corners(triangle);
            let area = (b - a).cross(c - a);
            for &place in places {
                areas[place as usize] += area;
            }
        }
        let unseen = SeenVertex {
            from: u32::MAX,
            is_turned: false,
            is_told: false,
            at: DVec2::ZERO,
            height: 0.0,
            turn: [0.0; 2],
        };
        let surface = Self {
            positions: vertices.iter().map(|&vertex| mesh.positions()[vertex as usize].as_dvec3()).collect(),
            normals: vertices.iter().map(|&vertex| mesh.normals()[vertex as usize].as_dvec3()).collect(),
            twins: edge_twins(&by_places, count as usize),
            fans: TriangleFans::new(&by_places, count as usize),
            areas,
            place_numbers: numbers,
            come_to: vec![u32::MAX; triangles.len()],
            waiting: Vec::new(),
            points: triangles
                .iter()
                .map(|triangle| triangle.map(|vertex| mesh.positions()[vertices[vertex as usize] as usize].into()))
                .collect(),
            vertices: vec![unseen; vertices.len()],
            over: vec![u32::MAX; triangles.len()],
            over_this: Vec::new(),
            triangles,
        };
        (surface, coarse)
    }

    /// Comes from a coarse triangle, given by its corners, to the fine ones around those. Returns whether it is one of
    /// them; then nothing else has to be [looked at](Self::spread).
    pub(super) fn begin(&mut self, own: [u32; 3], from: u32) -> bool {
        self.waiting.clear();
        self.over_this.clear();
        let mut is_same = false;
        for vertex in own {
            let Some(&place) = self.place_numbers.get(vertex as usize) else { continue };
            for &number in self.fans.of(place) {
                is_same |= self.triangles[number as usize] == own;
                if std::mem::replace(&mut self.come_to[number as usize], from) != from {
                    self.waiting.push(number);
                }
            }
        }
        is_same
    }

    /// Where the surface faces around the corners of a coarse triangle, as long as twice its areas there.
    pub(super) fn outward(&self, own: [u32; 3]) -> DVec3 {
        let places = own.iter().filter_map(|&vertex| self.place_numbers.get(vertex as usize));
        places.map(|&place| self.areas[place as usize]).sum()
    }

    /// The triangles that were come to and not looked at.
    pub(super) fn waiting(&self) -> &[u32] {
        &self.waiting
    }

    /// Looks at all that were come to, comes from those that lie over the coarse triangle to those beside them, and so
    /// on: what covers it once hangs together by edges, and has a corner in common with it. Adds to `near` all that
    /// were come to, and what is beside them, some of it twice.
    pub(super) fn spread(&mut self, frame: &Frame, from: u32, near: &mut Vec<u32>) {
        while let Some(number) = self.waiting.pop() {
            near.push(number);
            let is_over = self.look_exactly(frame, from, number);
            for &twin in &self.twins[3 * number as usize..][..3] {
                let beside = twin / 3;
                if twin == NO_TWIN || self.come_to[beside as usize] == from {
                    continue;
                }
                if is_over {
                    self.come_to[beside as usize] = from;
                    self.waiting.push(beside);
                } else {
                    near.push(beside);
                }
            }
        }
    }

    /// Looks at all that are in reach of a coarse triangle, found by place, more or less. Adds to `near` those that lie
    /// near it.
    pub(super) fn look_at_all(
        &mut self,
        grid: &BoxGrid,
        corners: TriangleCorners,
        frame: &Frame,
        from: u32,
        near: &mut Vec<u32>,
    ) {
        self.over_this.clear();
        let [low, high] = reached(corners, frame);
        grid.meeting(low, high, |number| {
            let way = frame.quick.way(&self.points[number as usize]);
            if way == QuickWay::Over {
                self.look_exactly(frame, from, number);
            }
            if way != QuickWay::Away {
                near.push(number);
            }
        });
    }

    /// Adds a fine triangle to those over a coarse one if it lies over it, within its reach, and faces the same way;
    /// returns whether it does.
    fn look_exactly(&mut self, frame: &Frame, from: u32, number: u32) -> bool {
        for vertex in self.triangles[number as usize] {
            let seen = &mut self.vertices[vertex as usize];
            if seen.from != from {
                let offset = self.positions[vertex as usize] - frame.origin;
                seen.at = DVec2::new(offset.dot(frame.axes[0]), offset.dot(frame.axes[1]));
                seen.height = offset.dot(frame.axes[2]);
                (seen.from, seen.is_turned, seen.is_told) = (from, false, false);
            }
        }
        // Not beside it, facing the other way, edge on or out of reach.
        let corners = self.corners(number);
        let [a, b, c] = corners.map(|corner| corner.at);
        let is_within = |depth: fn(DVec2) -> f64| (depth(a) > 0.0) | (depth(b) > 0.0) | (depth(c) > 0.0);
        let is_over = is_within(|at| at.x) & is_within(|at| at.y) & is_within(third);
        let is_in_reach = corners.iter().any(|corner| corner.height < frame.reach)
            && corners.iter().any(|corner| corner.height > -frame.reach);
        if is_over && is_in_reach && (b - a).perp_dot(c - a) > 0.0 {
            self.over[number as usize] = from;
            self.over_this.push(number);
            return true;
        }
        false
    }

    /// Whether the fine triangles that lie over a coarse one, and face the same way, cover it exactly once.
    ///
    /// Where each of their edges that pass over it has a twin among them, as many of them lie over one point of it as
    /// over any other, so that it is enough to count them at one.
    pub(super) fn covers_once(&self, from: u32) -> bool {
        let mut count = 0;
        for &number in &self.over_this {
            let corners = self.corners(number);
            let twins = &self.twins[3 * number as usize..][..3];
            for (edge, &twin) in twins.iter().enumerate() {
                if twin != NO_TWIN && self.over[twin as usize / 3] == from {
                    continue;
                }
                if !passes_by(corners[edge].at, corners[(edge + 1) % 3].at) {
                    return false;
                }
            }
            let [a, b, c] = corners.map(|corner| corner.at - COUNTED_AT);
            let least = a.perp_dot(b).min(b.perp_dot(c)).min(c.perp_dot(a));
            if least.abs() < UNCLEAR {
                return false;
            }
            count += u32::from(least > 0.0);
        }
        count == 1
    }

    /// The height of a vertex that lies over the coarse triangle from which it was seen, but only the first time.
    pub(super) fn told_first(&mut self, vertex: u32) -> Option<f64> {
        let seen = &mut self.vertices[vertex as usize];
        (!std::mem::replace(&mut seen.is_told, true) && seen.is_over()).then_some(seen.height)
    }

    /// The corners of a triangle as they were seen last.
    pub(super) fn corners(&self, number: u32) -> [&SeenVertex; 3] {
        self.triangles[number as usize].map(|vertex| &self.vertices[vertex as usize])
    }

    /// Finds how far the normals at the corners of a triangle are turned that lies over a coarse one.
    pub(super) fn turn(&mut self, frame: &Frame, number: u32) {
        for vertex in self.triangles[number as usize] {
            let seen = &mut self.vertices[vertex as usize];
            if !seen.is_turned {
                let n = self.normals[vertex as usize];
                seen.turn = [n.distance_squared(frame.normal(seen.at)), n.dot(frame.mean_normal)];
                seen.is_turned = true;
            }
        }
    }
}

/// Where fine triangles are counted: somewhere within, where edges seldom are.
const COUNTED_AT: DVec2 = DVec2::new(0.337_109, 0.321_457);

/// Whether a point is in a triangle is not clear where the area that says it is less than this: far more than rounding.
const UNCLEAR: f64 = 1e-9;

/// Whether an edge passes by a coarse triangle, or over no more than its rim.
fn passes_by(from: DVec2, to: DVec2) -> bool {
    let is_beside = |depth: fn(DVec2) -> f64| depth(from).max(depth(to)) <= RIM;
    if is_beside(|at| at.x) || is_beside(|at| at.y) || is_beside(third) {
        return true;
    }
    // All corners on one side of it.
    let edge = to - from;
    let sides = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|corner| edge.perp_dot(corner - from));
    sides.iter().all(|&side| side <= 0.0) || sides.iter().all(|&side| side >= 0.0)
}

/// The same triangle, its least corner first.
fn first_least([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::Vec3;

    use super::*;

    /// Whether fine triangles cover the triangle of the first three of seven vertices once; the last one is at `last`.
    fn covers_once(fine: &[[u32; 3]], last: [f32; 2]) -> bool {
        let places = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], last];
        let positions = places.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        let mesh = Mesh::new(positions, fine.as_flattened().to_vec()).unwrap();
        let numbers = [0, 1, 2, 3, 4, 5, 6];
        let surfaces =
            Surfaces { mesh: &mesh, places: &numbers, coarse: &[[0, 1, 2]], runs: &[], fine, covered: &numbers };
        let (mut surface, _) = FineSurface::new(&surfaces, &mut [u32::MAX; 7]);
        let corners = [0, 1, 2].map(|vertex| surface.positions[vertex]);
        let frame = Frame::new(corners, [DVec3::Z; 3], DVec3::Z).unwrap();
        for number in 0..fine.len() as u32 {
            surface.look_exactly(&frame, 0, number);
        }
        surface.covers_once(0)
    }

    #[test]
    fn what_lacks_overlaps_or_folds_does_not_cover_once() {
        let [a, b, c, middle] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
        let parted = [a, b, c, [3, 4, 6], [4, 5, 6], [5, 3, 6]];
        let within = [0.7, 0.6];
        assert!(covers_once(&[a, b, c, middle], within));
        assert!(covers_once(&parted, within));
        // Also what goes on beyond the triangle.
        assert!(covers_once(&[a, b, c, middle, [1, 6, 4]], [2.0, 2.0]));
        assert!(!covers_once(&[a, b, c], within), "a hole");
        assert!(!covers_once(&[a, b, middle], within), "a part that is not there");
        assert!(!covers_once(&[a, b, c, middle, middle], within), "one twice");
        assert!(!covers_once(&[a, b, c, middle, a, b, c, middle], within), "all twice");
        assert!(!covers_once(&[a, b, c, [3, 5, 4]], within), "one that faces the other way");
        assert!(!covers_once(&parted, [0.2, 0.2]), "a fold");
    }
}

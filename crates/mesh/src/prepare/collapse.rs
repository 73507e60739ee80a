//! Fewer triangles between some of the vertices: vertices collapse onto neighbours, those that lose least first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bevy_math::DVec3;

use super::nearest::nearest_on;
use super::quadric::ErrorQuadric;
use super::triangle_fans::TriangleFans;

/// Vertices with more triangles stay: they are looked at with each of their neighbours.
const MOST_AROUND: usize = 64;

/// A triangle may turn by so much at once, as a cosine.
const TURN: f64 = 0.3;

/// How much of a loss the edge is by which a vertex moves, so that triangles stay round where all is flat. A sphere of
/// radius 1 is off by a sixth of the edge's square.
const EDGE_WEIGHT: f64 = 1e-3;

/// How much of a loss the distance of the vertex that goes from the triangles that stay is.
const GAP_WEIGHT: f64 = 2.0;

/// Triangles and the vertices that they have, numbered among themselves.
#[derive(Default)]
pub(super) struct LocalMesh {
    /// Of each vertex, in a cube from −1 to 1.
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<DVec3>,
    /// Of each vertex, the one whose position it has.
    pub(super) places: Vec<u32>,
    /// Of each vertex, whether its place must stay.
    pub(super) stays: Vec<bool>,
    /// Each between three places.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Triangles that vanish one after the other.
pub(super) struct Collapse {
    /// Its triangles are by vertices; those that are gone are `GONE`.
    mesh: LocalMesh,
    /// Of each place.
    quadrics: Vec<ErrorQuadric>,
    /// Of each triangle, the places of its corners.
    places: Vec<[u32; 3]>,
    fans: TriangleFans,
    alive: usize,
    /// Places by what collapsing them onto their best neighbour loses.
    waiting: BinaryHeap<Reverse<(u32, u32)>>,
    /// Of each place in line, the neighbour onto which it collapses best, if its surroundings have not changed.
    best: Vec<u32>,
    /// For each place, whether its surroundings have changed since it was put in line.
    changed: Vec<bool>,
    /// Whether each place is in line.
    is_waiting: Vec<bool>,
    /// What is around the place that is looked at, here only so that its memory is used again.
    surroundings: Surroundings,
}

/// A normal that changes by so much, as a difference of unit vectors, counts twice, and more than that the cube of it:
/// else a few small parts, cheap by their size, would lose their shading at once.
const SHARP_TURN: f64 = 0.25;

/// The square of the greatest difference between one of three normals and their mean.
fn spread2(normals: [DVec3; 3]) -> f64 {
    let mean = (normals[0] + normals[1] + normals[2]) * (1.0 / 3.0);
    normals.map(|n| n.distance_squared(mean)).into_iter().fold(0.0, f64::max)
}

const GONE: [u32; 3] = [u32::MAX; 3];

/// A corner of a fan.
#[derive(Clone, Copy)]
struct FanCorner {
    /// The triangle's vertex at the fan's place, and the two after it.
    vertices: [u32; 3],
    /// The places of those two.
    places: [u32; 2],
}

impl FanCorner {
    fn has(&self, place: u32) -> bool {
        self.places.contains(&place)
    }
}

/// The side of a fan's triangle across from the fan's place.
struct FanSide {
    corner: FanCorner,
    ends: [DVec3; 2],
    normals: [DVec3; 2],
    /// From the first end to the second, and the square of its length.
    side: DVec3,
    length2: f64,
    /// Across the triangle, as long as twice its area, and what the square of that counts for a turn.
    across: DVec3,
    turn2: f64,
}

/// What is around a place.
#[derive(Default)]
struct Surroundings {
    fan: Vec<FanCorner>,
    /// Of each corner of the fan, where they are asked for.
    sides: Vec<FanSide>,
    /// The neighbours, each once.
    around: Vec<u32>,
    /// What is lost at least by collapsing onto each neighbour.
    targets: Vec<(f64, u32)>,
}

/// Vertices of the place that moves, and those that take their triangles. Most places have one vertex.
#[derive(Default)]
struct Moves {
    first: Option<(u32, u32)>,
    others: Vec<(u32, u32)>,
}

impl Moves {
    fn push(&mut self, from: u32, to: u32) {
        match self.first {
            None => self.first = Some((from, to)),
            Some(_) => self.others.push((from, to)),
        }
    }

    /// The vertex that takes the triangles of this one, if there is one.
    fn target(&self, vertex: u32) -> Option<u32> {
        let (from, to) = self.first?;
        let other = || self.others.iter().find(|(from, _)| *from == vertex).map(|&(_, to)| to);
        if from == vertex { Some(to) } else { other() }
    }
}

/// Which vertex of the target each vertex of the fan's place becomes: the one that it shares an edge with. None if a
/// vertex has none there, or two.
fn moves(target: u32, fan: &[FanCorner]) -> Option<Moves> {
    let mut moves = Moves::default();
    for FanCorner { vertices: [a, b, c], places } in fan {
        let to = match places.map(|place| place == target) {
            [true, _] => *b,
            [_, true] => *c,
            _ => continue,
        };
        match moves.target(*a) {
            None => moves.push(*a, to),
            Some(other) if other != to => return None,
            Some(_) => {}
        }
    }
    fan.iter().all(|corner| moves.target(corner.vertices[0]).is_some()).then_some(moves)
}

impl Collapse {
    pub(super) fn new(mesh: LocalMesh) -> Self {
        let count = mesh.positions.len();
        let of_corners = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.places[vertex as usize]);
        let places: Vec<[u32; 3]> = mesh.triangles.iter().map(of_corners).collect();
        let mut collapse = Self {
            quadrics: vec![ErrorQuadric::NONE; count],
            alive: mesh.triangles.len(),
            mesh,
            fans: TriangleFans::new(&places, count),
            places,
            waiting: BinaryHeap::new(),
            best: vec![u32::MAX; count],
            changed: vec![false; count],
            is_waiting: vec![false; count],
            surroundings: Surroundings::default(),
        };
        collapse.add_quadrics();
        let mut near = Surroundings::default();
        for place in 0..count as u32 {
            collapse.put_in_line(place, &mut near);
        }
        collapse.surroundings = near;
        collapse
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.mesh.triangles.iter().copied().filter(|&triangle| triangle != GONE)
    }

    /// Puts a place in line unless it stays.
    fn put_in_line(&mut self, place: u32, near: &mut Surroundings) {
        if let Some((cost, target)) = self.best(place, near) {
            self.best[place as usize] = target;
            self.is_waiting[place as usize] = true;
            self.waiting.push(Reverse((cost.to_bits(), place)));
        }
    }

    /// Collapses vertices onto others until at most `target` triangles are left or no vertex may collapse any more.
    pub(super) fn reduce_to(&mut self, target: usize) {
        while self.alive > target {
            let Some(Reverse((_, place))) = self.waiting.pop() else { return };
            self.is_waiting[place as usize] = false;
            let has_changed = std::mem::take(&mut self.changed[place as usize]);
            let mut near = std::mem::take(&mut self.surroundings);
            let target = self.best[place as usize];
            if !has_changed && self.may_collapse(place, target, &mut near) {
                self.collapse(place, target, &near);
            } else {
                self.put_in_line(place, &mut near);
            }
            self.surroundings = near;
        }
    }

    fn place(&self, vertex: u32) -> u32 {
        self.mesh.places[vertex as usize]
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.mesh.positions[vertex as usize]
    }

    /// Planes of the triangles, and across them along borders and seams.
    fn add_quadrics(&mut self) {
        for number in 0..self.mesh.triangles.len() {
            let triangle = self.mesh.triangles[number];
            let [a, b, c] = triangle.map(|vertex| self.position(vertex));
            let n = (b - a).cross(c - a);
            let area = 0.5 * n.length();
            let Some(n) = n.try_normalize() else { continue };
            let face = ErrorQuadric::plane(n, a, area);
            for vertex in triangle {
                self.quadrics[self.mesh.places[vertex as usize] as usize] += face;
            }
            for [i, j] in [[0, 1], [1, 2], [2, 0]] {
                let [from, to] = [triangle[i], triangle[j]];
                let is_shared = self.fans.of(self.place(to)).iter().any(|&other| {
                    let [a, b, c] = self.mesh.triangles[other as usize];
                    [[a, b], [b, c], [c, a]].contains(&[to, from])
                });
                if is_shared {
                    continue;
                }
                let side = self.position(to) - self.position(from);
                let across =
                    ErrorQuadric::plane(side.cross(n).normalize_or_zero(), self.position(from), side.length_squared());
                for vertex in [from, to] {
                    self.quadrics[self.mesh.places[vertex as usize] as usize] += across;
                }
            }
        }
    }

    /// The neighbour onto which a place collapses best, and what that loses.
    fn best(&self, place: u32, near: &mut Surroundings) -> Option<(f32, u32)> {
        if self.mesh.stays[place as usize] || self.fans.of(place).len() > MOST_AROUND {
            return None;
        }
        self.look_around(place, near);
        if near.fan.is_empty() {
            return None;
        }
        let p = self.position(place);
        near.sides.clear();
        near.sides.extend(near.fan.iter().map(|corner| self.side(p, corner)));
        let base = |&target: &u32| {
            let q = self.position(target);
            (self.quadrics[place as usize].distance(q) + EDGE_WEIGHT * p.distance_squared(q), target)
        };
        near.targets.clear();
        near.targets.extend(near.around.iter().map(base));
        // Those that promise least first: after them the others can be left sooner.
        near.targets.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<(f64, u32)> = None;
        for &(base, target) in &near.targets {
            let most = best.map_or(f64::INFINITY, |(cost, _)| cost);
            if base >= most {
                break;
            }
            let Some(cost) = self.cost(p, (target, base), near, most) else { continue };
            if self.keeps_topology(target, near) {
                best = Some((cost, target));
            }
        }
        best.map(|(cost, target)| (cost as f32, target))
    }

    /// Finds the fan and the neighbours of a place.
    fn look_around(&self, place: u32, Surroundings { fan, around, .. }: &mut Surroundings) {
        fan.clear();
        around.clear();
        for &number in self.fans.of(place) {
            let ([a, b, c], [i, j, k]) = (self.mesh.triangles[number as usize], self.places[number as usize]);
            let corner = if i == place {
                FanCorner { vertices: [a, b, c], places: [j, k] }
            } else if j == place {
                FanCorner { vertices: [b, c, a], places: [k, i] }
            } else {
                FanCorner { vertices: [c, a, b], places: [i, j] }
            };
            for place in corner.places {
                if !around.contains(&place) {
                    around.push(place);
                }
            }
            fan.push(corner);
        }
    }

    /// The side across from a place at `p`.
    fn side(&self, p: DVec3, &corner: &FanCorner) -> FanSide {
        let [_, b, c] = corner.vertices;
        let ends = [b, c].map(|vertex| self.position(vertex));
        let side = ends[1] - ends[0];
        let across = side.cross(p - ends[0]);
        FanSide {
            corner,
            ends,
            normals: [b, c].map(|vertex| self.normal(vertex)),
            side,
            length2: side.length_squared(),
            across,
            turn2: TURN * TURN * across.length_squared(),
        }
    }

    /// Whether what is best for a place still is where only what is further off than its neighbours has changed.
    fn may_collapse(&self, place: u32, target: u32, near: &mut Surroundings) -> bool {
        self.look_around(place, near);
        self.keeps_topology(target, near)
    }

    /// What collapsing a place at `p` onto a neighbour loses, unless it is no less than `most`, it turns a triangle over
    /// or a seam would tear.
    ///
    /// A length, the sum of: how far the new position is from the planes of the original triangles, in the mean; how
    /// far the old position is from the new triangles, which the mean may hide; the spread of the new triangles'
    /// normals and the change of the normal at the old position (see [`SHARP_TURN`]), both times the longest edge. So
    /// what is small may be cut coarsely, and on a sphere all triangles become alike.
    fn cost(&self, p: DVec3, (target, base): (u32, f64), near: &Surroundings, most: f64) -> Option<f64> {
        let q = self.position(target);
        let moves = moves(target, &near.fan)?;
        let moved = |side: &FanSide| self.normal(moves.target(side.corner.vertices[0]).unwrap_or(target));
        let longest2 = |&FanSide { ends, length2, .. }: &FanSide| {
            length2.max(q.distance_squared(ends[0])).max(q.distance_squared(ends[1]))
        };
        let (mut bulge2, most_bulge2) = (0.0_f64, (most - base).powi(2));
        for side in near.sides.iter().filter(|side| !side.corner.has(target)) {
            let after = side.side.cross(q - side.ends[0]);
            let dot = side.across.dot(after);
            if dot <= 0.0 || dot * dot <= side.turn2 * after.length_squared() {
                return None;
            }
            bulge2 = bulge2.max(spread2([moved(side), side.normals[0], side.normals[1]]) * longest2(side));
            if bulge2 >= most_bulge2 {
                return None;
            }
        }
        let mut nearest: Option<(&FanSide, [f64; 3])> = None;
        let mut gap2 = f64::INFINITY;
        for side in near.sides.iter().filter(|side| !side.corner.has(target)) {
            let (distance2, weights) = nearest_on(p, [q, side.ends[0], side.ends[1]]);
            if distance2 < gap2 {
                (gap2, nearest) = (distance2, Some((side, weights)));
            }
        }
        // An ear, or a piece of one triangle, would be gone.
        let (side, weights) = nearest?;
        let normals = [moved(side), side.normals[0], side.normals[1]];
        let n: DVec3 = normals.into_iter().zip(weights).map(|(n, weight)| weight * n).sum();
        let by = n.distance(self.normal(side.corner.vertices[0]));
        let turn = by * (1.0 + (by / SHARP_TURN).powi(2)) * longest2(side).sqrt();
        let loss = base + bulge2.sqrt() + GAP_WEIGHT * gap2.sqrt() + turn;
        (loss < most).then_some(loss)
    }

    fn normal(&self, vertex: u32) -> DVec3 {
        self.mesh.normals[vertex as usize]
    }

    /// Whether the surface stays one: the neighbours that both ends have are those of the triangles on their edge, one
    /// at a border and else two, and what is on a border moves along it.
    fn keeps_topology(&self, target: u32, Surroundings { fan, around, .. }: &Surroundings) -> bool {
        let on_edge = fan.iter().filter(|corner| corner.has(target)).count();
        let is_closed = around.len() == fan.len();
        let is_open = around.len() == fan.len() + 1;
        if !(is_closed && on_edge == 2 || is_open && on_edge == 1) {
            return false;
        }
        let common = around.iter().filter(|&&other| other != target && self.are_neighbours(other, target)).count();
        common == on_edge
    }

    fn are_neighbours(&self, a: u32, b: u32) -> bool {
        let [few, other] = if self.fans.of(a).len() <= self.fans.of(b).len() { [a, b] } else { [b, a] };
        self.fans.of(few).iter().any(|&number| self.places[number as usize].contains(&other))
    }

    /// Collapses a place onto a neighbour.
    fn collapse(&mut self, place: u32, target: u32, near: &Surroundings) {
        let Some(moves) = moves(target, &near.fan) else { return };
        for &number in self.fans.of(place) {
            let (triangle, places) = (&mut self.mesh.triangles[number as usize], &mut self.places[number as usize]);
            if places.contains(&target) {
                (*triangle, *places) = (GONE, GONE);
                self.alive -= 1;
            } else {
                *triangle = triangle.map(|vertex| moves.target(vertex).unwrap_or(vertex));
                *places = places.map(|other| if other == place { target } else { other });
            }
        }
        let quadric = self.quadrics[place as usize];
        self.quadrics[target as usize] += quadric;
        self.fans.append(place, target);
        for &near in &near.around {
            self.changed[near as usize] = true;
            if !std::mem::replace(&mut self.is_waiting[near as usize], true) {
                self.waiting.push(Reverse((0, near)));
            }
            self.fans.retain(near, |number| self.places[number as usize] != GONE);
        }
    }
}

//! Fewer triangles between some of the vertices: vertices collapse onto neighbours, those that lose least first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bevy_math::DVec3;

use super::nearest::nearest_on;
use super::quadric::ErrorQuadric;

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
    /// The numbers of the triangles around each place; some may be gone.
    fans: Vec<Vec<u32>>,
    alive: usize,
    /// Places by what collapsing them onto their best neighbour loses.
    waiting: BinaryHeap<Reverse<(u32, u32)>>,
    /// Of each place in line, the neighbour onto which it collapses best, if its surroundings have not changed.
    best: Vec<u32>,
    /// For each place, whether its surroundings have changed since it was put in line.
    changed: Vec<bool>,
    /// Whether each place is in line.
    is_waiting: Vec<bool>,
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

/// A corner of a fan: the triangle's vertex at the fan's place, and the two after it.
type FanCorner = [u32; 3];

/// Vertices of the place that moves, and those that take their triangles. Most places have one vertex.
#[derive(Default)]
struct Moves {
    first: Option<(u32, u32)>,
    others: Vec<(u32, u32)>,
}

impl Moves {
    fn iter(&self) -> impl Iterator<Item = (u32, u32)> {
        self.first.into_iter().chain(self.others.iter().copied())
    }

    fn push(&mut self, from: u32, to: u32) {
        match self.first {
            None => self.first = Some((from, to)),
            Some(_) => self.others.push((from, to)),
        }
    }

    /// The vertex that takes the triangles of this one, if there is one.
    fn target(&self, vertex: u32) -> Option<u32> {
        self.iter().find(|(from, _)| *from == vertex).map(|(_, to)| to)
    }
}

impl Collapse {
    pub(super) fn new(mesh: LocalMesh) -> Self {
        let count = mesh.positions.len();
        let mut fans = vec![Vec::new(); count];
        for (number, triangle) in (0..).zip(&mesh.triangles) {
            for &vertex in triangle {
                fans[mesh.places[vertex as usize] as usize].push(number);
            }
        }
        let mut collapse = Self {
            quadrics: vec![ErrorQuadric::NONE; count],
            alive: mesh.triangles.len(),
            mesh,
            fans,
            waiting: BinaryHeap::new(),
            best: vec![u32::MAX; count],
            changed: vec![false; count],
            is_waiting: vec![false; count],
        };
        collapse.add_quadrics();
        for place in 0..count as u32 {
            collapse.put_in_line(place);
        }
        collapse
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.mesh.triangles.iter().copied().filter(|&triangle| triangle != GONE)
    }

    /// Puts a place in line unless it stays.
    fn put_in_line(&mut self, place: u32) {
        if let Some((cost, target)) = self.best(place) {
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
            let target = self.best[place as usize];
            if !has_changed && self.may_collapse(place, target) {
                self.collapse(place, target);
            } else {
                self.put_in_line(place);
            }
        }
    }

    fn place(&self, vertex: u32) -> u32 {
        self.mesh.places[vertex as usize]
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.mesh.positions[vertex as usize]
    }

    /// The corners at a place.
    fn corners(&self, place: u32) -> impl Iterator<Item = FanCorner> + Clone {
        let fan = self.fans[place as usize].iter().map(|&number| self.mesh.triangles[number as usize]);
        fan.filter(|&triangle| triangle != GONE).map(move |[a, b, c]| {
            if self.place(a) == place {
                [a, b, c]
            } else if self.place(b) == place {
                [b, c, a]
            } else {
                [c, a, b]
            }
        })
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
                let is_shared = self.corners(self.place(to)).any(|[v, next, _]| v == to && next == from);
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
    fn best(&self, place: u32) -> Option<(f32, u32)> {
        if self.mesh.stays[place as usize] || self.fans[place as usize].len() > MOST_AROUND {
            return None;
        }
        let fan = self.fan(place);
        if fan.is_empty() {
            return None;
        }
        let around = self.around(&fan);
        let p = self.position(place);
        let base = |&target: &u32| {
            let q = self.position(target);
            (self.quadrics[place as usize].distance(q) + EDGE_WEIGHT * p.distance_squared(q), target)
        };
        let mut targets: Vec<(f64, u32)> = around.iter().map(base).collect();
        // Those that promise least first: after them the others can be left sooner.
        targets.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<(f64, u32)> = None;
        for (base, target) in targets {
            let most = best.map_or(f64::INFINITY, |(cost, _)| cost);
            if base >= most {
                break;
            }
            let Some(cost) = self.cost(place, (target, base), &fan, most) else { continue };
            if self.keeps_topology(target, &fan, &around) {
                best = Some((cost, target));
            }
        }
        best.map(|(cost, target)| (cost as f32, target))
    }

    /// The corners at a place.
    fn fan(&self, place: u32) -> Vec<FanCorner> {
        let mut fan = Vec::with_capacity(self.fans[place as usize].len());
        fan.extend(self.corners(place));
        fan
    }

    /// The neighbours of a place, in order.
    fn around(&self, fan: &[FanCorner]) -> Vec<u32> {
        let mut around = Vec::with_capacity(2 * fan.len());
        around.extend(fan.iter().flat_map(|&[_, b, c]| [self.place(b), self.place(c)]));
        around.sort_unstable();
        around.dedup();
        around
    }

    /// Whether what is best for a place still is where only what is further off than its neighbours has changed.
    fn may_collapse(&self, place: u32, target: u32) -> bool {
        let fan = self.fan(place);
        self.keeps_topology(target, &fan, &self.around(&fan))
    }

    /// What collapsing a place onto a neighbour loses, unless it is no less than `most`, it turns a triangle over or a
    /// seam would tear.
    ///
    /// A length, the sum of: how far the new position is from the planes of the original triangles, in the mean; how
    /// far the old position is from the new triangles, which the mean may hide; the spread of the new triangles'
    /// normals and the change of the normal at the old position (see [`SHARP_TURN`]), both times the longest edge. So
    /// what is small may be cut coarsely, and on a sphere all triangles become alike.
    fn cost(&self, place: u32, (target, base): (u32, f64), fan: &[FanCorner], most: f64) -> Option<f64> {
        let (p, q) = (self.position(place), self.position(target));
        let moves = self.moves(target, fan)?;
        let stays = |&&[_, b, c]: &&FanCorner| self.place(b) != target && self.place(c) != target;
        let (mut bulge2, most_bulge2) = (0.0_f64, (most - base).powi(2));
        for &[a, b, c] in fan.iter().filter(stays) {
            let [p_b, p_c] = [b, c].map(|vertex| self.position(vertex));
            let side = p_c - p_b;
            let (before, after) = (side.cross(p - p_b), side.cross(q - p_b));
            let dot = before.dot(after);
            if dot <= 0.0 || dot * dot <= TURN * TURN * before.length_squared() * after.length_squared() {
                return None;
            }
            let normals = [moves.target(a).unwrap_or(a), b, c].map(|vertex| self.normal(vertex));
            let longest2 = side.length_squared().max(q.distance_squared(p_b)).max(q.distance_squared(p_c));
            bulge2 = bulge2.max(spread2(normals) * longest2);
            if bulge2 >= most_bulge2 {
                return None;
            }
        }
        let (mut gap2, mut turn) = (f64::INFINITY, 0.0);
        for &[a, b, c] in fan.iter().filter(stays) {
            let [p_b, p_c] = [b, c].map(|vertex| self.position(vertex));
            let (distance2, weights) = nearest_on(p, [q, p_b, p_c]);
            if distance2 < gap2 {
                let normals = [moves.target(a).unwrap_or(a), b, c].map(|vertex| self.normal(vertex));
                let n: DVec3 = normals.into_iter().zip(weights).map(|(n, weight)| weight * n).sum();
                let longest2 = p_b.distance_squared(p_c).max(q.distance_squared(p_b)).max(q.distance_squared(p_c));
                let by = n.distance(self.normal(a));
                (gap2, turn) = (distance2, by * (1.0 + (by / SHARP_TURN).powi(2)) * longest2.sqrt());
            }
        }
        // An ear, or a piece of one triangle, would be gone.
        if gap2.is_infinite() {
            return None;
        }
        let loss = base + bulge2.sqrt() + GAP_WEIGHT * gap2.sqrt() + turn;
        (loss < most).then_some(loss)
    }

    fn normal(&self, vertex: u32) -> DVec3 {
        self.mesh.normals[vertex as usize]
    }

    /// Which vertex of the target each vertex of the fan's place becomes: the one that it shares an edge with. None if
    /// a vertex has none there, or two.
    fn moves(&self, target: u32, fan: &[FanCorner]) -> Option<Moves> {
        let mut moves = Moves::default();
        for &[a, b, c] in fan {
            for to in [b, c].into_iter().filter(|&vertex| self.place(vertex) == target) {
                match moves.target(a) {
                    None => moves.push(a, to),
                    Some(other) if other != to => return None,
                    Some(_) => {}
                }
            }
        }
        fan.iter().all(|&[a, ..]| moves.target(a).is_some()).then_some(moves)
    }

    /// Whether the surface stays one: the neighbours that both ends have are those of the triangles on their edge, one
    /// at a border and else two, and what is on a border moves along it.
    fn keeps_topology(&self, target: u32, fan: &[FanCorner], around: &[u32]) -> bool {
        let on_edge = fan.iter().filter(|&&[_, b, c]| self.place(b) == target || self.place(c) == target).count();
        let is_closed = around.len() == fan.len();
        let is_open = around.len() == fan.len() + 1;
        if !(is_closed && on_edge == 2 || is_open && on_edge == 1) {
            return false;
        }
        let common = around.iter().filter(|&&other| other != target && self.are_neighbours(other, target)).count();
        common == on_edge
    }

    fn are_neighbours(&self, a: u32, b: u32) -> bool {
        let [few, other] = if self.fans[a as usize].len() <= self.fans[b as usize].len() { [a, b] } else { [b, a] };
        self.corners(few).any(|[_, x, y]| self.place(x) == other || self.place(y) == other)
    }

    /// Collapses a place onto a neighbour.
    fn collapse(&mut self, place: u32, target: u32) {
        let fan = self.fan(place);
        let Some(moves) = self.moves(target, &fan) else { return };
        let numbers = std::mem::take(&mut self.fans[place as usize]);
        for number in numbers {
            let triangle = self.mesh.triangles[number as usize];
            if triangle == GONE {
                continue;
            }
            if triangle.iter().any(|&vertex| self.place(vertex) == target) {
                self.mesh.triangles[number as usize] = GONE;
                self.alive -= 1;
            } else {
                self.mesh.triangles[number as usize] = triangle.map(|vertex| moves.target(vertex).unwrap_or(vertex));
                self.fans[target as usize].push(number);
            }
        }
        let quadric = self.quadrics[place as usize];
        self.quadrics[target as usize] += quadric;
        let triangles = &self.mesh.triangles;
        self.fans[target as usize].retain(|&number| triangles[number as usize] != GONE);
        for &[_, b, c] in &fan {
            for vertex in [b, c] {
                let near = self.place(vertex) as usize;
                self.changed[near] = true;
                if !std::mem::replace(&mut self.is_waiting[near], true) {
                    self.waiting.push(Reverse((0, near as u32)));
                }
                let triangles = &self.mesh.triangles;
                self.fans[near].retain(|&number| triangles[number as usize] != GONE);
            }
        }
    }
}

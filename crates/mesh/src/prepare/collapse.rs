//! Fewer triangles between some of the vertices: vertices are drawn onto neighbours, the least loss first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bevy_math::{DVec3, Vec3};
use rayon::prelude::*;

use super::deviation::nearest_on;
use super::quadric::Quadric;
use super::stand_ins::StandIns;
use crate::Mesh;

/// Vertices with more triangles stay: they are looked at with each of their neighbours.
const MOST_AROUND: usize = 64;

/// A triangle may turn by so much at once, as a cosine.
const TURN: f64 = 0.3;

/// How much of a loss the edge is by which a vertex moves, so that triangles stay round where all is flat. A sphere of
/// radius 1 is off by a sixth of the edge's square.
const EDGE_WEIGHT: f64 = 1e-3;

/// How much of a loss the distance of the vertex that goes from the triangles that stay is.
const GAP_WEIGHT: f64 = 2.0;

/// Triangles that vanish one after the other.
pub(super) struct Collapse<'a> {
    places: &'a [u32],
    /// Of each vertex, in a cube from −1 to 1.
    positions: Vec<DVec3>,
    normals: &'a [Vec3],
    /// Of each place.
    quadrics: Vec<Quadric>,
    /// By vertices; those that are gone are `GONE`.
    triangles: Vec<[u32; 3]>,
    /// The numbers of the triangles around each place; some may be gone.
    fans: Vec<Vec<u32>>,
    alive: usize,
    /// Places by what drawing them onto their best neighbour loses.
    waiting: BinaryHeap<Reverse<(u32, u32)>>,
    /// For each place, whether its surroundings have changed since it was put in line.
    changed: Vec<bool>,
    /// Whether each place is in line.
    is_waiting: Vec<bool>,
}

/// The greatest difference between one of three normals and their mean.
fn spread(normals: [DVec3; 3]) -> f64 {
    let mean = (normals[0] + normals[1] + normals[2]) / 3.0;
    normals.map(|n| n.distance_squared(mean)).into_iter().fold(0.0, f64::max).sqrt()
}

const GONE: [u32; 3] = [u32::MAX; 3];

/// A corner of a fan: the triangle's vertex at the fan's place, and the two after it.
type Corner = [u32; 3];

/// Vertices of the place that moves, and those that take their triangles.
type Moves = Vec<(u32, u32)>;

/// The vertex that takes the triangles of another, itself if none does.
fn moved(vertex: u32, moves: &[(u32, u32)]) -> u32 {
    moves.iter().find(|(from, _)| *from == vertex).map_or(vertex, |(_, to)| *to)
}

impl<'a> Collapse<'a> {
    pub(super) fn new(mesh: &'a Mesh, stand_ins: &'a StandIns) -> Self {
        let triangles = stand_ins.triangles(mesh);
        let (min, max) = (mesh.bounds().min.as_dvec3(), mesh.bounds().max.as_dvec3());
        let (center, unit) = (0.5 * (min + max), (0.5 * (max - min)).max_element());
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let position = |&place: &u32| (mesh.positions()[place as usize].as_dvec3() - center) / unit;
        let positions: Vec<DVec3> = stand_ins.places.iter().map(position).collect();
        let mut fans = vec![Vec::new(); positions.len()];
        for (number, triangle) in (0..).zip(&triangles) {
            for &vertex in triangle {
                fans[stand_ins.places[vertex as usize] as usize].push(number);
            }
        }
        let mut collapse = Self {
            places: &stand_ins.places,
            quadrics: vec![Quadric::NONE; positions.len()],
            positions,
            normals: mesh.normals(),
            alive: triangles.len(),
            triangles,
            fans,
            waiting: BinaryHeap::new(),
            changed: vec![false; stand_ins.places.len()],
            is_waiting: vec![true; stand_ins.places.len()],
        };
        collapse.add_quadrics();
        let first = (0..collapse.fans.len() as u32).into_par_iter();
        let first = first.map(|place| collapse.best(place).map(|(cost, _)| Reverse((cost.to_bits(), place))));
        let first: Vec<_> = first.collect();
        collapse.is_waiting = first.iter().map(Option::is_some).collect();
        collapse.waiting = first.into_iter().flatten().collect();
        collapse
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.alive
    }

    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.triangles.iter().copied().filter(|&triangle| triangle != GONE).collect()
    }

    /// Draws vertices onto others until no more than so many triangles are left or nothing may be drawn any more.
    pub(super) fn reduce_to(&mut self, target: usize) {
        while self.alive > target {
            let Some(Reverse((_, place))) = self.waiting.pop() else { return };
            self.is_waiting[place as usize] = false;
            let Some((cost, target)) = self.best(place) else { continue };
            if std::mem::take(&mut self.changed[place as usize]) {
                self.is_waiting[place as usize] = true;
                self.waiting.push(Reverse((cost.to_bits(), place)));
            } else {
                self.draw(place, target);
            }
        }
    }

    fn place(&self, vertex: u32) -> u32 {
        self.places[vertex as usize]
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// The corners at a place.
    fn corners(&self, place: u32) -> impl Iterator<Item = Corner> + Clone {
        let fan = self.fans[place as usize].iter().map(|&number| self.triangles[number as usize]);
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
        for number in 0..self.triangles.len() {
            let triangle = self.triangles[number];
            let [a, b, c] = triangle.map(|vertex| self.position(vertex));
            let n = (b - a).cross(c - a);
            let area = 0.5 * n.length();
            let Some(n) = n.try_normalize() else { continue };
            let face = Quadric::plane(n, a, area);
            for vertex in triangle {
                self.quadrics[self.places[vertex as usize] as usize] += face;
            }
            for [i, j] in [[0, 1], [1, 2], [2, 0]] {
                let [from, to] = [triangle[i], triangle[j]];
                let is_shared = self.corners(self.place(to)).any(|[v, next, _]| v == to && next == from);
                if is_shared {
                    continue;
                }
                let side = self.position(to) - self.position(from);
                let across =
                    Quadric::plane(side.cross(n).normalize_or_zero(), self.position(from), side.length_squared());
                for vertex in [from, to] {
                    self.quadrics[self.places[vertex as usize] as usize] += across;
                }
            }
        }
    }

    /// The neighbour onto which a place is best drawn, and what that loses.
    fn best(&self, place: u32) -> Option<(f32, u32)> {
        if self.fans[place as usize].len() > MOST_AROUND {
            return None;
        }
        let fan: Vec<Corner> = self.corners(place).collect();
        if fan.is_empty() || fan.len() > MOST_AROUND {
            return None;
        }
        let mut around: Vec<u32> = fan.iter().flat_map(|&[_, b, c]| [self.place(b), self.place(c)]).collect();
        around.sort_unstable();
        around.dedup();
        let mut best: Option<(f64, u32)> = None;
        for &target in &around {
            let most = best.map_or(f64::INFINITY, |(cost, _)| cost);
            let Some(cost) = self.cost(place, target, &fan, most) else { continue };
            if cost < most && self.keeps_topology(target, &fan, &around) {
                best = Some((cost, target));
            }
        }
        best.map(|(cost, target)| (cost as f32, target))
    }

    /// What drawing a place onto a neighbour loses, unless it is no less than `most`, it turns a triangle over or a seam
    /// would tear.
    ///
    /// A length, the sum of: how far the new position is from the planes of the original triangles, in the mean; how far
    /// the old position is from the new triangles, which the mean may hide; the spread of the new triangles' normals and
    /// the change of the normal at the old position, both times the longest edge. So what is small may be cut coarsely,
    /// and on a sphere all triangles become alike.
    fn cost(&self, place: u32, target: u32, fan: &[Corner], most: f64) -> Option<f64> {
        let (p, q) = (self.position(place), self.position(target));
        let base = self.quadrics[place as usize].distance(q) + EDGE_WEIGHT * p.distance_squared(q);
        if base >= most {
            return None;
        }
        let moves = self.moves(target, fan)?;
        let (mut bulge, mut gap) = (0.0_f64, (f64::INFINITY, 0.0));
        for &[a, b, c] in fan {
            if self.place(b) == target || self.place(c) == target {
                continue;
            }
            let [p_b, p_c] = [b, c].map(|vertex| self.position(vertex));
            let side = p_c - p_b;
            let (before, after) = (side.cross(p - p_b), side.cross(q - p_b));
            if before.dot(after) <= TURN * (before.length_squared() * after.length_squared()).sqrt() {
                return None;
            }
            let normals = [moved(a, &moves), b, c].map(|vertex| self.normals[vertex as usize].as_dvec3());
            let longest = side.length_squared().max(q.distance_squared(p_b)).max(q.distance_squared(p_c)).sqrt();
            bulge = bulge.max(spread(normals) * longest);
            if base + bulge >= most {
                return None;
            }
            let (gap2, [w_a, w_b, w_c]) = nearest_on(p, [q, p_b, p_c]);
            if gap2 < gap.0 {
                let n = w_a * normals[0] + w_b * normals[1] + w_c * normals[2];
                gap = (gap2, n.distance(self.normals[a as usize].as_dvec3()) * longest);
            }
        }
        // An ear, or a piece of one triangle, would be gone.
        if gap.0.is_infinite() {
            return None;
        }
        let loss = base + bulge + GAP_WEIGHT * gap.0.sqrt() + gap.1;
        (loss < most).then_some(loss)
    }

    /// Which vertex of the target each vertex of the fan's place becomes: the one that it shares an edge with. None if a
    /// vertex has none there, or two.
    fn moves(&self, target: u32, fan: &[Corner]) -> Option<Moves> {
        let mut moves = Moves::with_capacity(2);
        for &[a, b, c] in fan {
            for to in [b, c].into_iter().filter(|&vertex| self.place(vertex) == target) {
                match moves.iter().find(|(from, _)| *from == a) {
                    None => moves.push((a, to)),
                    Some(&(_, other)) if other != to => return None,
                    Some(_) => {}
                }
            }
        }
        let moves_on = |vertex: u32| moves.iter().any(|(from, _)| *from == vertex);
        fan.iter().all(|&[a, ..]| moves_on(a)).then_some(moves)
    }

    /// Whether the surface stays one: the neighbours that both ends have are those of the triangles on their edge, one at
    /// a border and else two, and what is on a border moves along it.
    fn keeps_topology(&self, target: u32, fan: &[Corner], around: &[u32]) -> bool {
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

    /// Draws a place onto a neighbour.
    fn draw(&mut self, place: u32, target: u32) {
        let fan: Vec<Corner> = self.corners(place).collect();
        let Some(moves) = self.moves(target, &fan) else { return };
        let numbers = std::mem::take(&mut self.fans[place as usize]);
        for number in numbers {
            let triangle = self.triangles[number as usize];
            if triangle == GONE {
                continue;
            }
            if triangle.iter().any(|&vertex| self.place(vertex) == target) {
                self.triangles[number as usize] = GONE;
                self.alive -= 1;
            } else {
                self.triangles[number as usize] = triangle.map(|vertex| moved(vertex, &moves));
                self.fans[target as usize].push(number);
            }
        }
        let quadric = self.quadrics[place as usize];
        self.quadrics[target as usize] += quadric;
        let triangles = &self.triangles;
        self.fans[target as usize].retain(|&number| triangles[number as usize] != GONE);
        for &[_, b, c] in &fan {
            for vertex in [b, c] {
                let near = self.place(vertex) as usize;
                self.changed[near] = true;
                if !std::mem::replace(&mut self.is_waiting[near], true) {
                    self.waiting.push(Reverse((0, near as u32)));
                }
                let triangles = &self.triangles;
                self.fans[near].retain(|&number| triangles[number as usize] != GONE);
            }
        }
    }
}

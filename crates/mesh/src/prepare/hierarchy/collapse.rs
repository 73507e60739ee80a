//! Fewer triangles between some of the vertices: vertices collapse onto neighbours, those that lose least first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bevy_math::{DVec3, Vec3};

use super::edge_twins::{NO_TWIN, edge_twins};
use super::quadric::ErrorQuadric;
use super::roughness::{least_spread, roughness};
use super::triangle_fans::TriangleFans;
use super::vicinity::{MOST_AROUND, Vicinity};

/// Triangles and the vertices that they have, numbered among themselves.
#[derive(Default)]
pub(super) struct LocalMesh {
    /// Of each vertex, in a cube from −1 to 1.
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<Vec3>,
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
    /// Of each place in line, the neighbour onto which it collapses best, if its vicinity has not changed.
    best: Vec<u32>,
    /// For each place, whether its vicinity has changed since it was put in line.
    changed: Vec<bool>,
    /// Whether each place is in line.
    is_waiting: Vec<bool>,
    /// What is around the place that is looked at, here only so that its memory is used again.
    vicinity: Vicinity,
    /// How rough the mesh was before anything collapsed.
    pub(super) roughness: f32,
}

const GONE: [u32; 3] = [u32::MAX; 3];

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
            vicinity: Vicinity::default(),
            roughness: 0.0,
        };
        collapse.add_quadrics();
        collapse.roughness = roughness(&collapse.mesh.triangles, &collapse.mesh.normals);
        let mut near = Vicinity::new(count, least_spread(collapse.roughness));
        for place in 0..count as u32 {
            collapse.put_in_line(place, &mut near);
        }
        collapse.vicinity = near;
        collapse
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.mesh.triangles.iter().copied().filter(|&triangle| triangle != GONE)
    }

    /// Puts a place in line unless it stays.
    fn put_in_line(&mut self, place: u32, near: &mut Vicinity) {
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
            let mut near = std::mem::take(&mut self.vicinity);
            let target = if has_changed { None } else { self.still_best(place, &mut near) };
            match target {
                Some(target) => self.collapse(place, target, &near),
                None => self.put_in_line(place, &mut near),
            }
            self.vicinity = near;
        }
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.mesh.positions[vertex as usize]
    }

    /// Planes of the triangles, and across them along borders and seams.
    fn add_quadrics(&mut self) {
        let twins = edge_twins(&self.mesh.triangles, self.mesh.positions.len());
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
            for edge in 0..3 {
                if twins[3 * number + edge] != NO_TWIN {
                    continue;
                }
                let [from, to] = [triangle[edge], triangle[(edge + 1) % 3]];
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
    fn best(&self, place: u32, near: &mut Vicinity) -> Option<(f32, u32)> {
        if self.mesh.stays[place as usize] || self.fans.of(place).len() > MOST_AROUND {
            return None;
        }
        self.look_around(place, near);
        if near.triangles() == 0 {
            return None;
        }
        let p = self.position(place);
        near.measure(p, &self.mesh.positions, &self.mesh.normals);
        let quadric = &self.quadrics[place as usize];
        near.order_targets(&self.mesh.normals, |place| quadric.distance(self.position(place)));
        let mut best: Option<(f64, u32)> = None;
        for &(_, target) in &near.targets {
            let target = usize::from(target);
            let most = best.map_or(f64::INFINITY, |(loss, _)| loss);
            let Some(loss) = near.loss(target, most, &self.mesh.normals) else { continue };
            if self.keeps_topology(target, near) {
                best = Some((loss, near.around[target].place));
            }
        }
        best.map(|(loss, target)| (loss as f32, target))
    }

    /// Finds the fan and the neighbours of a place.
    fn look_around(&self, place: u32, near: &mut Vicinity) {
        near.clear();
        for &number in self.fans.of(place) {
            let ([a, b, c], [i, j, k]) = (self.mesh.triangles[number as usize], self.places[number as usize]);
            if i == place {
                near.add([a, b, c], [j, k]);
            } else if j == place {
                near.add([b, c, a], [k, i]);
            } else {
                near.add([c, a, b], [i, j]);
            }
        }
    }

    /// The number of the neighbour that was best for a place, if it still is where only what is further off than the
    /// neighbours has changed.
    fn still_best(&self, place: u32, near: &mut Vicinity) -> Option<usize> {
        self.look_around(place, near);
        let target = near.number(self.best[place as usize])?;
        self.keeps_topology(target, near).then_some(target)
    }

    /// Whether the surface stays one: the neighbours that both ends have are those of the triangles on their edge, one
    /// at a border and else two, and what is on a border moves along it.
    fn keeps_topology(&self, target: usize, near: &Vicinity) -> bool {
        let (around, on_edge) = (&near.around, near.around[target].triangles);
        let is_closed = around.len() == near.triangles();
        let is_open = around.len() == near.triangles() + 1;
        if !(is_closed && on_edge == 2 || is_open && on_edge == 1) {
            return false;
        }
        // Of each neighbour that both have a bit.
        let mut common = 0_u128;
        for &number in self.fans.of(around[target].place) {
            for place in self.places[number as usize] {
                common |= near.number(place).map_or(0, |number| 1 << number);
            }
        }
        (common & !(1 << target)).count_ones() == on_edge
    }

    /// Collapses a place onto a neighbour.
    fn collapse(&mut self, place: u32, target: usize, near: &Vicinity) {
        let Some(moves) = near.moves(target) else { return };
        let target = near.around[target].place;
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
        for near in near.around.iter().map(|neighbour| neighbour.place) {
            self.changed[near as usize] = true;
            if !std::mem::replace(&mut self.is_waiting[near as usize], true) {
                self.waiting.push(Reverse((0, near)));
            }
            self.fans.retain(near, |number| self.places[number as usize] != GONE);
        }
    }
}

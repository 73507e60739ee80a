//! Simplification by edge collapses, the cheapest first.
//!
//! A vertex collapses onto a neighbour, so a simplified mesh uses vertices of the original only. The cost of a collapse
//! is the mean squared distance from the planes of the triangles around the vertex (Garland and Heckbert 1997, "Surface
//! simplification using quadric error metrics"), plus the mean squared deviation of its attributes from what these
//! triangles interpolate (Hoppe 1999, "New quadric metric for simplifying meshes with appearance attributes"). All are
//! lengths: attributes are converted.
//!
//! A *place* is a position, a *wedge* (Hoppe's word) a vertex there: seams and creases have several wedges at a place.
//! They move together and only along the seam, so that it stays closed.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::weld::places;
use crate::numbering::Numbering;
use crate::{Bounds, Mesh};

/// The weight of the squared distance that a vertex moves. It decides where little else does, as in planes, and keeps
/// triangles well shaped there. Values up to a tenth change no picture.
const MOVE_WEIGHT: f64 = 1e-3;

/// The weight of the squared distance that texture coordinates slide. It is low because those of round surfaces slide
/// everywhere, which would keep vertices where the shape does not need them: with 1, a sphere of 200 triangles has
/// twice the error.
const MAP_WEIGHT: f64 = 0.05;

/// A collapse may rotate the normal of a triangle by at most the angle of this cosine.
const LEAST_COSINE: f64 = 0.2;

/// The length that a change of a normal by 1 (the difference of unit vectors) counts as, in edges of the simplified
/// mesh. Found by trial: with 1 to 30, pictures of scans with half of their triangles are equally good; less is worse,
/// and more spoils the shape if few triangles are left.
const ATTRIBUTE_WEIGHT: f64 = 2.0;

/// The least change of a normal that is visible: about two steps of 1/255 in a highlight of exponent 32.
const VISIBLE: f64 = 0.007;

/// The shading error, in edges, where the change of normals is visible: of smooth surfaces, and of noise. Found by
/// trial: with a shading error of one pixel, scans of 9 to 200 front triangles a pixel keep a half to a twentieth of
/// them, and the RMS error of one sample a pixel from the average over the pixel grows by up to 15 %.
const EDGE_WEIGHT: [f64; 2] = [0.48, 0.75];

/// Normals and colours are noise if collapses lose this fraction of their difference along an edge, or more. The bunny
/// loses a sixth to a third, a mesh with a random number at each vertex a half to all.
const NOISE: f64 = 0.4;

/// A vertex with more triangles than this stays, such as the pole of a fine sphere: the time that it takes grows with
/// their square.
const MOST_AROUND: usize = 96;

/// Attributes are weighted as if no less than one triangle in this many were left.
const MOST_REDUCTION: usize = 16;

/// Triangles with an area below this fraction of the square of their longest side do not count for attributes: their
/// gradients are rounding errors.
const NEEDLE: f64 = 1e-4;

/// Distances below this fraction of the extent of the triangles are rounding errors.
const ROUNDING: f64 = 1e-6;

/// Groups the vertices of a mesh that the simplifier treats as one.
pub(super) struct Wedges {
    /// The first vertex at the position of each vertex.
    pub(super) places: Vec<u32>,
    /// The first vertex that is equal to each vertex in all attributes; empty if all differ.
    equals: Vec<u32>,
}

impl Wedges {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let places = places(mesh.positions(), 0.0);
        let equals = if (0..).zip(&places).all(|(vertex, &place)| vertex == place) {
            Vec::new()
        } else {
            let vertices = mesh.identical_vertices(&places);
            vertices.numbers.iter().map(|&number| vertices.firsts[number as usize]).collect()
        };
        Self { places, equals }
    }

    fn wedge(&self, vertex: u32) -> u32 {
        self.equals.get(vertex as usize).copied().unwrap_or(vertex)
    }
}

/// A weighted sum of squares of linear functions of a point: pᵀ`a`p + 2`b`·p + `c`.
#[derive(Clone, Copy, Debug, Default)]
struct Quadric {
    weight: f64,
    /// The upper triangle of the matrix, row by row.
    a: [f64; 6],
    b: DVec3,
    c: f64,
}

impl Quadric {
    /// Adds the square of g·p + d. The weight stays as it is.
    fn add_square(&mut self, g: DVec3, d: f64, weight: f64) {
        let h = g * weight;
        let squares = [h.x * g.x, h.x * g.y, h.x * g.z, h.y * g.y, h.y * g.z, h.z * g.z];
        for (sum, square) in self.a.iter_mut().zip(squares) {
            *sum += square;
        }
        self.b += h * d;
        self.c += weight * d * d;
    }

    fn add(&mut self, other: &Self) {
        self.weight += other.weight;
        for (sum, term) in self.a.iter_mut().zip(other.a) {
            *sum += term;
        }
        self.b += other.b;
        self.c += other.c;
    }

    fn sum(&self, p: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let ap =
            DVec3::new(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z);
        p.dot(ap) + 2.0 * self.b.dot(p) + self.c
    }

    /// The weighted mean; 0 of nothing. Rounding may have made the sum negative.
    fn mean(&self, sum: f64) -> f64 {
        if self.weight > 0.0 { sum.max(0.0) / self.weight } else { 0.0 }
    }
}

/// Some attributes of the wedges, as lengths, and quadrics of their deviations.
///
/// In the plane of a triangle an attribute is g·p + d at a point p. Over the triangles around a wedge, weighted by
/// their areas w, the squared deviations of a value s from that add up to s²·Σw − 2s·(p·Σw·g + Σw·d) + Σw·(g·p + d)²;
/// the last term is a quadric.
#[derive(Default)]
struct Attributes {
    /// The number of attributes of a wedge.
    count: usize,
    /// For each wedge, one after the other.
    values: Vec<f64>,
    /// Σw·g and Σw·d of each value.
    gradients: Vec<(DVec3, f64)>,
    /// For each wedge, the sum over its attributes; none if there are no attributes.
    quadrics: Vec<Quadric>,
}

impl Attributes {
    /// `values` are divided evenly among the wedges.
    fn new(values: Vec<f64>, wedges: usize) -> Self {
        let count = values.len() / wedges.max(1);
        let gradients = vec![(DVec3::ZERO, 0.0); values.len()];
        let quadrics = vec![Quadric::default(); if count > 0 { wedges } else { 0 }];
        Self { count, values, gradients, quadrics }
    }

    /// Adds a triangle, by its wedges, its first corner, its sides from there, its unit normal and its area.
    fn add_triangle(&mut self, wedges: [usize; 3], a: DVec3, sides: [DVec3; 2], n: DVec3, area: f64) {
        if self.count == 0 {
            return;
        }
        // Along the sides Δs = g·Δp.
        let dual = [sides[1].cross(n), n.cross(sides[0])].map(|side| side / (2.0 * area));
        let mut quadric = Quadric { weight: area, ..Quadric::default() };
        for k in 0..self.count {
            let [s, t, u] = wedges.map(|wedge| self.values[wedge * self.count + k]);
            let g = dual[0] * (t - s) + dual[1] * (u - s);
            let d = s - g.dot(a);
            quadric.add_square(g, d, area);
            for wedge in wedges {
                let sum = &mut self.gradients[wedge * self.count + k];
                *sum = (sum.0 + g * area, sum.1 + d * area);
            }
        }
        for wedge in wedges {
            self.quadrics[wedge].add(&quadric);
        }
    }

    /// The mean squared deviation if a wedge collapses onto another, at p.
    fn deviation(&self, from: usize, to: usize, p: DVec3) -> f64 {
        let Some(quadric) = self.quadrics.get(from) else { return 0.0 };
        let values = &self.values[to * self.count..(to + 1) * self.count];
        let terms = values.iter().zip(&self.gradients[from * self.count..]);
        let sum: f64 = terms.map(|(s, (g, d))| s * (s * quadric.weight - 2.0 * (g.dot(p) + d))).sum();
        quadric.mean(quadric.sum(p) + sum)
    }

    /// The squared difference of the values of two wedges.
    fn difference2(&self, wedges: [u32; 2]) -> f64 {
        let [a, b] = wedges.map(|wedge| &self.values[wedge as usize * self.count..][..self.count]);
        a.iter().zip(b).map(|(s, t)| (s - t) * (s - t)).sum()
    }

    /// Adds the sums of a wedge to those of another.
    fn join(&mut self, from: usize, to: usize) {
        if let Some(&quadric) = self.quadrics.get(from) {
            self.quadrics[to].add(&quadric);
        }
        for k in 0..self.count {
            let (g, d) = self.gradients[from * self.count + k];
            let sum = &mut self.gradients[to * self.count + k];
            *sum = (sum.0 + g, sum.1 + d);
        }
    }
}

/// The edges along which a place may collapse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Freedom {
    /// None: it stays.
    None,
    /// Edges of the open border that it is on.
    Border,
    /// All: it is surrounded by triangles.
    Any,
}

const GONE: u32 = u32::MAX;

/// A collapse in the queue: the bits of its cost, the place that is removed, its target, and the version of the first.
type Candidate = Reverse<(u32, u32, u32, u32)>;

/// Some triangles of a mesh while edges collapse. Lengths are divided by the [`unit`](Self::unit).
pub(super) struct Simplifier {
    /// Half the longest edge of the box around the triangles, in units of the mesh.
    unit: f64,
    /// The length that a change of a normal by 1 counts as.
    shade: f64,
    /// The number of triangles that are left.
    alive: usize,
    /// The vertex of the mesh, and the place, for each wedge.
    vertices: Vec<u32>,
    place_of: Vec<u32>,
    /// For each place, like the next three.
    positions: Vec<DVec3>,
    freedom: Vec<Freedom>,
    planes: Vec<Quadric>,
    /// How often the quadrics have changed; [`GONE`] after the place has collapsed.
    versions: Vec<u32>,
    /// Normals and colours.
    shading: Attributes,
    /// Texture coordinates.
    maps: Attributes,
    /// The wedge at each corner; [`GONE`] at those of triangles that have vanished.
    corners: Vec<u32>,
    /// A corner at each place, and after each corner the next at the same place.
    first: Vec<u32>,
    next: Vec<u32>,
    queue: BinaryHeap<Candidate>,
    /// Scratch memory. The marked places have the last token.
    marks: [Vec<u32>; 2],
    token: u32,
    /// The wedges that a collapse removes, each with the one that takes its place.
    moves: Vec<[u32; 2]>,
    around: Vec<u32>,
}

/// The result of a [`Simplifier`].
pub(super) struct Simplified {
    /// By vertices of the mesh.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The largest of all collapses, in units of the mesh: the RMS distance of the vertex from the planes around it.
    pub(super) position_error: f64,
    /// The mean edge, in units of the mesh, times its [weight](EDGE_WEIGHT), and times the largest change of normals
    /// and colours where that is not [`VISIBLE`].
    pub(super) shading_error: f64,
    /// The largest distance that texture coordinates slide over the surface, in units of the mesh.
    pub(super) map_error: f64,
}

/// The mean squared deviations of a collapse.
#[derive(Clone, Copy, Default)]
struct Cost {
    position: f64,
    shading: f64,
    map: f64,
}

impl Cost {
    /// The weighted sum, as a number of the same order; `moved` is the squared distance between the places.
    fn bits(self, moved: f64) -> u32 {
        ((self.position + self.shading + MAP_WEIGHT * self.map + MOVE_WEIGHT * moved) as f32).to_bits()
    }

    fn max(self, other: Self) -> Self {
        Self {
            position: self.position.max(other.position),
            shading: self.shading.max(other.shading),
            map: self.map.max(other.map),
        }
    }
}

impl Simplifier {
    /// Takes triangles of a mesh, of which about `target` are to be left. Places stay if `is_locked` is true for their
    /// first vertex, if they are on an open border and `keeps_borders`, or if the triangles there form no surface.
    pub(super) fn new(
        mesh: &Mesh,
        wedges: &Wedges,
        triangles: &[[u32; 3]],
        target: usize,
        keeps_borders: bool,
        is_locked: impl Fn(u32) -> bool,
    ) -> Self {
        let place = |vertex: &u32| wedges.places[*vertex as usize];
        let has_three_places = |triangle: &&[u32; 3]| {
            let [a, b, c] = triangle.each_ref().map(place);
            a != b && b != c && c != a
        };
        let triangles = triangles.iter().filter(has_three_places);
        let (vertices, corners) = numbered(triangles.flatten().map(|&vertex| wedges.wedge(vertex)).collect());
        let (places, place_of) = numbered(vertices.iter().map(place).collect());
        let positions = || places.iter().map(|&vertex| mesh.positions()[vertex as usize]);
        let bounds = Bounds::from_points(positions()).unwrap_or(mesh.bounds());
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let center = 0.5 * (min + max);
        let unit = (0.5 * (max - min)).max_element();
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let mut simplifier = Self {
            unit,
            shade: 0.0,
            alive: corners.len() / 3,
            positions: positions().map(|p| (p.as_dvec3() - center) / unit).collect(),
            freedom: Vec::new(),
            planes: vec![Quadric::default(); places.len()],
            versions: vec![0; places.len()],
            shading: Attributes::default(),
            maps: Attributes::default(),
            first: vec![GONE; places.len()],
            next: vec![GONE; corners.len()],
            queue: BinaryHeap::new(),
            marks: [vec![0; places.len()], vec![0; places.len()]],
            token: 0,
            moves: Vec::new(),
            around: Vec::new(),
            vertices,
            place_of,
            corners,
        };
        for corner in (0..simplifier.corners.len() as u32).rev() {
            let place = simplifier.place(corner) as usize;
            simplifier.next[corner as usize] = std::mem::replace(&mut simplifier.first[place], corner);
        }
        for (local, &place) in (0..).zip(&places) {
            let freedom = if is_locked(place) { Freedom::None } else { simplifier.fan_freedom(local, keeps_borders) };
            simplifier.freedom.push(freedom);
        }
        simplifier.add_attributes(mesh, target);
        simplifier.add_quadrics();
        for place in 0..places.len() as u32 {
            simplifier.push_all(place);
        }
        simplifier
    }

    /// Collapses edges until no more than `target` triangles are left, or nothing may collapse with a position error of
    /// up to `limit`, in units of the mesh.
    pub(super) fn reduce(mut self, target: usize, limit: f64) -> Simplified {
        let limit = (limit / self.unit).max(ROUNDING);
        let mut largest = Cost::default();
        let (mut lost, mut collapses) = (0.0, 0);
        while self.alive > target
            && let Some(Reverse((bits, from, to, version))) = self.queue.pop()
        {
            if self.versions[from as usize] != version || self.versions[to as usize] == GONE || !self.may(from, to) {
                continue;
            }
            let cost = self.cost();
            if cost.position > limit * limit {
                continue;
            }
            // The cost in the queue is that of one wedge.
            let real = cost.bits(self.distance2(from, to));
            if real > bits {
                self.queue.push(Reverse((real, from, to, version)));
                continue;
            }
            largest = largest.max(cost);
            lost += cost.shading;
            collapses += 1;
            self.collapse(from, to);
        }
        let alive = self.corners.as_chunks::<3>().0.iter().filter(|triangle| triangle[0] != GONE);
        let edges = alive.clone().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let varying: f64 = edges.map(|edge| self.shading.difference2(edge)).sum();
        let mean_lost = lost / f64::from(collapses.max(1));
        let mean_varying = varying / (3 * self.alive).max(1) as f64;
        let part_lost = (mean_lost / mean_varying.max(f64::MIN_POSITIVE)).sqrt();
        let weight = (part_lost / NOISE * EDGE_WEIGHT[1]).clamp(EDGE_WEIGHT[0], EDGE_WEIGHT[1]);
        let area: f64 = (0..self.corners.len() as u32 / 3).filter_map(|t| self.plane(t)).map(|(_, area)| area).sum();
        let visible = (largest.shading.sqrt() / (VISIBLE * self.shade).max(f64::MIN_POSITIVE)).min(1.0);
        Simplified {
            triangles: alive.map(|triangle| triangle.map(|wedge| self.vertices[wedge as usize])).collect(),
            position_error: largest.position.sqrt() * self.unit,
            shading_error: weight * visible * edge_length(area, self.alive) * self.unit,
            map_error: largest.map.sqrt() * self.unit,
        }
    }

    fn place(&self, corner: u32) -> u32 {
        self.place_of[self.corners[corner as usize] as usize]
    }

    fn distance2(&self, a: u32, b: u32) -> f64 {
        self.positions[a as usize].distance_squared(self.positions[b as usize])
    }

    /// The corners at a place, each with the next and the one before it in its triangle.
    fn fan(&self, place: u32) -> impl Iterator<Item = [u32; 3]> {
        let at = |corner: u32| (corner != GONE).then_some(corner);
        let all = std::iter::successors(at(self.first[place as usize]), move |&c| at(self.next[c as usize]));
        all.filter(|&corner| self.corners[corner as usize] != GONE).map(in_triangle)
    }

    /// Classifies a place by the triangles around it.
    fn fan_freedom(&mut self, place: u32, keeps_borders: bool) -> Freedom {
        self.token += 1;
        let (token, [mut after, mut before]) = (self.token, std::mem::take(&mut self.marks));
        let (mut count, mut is_surface) = (0, true);
        for [_, next, previous] in self.fan(place) {
            count += 1;
            is_surface &= std::mem::replace(&mut after[self.place(next) as usize], token) != token;
            is_surface &= std::mem::replace(&mut before[self.place(previous) as usize], token) != token;
        }
        let inner = self.fan(place).filter(|[_, next, _]| before[self.place(*next) as usize] == token).count();
        self.marks = [after, before];
        if !is_surface || count > MOST_AROUND || inner + 1 < count {
            Freedom::None
        } else if inner == count {
            Freedom::Any
        } else if keeps_borders {
            Freedom::None
        } else {
            Freedom::Border
        }
    }

    /// The unit normal and the area of a triangle, if it has any.
    fn plane(&self, triangle: u32) -> Option<(DVec3, f64)> {
        let corners = [0, 1, 2].map(|corner| 3 * triangle + corner);
        if self.corners[corners[0] as usize] == GONE {
            return None;
        }
        let [a, b, c] = corners.map(|corner| self.positions[self.place(corner) as usize]);
        let n = (b - a).cross(c - a);
        Some((n.try_normalize()?, 0.5 * n.length()))
    }

    /// Converts the attributes to lengths.
    fn add_attributes(&mut self, mesh: &Mesh, target: usize) {
        let areas = |area: &dyn Fn(u32) -> f64| (0..self.corners.len() as u32 / 3).map(area).sum::<f64>();
        let area = areas(&|t| self.plane(t).map_or(0.0, |(_, area)| area));
        let shade = ATTRIBUTE_WEIGHT * edge_length(area, target.max(self.alive / MOST_REDUCTION));
        self.shade = shade;
        // A unit of texture coordinates is as long as it is on the surface on average.
        let maps = [0, 1].map(|set| {
            let uvs = mesh.uv_set(set)?;
            let area_on_map = areas(&|t| {
                let corner =
                    |i: u32| uvs[self.vertices[self.corners[(3 * t + i) as usize] as usize] as usize].as_dvec2();
                0.5 * (corner(1) - corner(0)).perp_dot(corner(2) - corner(0)).abs()
            });
            Some((uvs, if area_on_map > 0.0 { (area / area_on_map).sqrt() } else { 0.0 }))
        });
        let (mut shading, mut on_maps) = (Vec::new(), Vec::new());
        for vertex in self.vertices.iter().map(|&vertex| vertex as usize) {
            shading.extend(mesh.normals()[vertex].to_array().map(|x| shade * f64::from(x)));
            if let Some(colors) = mesh.colors() {
                shading.extend(colors[vertex].to_array().map(|x| shade * f64::from(x)));
            }
            for (uvs, scale) in maps.iter().flatten() {
                on_maps.extend(uvs[vertex].to_array().map(|x| scale * f64::from(x)));
            }
        }
        self.shading = Attributes::new(shading, self.vertices.len());
        self.maps = Attributes::new(on_maps, self.vertices.len());
    }

    /// Accumulates the quadrics of all triangles.
    fn add_quadrics(&mut self) {
        let mut wedges_of = vec![0_u32; self.positions.len()];
        for &place in &self.place_of {
            wedges_of[place as usize] += 1;
        }
        let is_plain = |place: u32, freedom: Freedom| freedom == Freedom::Any && wedges_of[place as usize] == 1;
        for triangle in 0..self.corners.len() as u32 / 3 {
            let Some((n, area)) = self.plane(triangle) else { continue };
            let corners = [0, 1, 2].map(|corner| 3 * triangle + corner);
            let wedges = corners.map(|corner| self.corners[corner as usize] as usize);
            let places = corners.map(|corner| self.place(corner));
            let [a, b, c] = places.map(|place| self.positions[place as usize]);
            let mut plane = Quadric { weight: area, ..Quadric::default() };
            plane.add_square(n, -n.dot(a), area);
            for place in places {
                self.planes[place as usize].add(&plane);
            }
            let plain = places.map(|place| is_plain(place, self.freedom[place as usize]));
            for edge in (0..3).filter(|&edge| !plain[edge] || !plain[(edge + 1) % 3]) {
                self.add_edge(in_triangle(corners[edge]), n);
            }
            let longest2 = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            if area > NEEDLE * longest2 {
                self.shading.add_triangle(wedges, a, [b - a, c - a], n, area);
                self.maps.add_triangle(wedges, a, [b - a, c - a], n, area);
            }
        }
    }

    /// Adds a plane through an edge, across the triangle with normal n, if it is a border, a seam or a crease.
    fn add_edge(&mut self, [corner, next, _]: [u32; 3], n: DVec3) {
        let [from, to] = [corner, next].map(|corner| self.place(corner));
        let wedges = |corners: [u32; 2]| corners.map(|corner| self.corners[corner as usize]);
        // The triangle on the other side runs along the edge in the opposite direction.
        if self.fan(from).any(|[at, _, previous]| wedges([at, previous]) == wedges([corner, next])) {
            return;
        }
        let (p, side) = (self.positions[from as usize], self.positions[to as usize] - self.positions[from as usize]);
        let across = side.cross(n).normalize_or_zero();
        let mut plane = Quadric { weight: side.length_squared(), ..Quadric::default() };
        plane.add_square(across, -across.dot(p), plane.weight);
        for place in [from, to] {
            self.planes[place as usize].add(&plane);
        }
    }

    /// The cost of collapsing a wedge onto another.
    fn move_cost(&self, from: u32, to: u32) -> Cost {
        let [from, to] = [from, to].map(|wedge| wedge as usize);
        let planes = &self.planes[self.place_of[from] as usize];
        let p = self.positions[self.place_of[to] as usize];
        Cost {
            position: planes.mean(planes.sum(p)),
            shading: self.shading.deviation(from, to, p),
            map: self.maps.deviation(from, to, p),
        }
    }

    /// Queues a collapse along an edge of a triangle, from corner to corner.
    fn push(&mut self, from: u32, to: u32) {
        let [place, target] = [from, to].map(|corner| self.place(corner));
        if self.freedom[place as usize] != Freedom::None {
            let [from, to] = [from, to].map(|corner| self.corners[corner as usize]);
            let bits = self.move_cost(from, to).bits(self.distance2(place, target));
            self.queue.push(Reverse((bits, place, target, self.versions[place as usize])));
        }
    }

    /// Queues all collapses of a place.
    fn push_all(&mut self, place: u32) {
        let freedom = self.freedom[place as usize];
        if freedom == Freedom::None {
            return;
        }
        let mut around = std::mem::take(&mut self.around);
        around.clear();
        around.extend(self.fan(place).map(|[corner, ..]| corner));
        for [corner, next, previous] in around.iter().map(|&corner| in_triangle(corner)) {
            self.push(corner, next);
            if freedom == Freedom::Border {
                self.push(corner, previous);
            }
        }
        self.around = around;
    }

    /// Whether a place may collapse onto a neighbour; finds the [moves](Self::moves) as well.
    fn may(&mut self, from: u32, to: u32) -> bool {
        let mut moves = std::mem::take(&mut self.moves);
        moves.clear();
        let vanishing = self.vanishing(from, to, &mut moves);
        let may = vanishing == Some(if self.freedom[from as usize] == Freedom::Border { 1 } else { 2 })
            && self.keeps_orientation(from, to, &moves)
            && self.common_neighbors(from, to) == vanishing;
        self.moves = moves;
        may
    }

    /// The number of triangles on an edge, which vanish with it; `None` if a wedge would become two.
    fn vanishing(&self, from: u32, to: u32, moves: &mut Vec<[u32; 2]>) -> Option<usize> {
        let mut count = 0;
        for [corner, next, previous] in self.fan(from) {
            let Some(other) = [next, previous].into_iter().find(|&corner| self.place(corner) == to) else { continue };
            let [own, other] = [corner, other].map(|corner| self.corners[corner as usize]);
            match moves.iter().find(|moved| moved[0] == own) {
                None => moves.push([own, other]),
                Some(moved) if moved[1] != other => return None,
                Some(_) => {}
            }
            count += 1;
        }
        Some(count)
    }

    /// Whether triangles remain around a place, all of its wedges are among the moves, and no triangle turns over.
    fn keeps_orientation(&self, from: u32, to: u32, moves: &[[u32; 2]]) -> bool {
        let [p, target] = [from, to].map(|place| self.positions[place as usize]);
        let mut remains = false;
        for [corner, next, previous] in self.fan(from) {
            let places = [next, previous].map(|corner| self.place(corner));
            if places.contains(&to) {
                continue;
            }
            let [q, r] = places.map(|place| self.positions[place as usize]);
            let (before, after) = ((q - p).cross(r - p), (q - target).cross(r - target));
            let least = LEAST_COSINE * (before.length_squared() * after.length_squared()).sqrt();
            if before.dot(after) < least || moves.iter().all(|moved| moved[0] != self.corners[corner as usize]) {
                return false;
            }
            remains = true;
        }
        remains
    }

    /// The number of neighbours that two places have in common; `None` if the second has too many triangles.
    fn common_neighbors(&mut self, from: u32, to: u32) -> Option<usize> {
        self.token += 1;
        let (token, mut marks) = (self.token, std::mem::take(&mut self.marks[0]));
        for [_, next, previous] in self.fan(from) {
            for corner in [next, previous] {
                marks[self.place(corner) as usize] = token;
            }
        }
        let (mut common, mut triangles) = (0, 0);
        for [_, next, previous] in self.fan(to) {
            triangles += 1;
            for corner in [next, previous] {
                let mark = &mut marks[self.place(corner) as usize];
                common += usize::from(*mark == token);
                *mark = 0;
            }
        }
        self.marks[0] = marks;
        (triangles <= MOST_AROUND).then_some(common)
    }

    /// The cost of all [moves](Self::moves) together.
    fn cost(&self) -> Cost {
        self.moves.iter().map(|&[from, to]| self.move_cost(from, to)).fold(Cost::default(), Cost::max)
    }

    /// Collapses a place onto a neighbour, by the [moves](Self::moves).
    fn collapse(&mut self, from: u32, to: u32) {
        let moved: Vec<u32> = self.fan(from).map(|[corner, ..]| corner).collect();
        let others: Vec<u32> = self.fan(to).map(|[corner, ..]| corner).collect();
        for &corner in &moved {
            let [_, next, previous] = in_triangle(corner);
            if [next, previous].map(|corner| self.place(corner)).contains(&to) {
                for corner in [corner, next, previous] {
                    self.corners[corner as usize] = GONE;
                }
                self.alive -= 1;
            } else if let Some(&[_, wedge]) = self.moves.iter().find(|moved| moved[0] == self.corners[corner as usize])
            {
                self.corners[corner as usize] = wedge;
            }
        }
        self.first[from as usize] = GONE;
        self.first[to as usize] = GONE;
        for &corner in others.iter().chain(&moved).filter(|&&corner| self.corners[corner as usize] != GONE) {
            self.next[corner as usize] = std::mem::replace(&mut self.first[to as usize], corner);
        }
        let planes = self.planes[from as usize];
        self.planes[to as usize].add(&planes);
        for &[from, to] in &self.moves {
            let [from, to] = [from, to].map(|wedge| wedge as usize);
            self.shading.join(from, to);
            self.maps.join(from, to);
        }
        self.versions[from as usize] = GONE;
        self.versions[to as usize] += 1;
        self.push_all(to);
        for corner in moved {
            if self.corners[corner as usize] == GONE {
                continue;
            }
            let [_, next, previous] = in_triangle(corner);
            self.push(previous, corner);
            if self.freedom[self.place(next) as usize] == Freedom::Border {
                self.push(next, corner);
            }
        }
    }
}

/// The distinct values in the order of their first occurrence, and the index among these of each value.
fn numbered(things: Vec<u32>) -> (Vec<u32>, Vec<u32>) {
    let Numbering { numbers, firsts } = Numbering::new(things.len(), |at| [things[at]]);
    (firsts.into_iter().map(|first| things[first as usize]).collect(), numbers)
}

/// A corner, and the next and the one before it in its triangle.
fn in_triangle(corner: u32) -> [u32; 3] {
    match corner % 3 {
        0 => [corner, corner + 1, corner + 2],
        1 => [corner, corner + 1, corner - 1],
        _ => [corner, corner - 2, corner - 1],
    }
}

/// The edge of equilateral triangles of which this number covers an area.
fn edge_length(area: f64, triangles: usize) -> f64 {
    (area * 4.0 / (3.0_f64.sqrt() * triangles.max(1) as f64)).sqrt()
}

/// A coarser mesh with its error.
#[derive(Clone, Debug, PartialEq)]
pub struct SimplifiedMesh {
    /// The mesh; its vertices are some of the fine mesh's, with all their attributes.
    pub mesh: Mesh,
    /// No point of either mesh is further from the other than this, in their units: the larger of both
    /// [distances](Mesh::distance_to), known to a fifth of the simplifier's estimate, to a fifth of the error that was
    /// allowed, or to a ten-thousandth of half the longest edge of the box around the mesh.
    pub error: f64,
}

/// The most attempts at a mesh with too large an error.
const TRIES: u32 = 4;

/// The error is known to this fraction of the simplifier's estimate or of the error allowed, or to the second fraction
/// of half the longest edge of the box around the mesh.
const ERROR_TOLERANCE: [f64; 2] = [0.2, 1e-4];

impl Mesh {
    /// The mesh with about as many triangles as asked for, or more, if fewer would exceed `max_error` (in its units) or
    /// change its topology. Errors below the accuracy of the measurement are allowed.
    ///
    /// Edges collapse, the cheapest first: by the distance from the planes around (Garland and Heckbert 1997) and by
    /// the change of normals, texture coordinates and colours (Hoppe 1999). Open borders stay in place as far as the
    /// error allows. Seams between vertices at one position stay closed; faceted meshes, which are all seams, should be
    /// [welded](Self::welded) first.
    ///
    /// ```
    /// use halfway_mesh::{Mesh, UvSphere};
    ///
    /// let sphere = Mesh::from(UvSphere::new(1.0, 64, 32));
    /// let coarse = sphere.simplified(500, 0.05);
    /// assert!(coarse.mesh.triangle_count() < 600 && coarse.error <= 0.05);
    /// ```
    pub fn simplified(&self, triangles: usize, max_error: f64) -> SimplifiedMesh {
        let wedges = Wedges::new(self);
        let all: Vec<[u32; 3]> = self.triangles().collect();
        let size = self.bounds().max.as_dvec3() - self.bounds().min.as_dvec3();
        // NaN allows no error.
        let max_error = max_error.max(0.0);
        let mut limit = max_error;
        for _ in 0..TRIES {
            let simplifier = Simplifier::new(self, &wedges, &all, triangles, false, |_| false);
            let Simplified { triangles, position_error, .. } = simplifier.reduce(triangles, limit);
            if triangles.is_empty() {
                break;
            }
            let mesh = self.in_order_of_use(triangles.as_flattened());
            let rounding = ERROR_TOLERANCE[1] * 0.5 * size.max_element();
            let allowed = if max_error.is_finite() { max_error } else { 0.0 };
            let tolerance = (ERROR_TOLERANCE[0] * position_error.max(allowed)).max(rounding);
            let error = self.distance_to(&mesh, tolerance).most.max(mesh.distance_to(self, tolerance).most);
            // Rounding may take an error of 0 above the tolerance.
            if error <= max_error.max(1.001 * tolerance) {
                return SimplifiedMesh { mesh, error };
            }
            // The simplifier knows a mean of squares only; try a little less than the linear estimate.
            limit *= 0.9 * max_error / error;
        }
        SimplifiedMesh { mesh: self.clone(), error: 0.0 }
    }
}

//! The nearest triangle, by a tree of boxes.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy_math::{DVec3, Vec3, Vec3A};

/// Three corners.
pub(super) type TriangleCorners = [DVec3; 3];

/// Triangles, found by place. `C` gives the corners of each by its number; they are not kept.
pub(super) struct TriangleTree<C> {
    corners: C,
    /// The numbers of the triangles, leaf by leaf.
    triangles: Vec<u32>,
    /// A node's near half follows it; leaves have triangles. The first is the root.
    nodes: Vec<Node>,
}

struct Node {
    min: Vec3,
    max: Vec3,
    /// The only piece of which it has triangles, if there is one.
    piece: Option<u32>,
    /// Where the triangles of a leaf begin, the number of the second half's node otherwise.
    next: u32,
    /// The number of a leaf's triangles, 0 otherwise.
    count: u32,
}

/// What rounding to single precision changes of a distance, at most.
const A_LITTLE: f32 = 1e-5;
const A_LITTLE_MORE: f32 = 1.0 + A_LITTLE;

/// So many triangles are not worth a box more.
const LEAF: usize = 8;

impl<C: Fn(u32) -> [Vec3; 3]> TriangleTree<C> {
    /// Of at least one triangle.
    pub(super) fn new(count: u32, corners: C) -> Self {
        Self::of_pieces(count, corners, |_| 0, &AtomicBool::new(false))
    }

    /// Of at least one triangle; which piece each is of, by its number. Where `stop` becomes true the tree is good for
    /// nothing.
    pub(super) fn of_pieces(count: u32, corners: C, piece: impl Fn(u32) -> u32, stop: &AtomicBool) -> Self {
        let key = |number: u32| (corners(number).into_iter().map(|corner| corner / 3.0).sum(), number);
        let mut keys: Vec<(Vec3, u32)> = (0..count).map(key).collect();
        let leaves = (count as usize).div_ceil(LEAF).next_power_of_two();
        let mut nodes = Vec::with_capacity(2 * leaves);
        build(&mut keys, 0, (&corners, &piece, stop), &mut nodes);
        Self { triangles: keys.into_iter().map(|(_, number)| number).collect(), nodes, corners }
    }

    fn distance_squared(&self, p: DVec3, triangle: u32) -> f64 {
        distance_squared(p, (self.corners)(triangle).map(Vec3::as_dvec3))
    }

    /// The distance from one of the triangles, by its number.
    pub(super) fn distance(&self, p: DVec3, triangle: u32) -> f64 {
        self.distance_squared(p, triangle).sqrt()
    }

    /// The least distance from a triangle, and its number. The nearer the triangle of number `guess`, the sooner it is
    /// found.
    pub(super) fn nearest(&self, p: DVec3, guess: u32) -> (f64, u32) {
        let (mut least2, mut nearest) = (self.distance_squared(p, guess), guess);
        self.search(p, None, least2, |number| {
            let distance2 = self.distance_squared(p, number);
            if distance2 < least2 {
                (least2, nearest) = (distance2, number);
            }
            least2
        });
        (least2.sqrt(), nearest)
    }

    /// The least distance from a triangle of another piece, infinite where all are further off than `within`; `piece`
    /// is that of each by its number.
    pub(super) fn nearest_of_others(&self, p: DVec3, own: u32, piece: impl Fn(u32) -> u32, within: f64) -> f64 {
        let mut least2 = within * within;
        let mut is_found = false;
        self.search(p, Some(own), least2, |number| {
            if piece(number) != own {
                let distance2 = self.distance_squared(p, number);
                is_found |= distance2 < least2;
                least2 = least2.min(distance2);
            }
            least2
        });
        if is_found { least2.sqrt() } else { f64::INFINITY }
    }

    /// Looks at triangles near a line through a point, the near ones first on either side; `look` gets a triangle's
    /// number, and returns the distance from which on no others need be looked at; at first `within` is. The direction
    /// has a length of 1.
    pub(super) fn search_line(&self, p: Vec3, direction: Vec3, within: f64, mut look: impl FnMut(u32) -> f64) {
        let mut within = within as f32 * A_LITTLE_MORE;
        // Finite, so that it makes no NaN of 0.
        let (p, inverse) = (Vec3A::from(p), Vec3A::from(direction).recip().clamp(-Vec3A::MAX, Vec3A::MAX));
        let mut waiting = vec![(0.0, 0)];
        while let Some((distance, number)) = waiting.pop() {
            if distance > within {
                continue;
            }
            let node: &Node = &self.nodes[number];
            for &number in &self.triangles[node.triangles()] {
                within = look(number) as f32 * A_LITTLE_MORE;
            }
            if node.count == 0 {
                let halves = [number + 1, node.next as usize];
                let halves = halves.map(|half| (self.nodes[half].distance_along(p, inverse), half));
                let [a, b] = halves;
                waiting.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
            }
        }
    }

    /// Looks at all triangles that a point is on, and at some that are near it.
    pub(super) fn search_around(&self, p: Vec3, mut look: impl FnMut(u32)) {
        self.search(p.as_dvec3(), None, f64::MIN_POSITIVE, |number| {
            look(number);
            f64::MIN_POSITIVE
        });
    }

    /// Looks at triangles, the near ones first: `look` gets a triangle's number and returns the square of the distance
    /// from which on no others need be looked at; at first `within2` is. Where there is nothing but one piece, those of
    /// `left_out` are not looked at.
    fn search(&self, p: DVec3, left_out: Option<u32>, within2: f64, mut look: impl FnMut(u32) -> f64) {
        let mut within2 = within2;
        let mut waiting = vec![(self.nodes[0].distance_squared(p), 0)];
        while let Some((distance2, number)) = waiting.pop() {
            if distance2 >= within2 {
                continue;
            }
            let node: &Node = &self.nodes[number];
            if left_out.is_some() && node.piece == left_out {
                continue;
            }
            for &number in &self.triangles[node.triangles()] {
                within2 = look(number);
            }
            if node.count == 0 {
                let halves = [number + 1, node.next as usize].map(|half| (self.nodes[half].distance_squared(p), half));
                let [a, b] = halves;
                // The nearer half is looked at first.
                waiting.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
            }
        }
    }
}

/// The tree over the triangles of these numbers, found by their centroids, which come after `before` others.
fn build(
    keys: &mut [(Vec3, u32)],
    before: usize,
    (corners, piece, stop): (&impl Fn(u32) -> [Vec3; 3], &impl Fn(u32) -> u32, &AtomicBool),
    nodes: &mut Vec<Node>,
) {
    let this = nodes.len();
    if keys.len() <= LEAF || stop.load(Ordering::Relaxed) {
        let (min, max) = bounds(keys.iter().flat_map(|(_, number)| corners(*number)));
        let mut pieces = keys.iter().map(|(_, number)| piece(*number));
        let first = pieces.next();
        let piece = first.filter(|first| pieces.all(|other| other == *first));
        nodes.push(Node { min, max, piece, next: before as u32, count: keys.len() as u32 });
        return;
    }
    let (min, max) = bounds(keys.iter().map(|(place, _)| *place));
    // Halved first, so that no finite box overflows.
    let axis = (max * 0.5 - min * 0.5).max_position();
    let middle = keys.len() / 2;
    keys.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (near, far) = keys.split_at_mut(middle);
    nodes.push(Node { min: Vec3::ZERO, max: Vec3::ZERO, piece: None, next: 0, count: 0 });
    build(near, before, (corners, piece, stop), nodes);
    let next = nodes.len();
    build(far, before + middle, (corners, piece, stop), nodes);
    let [a, b] = [&nodes[this + 1], &nodes[next]];
    let piece = a.piece.filter(|_| a.piece == b.piece);
    nodes[this] = Node { min: a.min.min(b.min), max: a.max.max(b.max), piece, next: next as u32, count: 0 };
}

/// The box around points.
fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}

impl Node {
    fn distance_squared(&self, p: DVec3) -> f64 {
        p.distance_squared(p.clamp(self.min.as_dvec3(), self.max.as_dvec3()))
    }

    /// How far off the box is along a line on either side, more or less; infinitely far where it is beside the line.
    fn distance_along(&self, p: Vec3A, inverse: Vec3A) -> f32 {
        let [a, b] = [self.min, self.max].map(|corner| (Vec3A::from(corner) - p) * inverse);
        let (first, last) = (a.min(b).max_element(), a.max(b).min_element());
        let is_met = first <= last + A_LITTLE * first.abs().min(last.abs());
        if is_met { first.max(-last).max(0.0) } else { f32::INFINITY }
    }

    fn triangles(&self) -> std::ops::Range<usize> {
        if self.count == 0 { 0..0 } else { self.next as usize..(self.next + self.count) as usize }
    }
}

/// The square of the distance of a point from a triangle, which may be degenerate.
fn distance_squared(p: DVec3, triangle: TriangleCorners) -> f64 {
    nearest_on(p, triangle).0
}

/// The square of the distance of a point from a triangle, which may be degenerate, and the weights of its corners at
/// the nearest point.
#[inline]
pub(super) fn nearest_on(p: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, [f64; 3]) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let n = ab.cross(ac);
    let n2 = n.length_squared();
    let (v, w) = (ap.cross(ac).dot(n), ab.cross(ap).dot(n));
    let weights = [n2 - v - w, v, w];
    if n2 > 0.0 && weights[0] >= 0.0 && v >= 0.0 && w >= 0.0 {
        return (ap.dot(n).powi(2) / n2, [weights[0] / n2, v / n2, w / n2]);
    }
    // The nearest side is one that the point is beyond.
    let mut best = (f64::INFINITY, [1.0, 0.0, 0.0]);
    let mut look = |weight: f64, from: DVec3, to: DVec3, weights: fn(f64) -> [f64; 3]| {
        if n2 > 0.0 && weight >= 0.0 {
            return;
        }
        let side = to - from;
        let length2 = side.length_squared();
        let t = if length2 > 0.0 { ((p - from).dot(side) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let distance2 = p.distance_squared(from + side * t);
        if distance2 < best.0 {
            best = (distance2, weights(t));
        }
    };
    look(weights[0], b, c, |t| [0.0, 1.0 - t, t]);
    look(weights[1], c, a, |t| [t, 0.0, 1.0 - t]);
    look(weights[2], a, b, |t| [1.0 - t, t, 0.0]);
    best
}

#[cfg(test)]
mod tests {
    #![expect(clippy::float_cmp, reason = "whole numbers, and the same sums twice")]

    use super::*;

    #[test]
    fn distances_to_every_part_of_a_triangle() {
        let triangle = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        let rows = [
            ("inside", DVec3::new(0.5, 0.5, 3.0), 3.0),
            ("corner", DVec3::new(-3.0, -4.0, 0.0), 5.0),
            ("side", DVec3::new(1.0, -2.0, 0.0), 2.0),
            ("long side", DVec3::new(2.0, 2.0, 0.0), 2.0_f64.sqrt()),
            ("in the plane", DVec3::new(0.5, 0.5, 0.0), 0.0),
        ];
        for (name, p, expected) in rows {
            for order in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
                let found = distance_squared(p, order.map(|i| triangle[i])).sqrt();
                assert!((found - expected).abs() < 1e-12, "{name}: {found}");
            }
        }
        let flat = [DVec3::ZERO, DVec3::X, DVec3::X * 0.5];
        assert_eq!(distance_squared(DVec3::new(0.5, 2.0, 0.0), flat), 4.0);
        assert_eq!(distance_squared(DVec3::Y, [DVec3::ZERO; 3]), 1.0);
    }

    #[test]
    fn the_tree_finds_what_looking_at_all_finds() {
        // Triangles and points at places that repeat, by the golden ratio.
        let place = |i: u32| {
            let t = f64::from(i) * 0.618_033_988_749_895;
            DVec3::new(t.fract(), (t * 3.7).fract(), (t * 11.3).fract())
        };
        let triangle = |i: u32| [0, 1, 2].map(|k| (place(i) + 0.1 * place(1000 + 3 * i + k)).as_vec3());
        let triangles: Vec<TriangleCorners> = (0..200).map(|i| triangle(i).map(Vec3::as_dvec3)).collect();
        let tree = TriangleTree::new(200, triangle);
        for i in 0..300 {
            let p = 2.0 * place(5000 + i) - 0.5;
            let all = triangles.iter().map(|t| distance_squared(p, *t)).fold(f64::INFINITY, f64::min);
            assert_eq!(tree.nearest(p, i % 200).0, all.sqrt());
        }
        // Of pieces that lie among each other, and of some that lie apart.
        let (mixed, apart) = (|i: u32| i % 3, |i: u32| u32::from(place(3 * i).x > 0.5));
        for (name, piece) in [("mixed", &mixed as &dyn Fn(u32) -> u32), ("apart", &apart)] {
            let tree = TriangleTree::of_pieces(200, triangle, piece, &AtomicBool::new(false));
            for i in 0..300 {
                let (p, own) = (2.0 * place(5000 + i) - 0.5, i % 2);
                let others = (0..).zip(&triangles).filter(|(number, _)| piece(*number) != own);
                let least = others.map(|(_, t)| distance_squared(p, *t)).fold(f64::INFINITY, f64::min);
                let least = least.sqrt();
                assert_eq!(tree.nearest_of_others(p, own, piece, f64::INFINITY), least, "{name}");
                let near = if least < 0.1 { least } else { f64::INFINITY };
                assert_eq!(tree.nearest_of_others(p, own, piece, 0.1), near, "{name}, within 0.1");
            }
        }
    }

    #[test]
    fn a_search_along_a_line_looks_at_what_the_line_meets() {
        let place = |i: u32| {
            let t = f64::from(i) * 0.618_033_988_749_895;
            Vec3::new(t.fract() as f32, (t * 3.7).fract() as f32, (t * 11.3).fract() as f32)
        };
        let triangle = |i: u32| [0, 1, 2].map(|k| place(i) + 0.1 * place(1000 + 3 * i + k));
        let tree = TriangleTree::new(200, triangle);
        let mut all = 0;
        for i in 0..300 {
            let [a, b, c] = triangle(i % 200);
            // Also along an axis.
            let direction = if i % 3 == 0 { Vec3::Y } else { (place(7 * i + 3) - 0.5).normalize() };
            let far = 2.0 * place(31 * i).x - 1.0;
            let p = (a + b + c) / 3.0 + far * direction;
            let mut looked = Vec::new();
            tree.search_line(p, direction, 1.001 * f64::from(far.abs()), |number| {
                looked.push(number);
                1.001 * f64::from(far.abs())
            });
            assert!(looked.contains(&(i % 200)), "line {i}");
            all += looked.len();
        }
        assert!(all < 300 * 50, "a line looked at {} of 200", all / 300);
    }
}

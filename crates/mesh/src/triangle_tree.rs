//! A bounding volume hierarchy of triangles that finds the nearest one, and those along a ray.

use glam::{DVec3, Vec3};

/// Three corners.
pub(crate) type TriangleCorners = [DVec3; 3];

/// A tree of triangles. `C` gives the corners of each by its number; they are not stored.
pub(crate) struct TriangleTree<C> {
    corners: C,
    /// The numbers of the triangles, leaf by leaf.
    triangles: Vec<u32>,
    /// A node's near half follows it; leaves have triangles. The first is the root.
    nodes: Vec<Node>,
}

struct Node {
    min: Vec3,
    max: Vec3,
    /// The first triangle of a leaf; for other nodes, the number of the second half's node.
    next: u32,
    /// The number of a leaf's triangles, 0 otherwise.
    count: u32,
}

/// The most triangles in a leaf.
const LEAF: usize = 8;

impl<C: Fn(u32) -> [Vec3; 3]> TriangleTree<C> {
    /// A tree of at least one triangle.
    pub(crate) fn new(count: u32, corners: C) -> Self {
        let key = |number: u32| (corners(number).into_iter().map(|corner| corner / 3.0).sum(), number);
        let mut keys: Vec<(Vec3, u32)> = (0..count).map(key).collect();
        let leaves = (count as usize).div_ceil(LEAF).next_power_of_two();
        let mut nodes = Vec::with_capacity(2 * leaves);
        build(&mut keys, 0, &corners, &mut nodes);
        Self { triangles: keys.into_iter().map(|(_, number)| number).collect(), nodes, corners }
    }

    fn distance_squared(&self, p: DVec3, triangle: u32) -> f64 {
        distance_squared(p, (self.corners)(triangle).map(Vec3::as_dvec3))
    }

    /// The distance from one of the triangles, by its number.
    pub(crate) fn distance(&self, p: DVec3, triangle: u32) -> f64 {
        self.distance_squared(p, triangle).sqrt()
    }

    /// The least distance from a triangle, and its number. The nearer the triangle of number `guess`, the sooner it is
    /// found.
    pub(crate) fn nearest(&self, p: DVec3, guess: u32) -> (f64, u32) {
        let (mut least2, mut nearest) = (self.distance_squared(p, guess), guess);
        let mut waiting = vec![(self.nodes[0].distance_squared(p), 0)];
        while let Some((distance2, number)) = waiting.pop() {
            if distance2 >= least2 {
                continue;
            }
            let node: &Node = &self.nodes[number];
            for &number in &self.triangles[node.triangles()] {
                let distance2 = self.distance_squared(p, number);
                if distance2 < least2 {
                    (least2, nearest) = (distance2, number);
                }
            }
            if node.count == 0 {
                let halves = [number + 1, node.next as usize].map(|half| (self.nodes[half].distance_squared(p), half));
                let [a, b] = halves;
                // The nearer half is visited first.
                waiting.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
            }
        }
        (least2.sqrt(), nearest)
    }

    /// Whether `meets` holds for one of the triangles, by their numbers, that the ray may hit.
    pub(crate) fn any_along(&self, ray: &Ray, meets: impl Fn(u32) -> bool + Copy) -> bool {
        self.any_below(0, ray, meets)
    }

    fn any_below(&self, number: usize, ray: &Ray, meets: impl Fn(u32) -> bool + Copy) -> bool {
        let node = &self.nodes[number];
        if !node.may_meet(ray) {
            return false;
        }
        match node.count {
            0 => self.any_below(number + 1, ray, meets) || self.any_below(node.next as usize, ray, meets),
            _ => self.triangles[node.triangles()].iter().any(|&triangle| meets(triangle)),
        }
    }
}

/// The part of a straight line from its origin to `reach` along its unit direction.
pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) reach: f64,
}

/// The tree of these triangles, given by their centroids; `before` triangles are in earlier leaves.
fn build(keys: &mut [(Vec3, u32)], before: usize, corners: &impl Fn(u32) -> [Vec3; 3], nodes: &mut Vec<Node>) {
    let this = nodes.len();
    if keys.len() <= LEAF {
        let (min, max) = bounds(keys.iter().flat_map(|(_, number)| corners(*number)));
        nodes.push(Node { min, max, next: before as u32, count: keys.len() as u32 });
        return;
    }
    let (min, max) = bounds(keys.iter().map(|(place, _)| *place));
    // Halved first, so that no finite box overflows.
    let axis = (max * 0.5 - min * 0.5).max_position();
    let middle = keys.len() / 2;
    keys.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (near, far) = keys.split_at_mut(middle);
    nodes.push(Node { min: Vec3::ZERO, max: Vec3::ZERO, next: 0, count: 0 });
    build(near, before, corners, nodes);
    let next = nodes.len();
    build(far, before + middle, corners, nodes);
    let [a, b] = [&nodes[this + 1], &nodes[next]];
    nodes[this] = Node { min: a.min.min(b.min), max: a.max.max(b.max), next: next as u32, count: 0 };
}

/// The box around points.
fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}

impl Node {
    fn distance_squared(&self, p: DVec3) -> f64 {
        p.distance_squared(p.clamp(self.min.as_dvec3(), self.max.as_dvec3()))
    }

    /// Whether the ray may hit the sphere around the box.
    fn may_meet(&self, ray: &Ray) -> bool {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        // Enlarged by more than rounding may take away.
        let radius = 0.5 * min.distance(max) * (1.0 + 1e-12);
        let toward = 0.5 * (min + max) - ray.origin;
        let along = toward.dot(ray.direction);
        let aside = toward.length_squared() - along * along;
        // Rounding of the difference of squares is below 1e-15 of them.
        let is_near = aside <= radius * radius + 1e-12 * toward.length_squared();
        is_near && along >= -radius && along <= ray.reach + radius
    }

    fn triangles(&self) -> std::ops::Range<usize> {
        if self.count == 0 { 0..0 } else { self.next as usize..(self.next + self.count) as usize }
    }
}

/// The square of the distance of a point from a triangle, which may be degenerate.
fn distance_squared(p: DVec3, [a, b, c]: TriangleCorners) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let n = ab.cross(ac);
    let n2 = n.length_squared();
    let (v, w) = (ap.cross(ac).dot(n), ab.cross(ap).dot(n));
    let weights = [n2 - v - w, v, w];
    if n2 > 0.0 && weights.iter().all(|&weight| weight >= 0.0) {
        return ap.dot(n).powi(2) / n2;
    }
    // The nearest side is one that the point lies beyond.
    let sides = weights.into_iter().zip([[b, c], [c, a], [a, b]]).filter(|(weight, _)| n2 <= 0.0 || *weight < 0.0);
    let distances2 = sides.map(|(_, [from, to])| {
        let side = to - from;
        let length2 = side.length_squared();
        let t = if length2 > 0.0 { ((p - from).dot(side) / length2).clamp(0.0, 1.0) } else { 0.0 };
        p.distance_squared(from + side * t)
    });
    distances2.fold(f64::INFINITY, f64::min)
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
    fn the_tree_finds_the_nearest_triangle() {
        // Triangles and points at positions that repeat, by the golden ratio.
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
    }
}

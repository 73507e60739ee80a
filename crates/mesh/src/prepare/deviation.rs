//! How far a level is from the mesh, at sampled points.

use std::ops::Range;

use bevy_math::DVec3;
use rayon::prelude::*;

use super::nearest::{TriangleTree, nearest_on};
use crate::Mesh;

/// So many of the vertices that went since the level before are sampled, and so many of those that went earlier.
const MOST_GONE: usize = 8192;

/// So many centroids and middles of edges are sampled.
const MOST_MIDDLES: usize = 16384;

/// What a level and the mesh differ by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Deviation {
    /// The greatest distance of a sampled point.
    pub(super) distance: f64,
    /// The greatest angle between normals, in radians.
    pub(super) angle: f64,
}

impl Deviation {
    pub(super) fn max(self, other: Self) -> Self {
        Self { distance: self.distance.max(other.distance), angle: self.angle.max(other.angle) }
    }

    /// Whether both are no larger.
    pub(super) fn is_within(&self, other: &Self) -> bool {
        self.distance <= other.distance && self.angle <= other.angle
    }
}

/// The vertices that levels do without, one after the other.
pub(super) struct Gone {
    order: Vec<u32>,
    /// Of each vertex, where it is in the order; `usize::MAX` if it stays.
    numbers: Vec<usize>,
    /// Of each vertex, the one onto which it has collapsed; itself if none.
    targets: Vec<u32>,
}

impl Gone {
    pub(super) fn new(order: Vec<u32>, targets: Vec<u32>) -> Self {
        let mut numbers = vec![usize::MAX; targets.len()];
        for (number, &vertex) in order.iter().enumerate() {
            numbers[vertex as usize] = number;
        }
        Self { order, numbers, targets }
    }

    /// Where a vertex is after so many have gone: the vertex onto which it has collapsed, or the one onto which that
    /// has, and so on.
    fn target(&self, vertex: u32, gone: usize) -> u32 {
        let mut vertex = vertex;
        while self.numbers[vertex as usize] < gone && self.targets[vertex as usize] != vertex {
            vertex = self.targets[vertex as usize];
        }
        vertex
    }
}

/// Triangles between a mesh's vertices, found by place.
pub(super) struct Sheet<'a> {
    mesh: &'a Mesh,
    triangles: &'a [[u32; 3]],
    tree: TriangleTree,
}

/// A point and its normal.
#[derive(Clone, Copy)]
struct SurfaceSample {
    p: DVec3,
    n: DVec3,
    /// A difference of unit normals counts as that part of this length, squared.
    scale2: f64,
}

impl<'a> Sheet<'a> {
    /// At least one triangle.
    pub(super) fn new(mesh: &'a Mesh, triangles: &'a [[u32; 3]]) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.positions()[vertex as usize].as_dvec3());
        Self { mesh, triangles, tree: TriangleTree::new(triangles.iter().map(corners).collect()) }
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.mesh.positions()[vertex as usize].as_dvec3()
    }

    fn normal(&self, vertex: u32) -> DVec3 {
        self.mesh.normals()[vertex as usize].as_dvec3()
    }

    /// What this level and the mesh differ by: at vertices that went since the level before, `late` in their order, at
    /// those that went earlier, and at centroids and middles of edges of this level.
    pub(super) fn deviation_from(&self, mesh: &Self, gone: &Gone, late: Range<usize>) -> Deviation {
        let early = spread_out(late.start, MOST_GONE);
        let numbers = early.chain(spread_out(late.len(), MOST_GONE).map(|i| late.start + i));
        let vertices = numbers.map(|number| {
            let vertex = gone.order[number];
            let (p, n) = (self.position(vertex), self.normal(vertex));
            let scale2 = p.distance_squared(self.position(gone.target(vertex, late.end)));
            self.deviation_at(SurfaceSample { p, n, scale2 })
        });
        let middles = self.middles().into_par_iter().map(|middle| mesh.deviation_at(self.sample(middle)));
        vertices.chain(middles).reduce(Deviation::default, Deviation::max)
    }

    /// Corners whose centre is sampled: three of a triangle, or two of an edge and one of them again.
    fn middles(&self) -> Vec<[u32; 3]> {
        let middle = |number: usize| {
            let [a, b, c] = self.triangles[number / 4];
            let edge = |a: u32, b: u32| [a.min(b), a.max(b), a.max(b)];
            [[a, b, c], edge(a, b), edge(b, c), edge(c, a)][number % 4]
        };
        let mut middles: Vec<[u32; 3]> = spread_out(4 * self.triangles.len(), MOST_MIDDLES).map(middle).collect();
        // Triangles share edges.
        middles.sort_unstable();
        middles.dedup();
        middles
    }

    fn sample(&self, [a, b, c]: [u32; 3]) -> SurfaceSample {
        let corners = if b == c { &[a, b][..] } else { &[a, b, c] };
        let p = corners.iter().map(|&vertex| self.position(vertex)).sum::<DVec3>() / corners.len() as f64;
        let n = corners.iter().map(|&vertex| self.normal(vertex)).sum::<DVec3>().normalize_or_zero();
        let to_corner2 = corners.iter().map(|&vertex| p.distance_squared(self.position(vertex)));
        SurfaceSample { p, n, scale2: to_corner2.fold(f64::INFINITY, f64::min) }
    }

    /// The distance of a point from the triangles, and the angle of its normal to the interpolated one there.
    ///
    /// Where a crease or a thin part has two sides near the point, the one that faces its way is meant: a difference of
    /// unit normals counts as that part of the sample's scale.
    fn deviation_at(&self, SurfaceSample { p, n, scale2 }: SurfaceSample) -> Deviation {
        let mut best = (f64::INFINITY, f64::INFINITY, DVec3::ZERO);
        self.tree.search(p, f64::INFINITY, |_, triangle, number| {
            let (distance2, weights) = nearest_on(p, *triangle);
            if distance2 < best.0 {
                let corners = self.triangles[number as usize].into_iter().zip(weights);
                let m = corners.map(|(vertex, weight)| weight * self.normal(vertex)).sum::<DVec3>().normalize_or_zero();
                let cost = distance2 + scale2 * m.distance_squared(n);
                if cost < best.0 {
                    best = (cost, distance2, m);
                }
            }
            best.0
        });
        let (_, distance2, m) = best;
        let angle = if m == DVec3::ZERO { std::f64::consts::PI } else { angle(n, m) };
        Deviation { distance: distance2.sqrt(), angle }
    }
}

/// At most so many numbers below `count`, evenly spread.
fn spread_out(count: usize, most: usize) -> impl IndexedParallelIterator<Item = usize> {
    let taken = count.min(most);
    (0..taken).into_par_iter().map(move |i| i * count / taken)
}

/// The angle between two vectors, exact also where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

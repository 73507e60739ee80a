//! The distance of a mesh from another.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::Vec3;
use rayon::prelude::*;

use crate::Mesh;
use crate::triangle_tree::{TriangleCorners, TriangleTree};

/// Bounds of a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceBounds {
    /// The distance of some point: a lower bound.
    pub least: f64,
    /// A distance that no point exceeds: an upper bound.
    pub most: f64,
}

/// The most subdivisions of triangles.
const CUTS: u32 = 1 << 18;

impl Mesh {
    /// The greatest distance of a point of this mesh's triangles from the other mesh (the one-sided Hausdorff
    /// distance), to within `tolerance`, in the meshes' units; NaN or a negative number count as 0.
    ///
    /// The distance to one triangle is convex, so over a triangle it is greatest at a corner; the distance to a mesh
    /// changes no faster than its point moves. Both bound it over a triangle from above, and triangles are subdivided
    /// where that is not close enough (as by Tang, Lee and Kim 2009, "Interactive Hausdorff distance computation for
    /// general polygonal models"). After some hundred thousand subdivisions the bounds are returned as they are.
    ///
    /// ```
    /// use halfway_mesh::{Icosphere, Mesh};
    ///
    /// let [coarse, fine] = [2, 8].map(|divisions| Mesh::from(Icosphere::new(1.0, divisions)));
    /// let distance = fine.distance_to(&coarse, 1e-3);
    /// assert!(distance.least > 0.05 && distance.most < 0.15);
    /// ```
    pub fn distance_to(&self, other: &Mesh, tolerance: f64) -> DistanceBounds {
        let tolerance = tolerance.max(0.0);
        let target = TriangleTree::new(other.triangle_count() as u32, |number| other.corners_of(number));
        let own = |triangle: &[u32; 3]| triangle.map(|i| self.positions()[i as usize].as_dvec3());
        let triangles = self.indices().as_chunks::<3>().0;
        let first: Vec<SubTriangle> =
            triangles.par_iter().map(|triangle| SubTriangle::new(own(triangle), &target, 0)).collect();
        let mut least = first.iter().fold(0.0_f64, |least, cell| least.max(cell.lower));
        let mut cells: BinaryHeap<SubTriangle> =
            first.into_iter().filter(|cell| cell.upper > least + tolerance).collect();
        for _ in 0..CUTS {
            let Some(cell) = cells.pop().filter(|cell| cell.upper > least + tolerance) else { break };
            for quarter in cell.quarters(&target) {
                least = least.max(quarter.lower);
                cells.push(quarter);
            }
        }
        // Triangles that are not among the cells are within the tolerance.
        let most = cells.peek().map_or(0.0, |cell| cell.upper).max(least + tolerance);
        DistanceBounds { least, most }
    }
}

/// A part of a triangle.
struct SubTriangle {
    corners: TriangleCorners,
    /// The distance of one of its points.
    lower: f64,
    /// A distance that none of its points exceeds.
    upper: f64,
    /// The number of the triangle nearest to its centre.
    nearest: u32,
}

impl SubTriangle {
    /// `guess` is the number of a triangle that is probably near.
    fn new(corners: TriangleCorners, target: &TriangleTree<impl Fn(u32) -> [Vec3; 3]>, guess: u32) -> Self {
        let [a, b, c] = corners;
        let center = (a + b + c) / 3.0;
        let (lower, nearest) = target.nearest(center, guess);
        let reach = corners.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        let to_nearest = corners.iter().map(|&p| target.distance(p, nearest)).fold(0.0, f64::max);
        Self { corners, lower, upper: to_nearest.min(lower + reach), nearest }
    }

    fn quarters(&self, target: &TriangleTree<impl Fn(u32) -> [Vec3; 3]>) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|corners| {
            let quarter = Self::new(corners, target, self.nearest);
            // No part is further than the whole, despite rounding.
            Self { upper: quarter.upper.min(self.upper), ..quarter }
        })
    }
}

impl PartialEq for SubTriangle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for SubTriangle {}

impl PartialOrd for SubTriangle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for SubTriangle {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper)
    }
}

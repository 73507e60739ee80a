//! Which coarse triangle each vertex of a fine surface is nearest to.

use bevy_math::DVec3;

use crate::prepare::nearest::{TriangleCorners, nearest_on};

/// Which coarse triangle each covered vertex is nearest to, by its place in the list of covered vertices.
pub(super) struct Homes {
    nearest: Vec<NearestTriangle>,
}

/// The least distance of a vertex that has been seen.
#[derive(Clone, Copy)]
struct NearestTriangle {
    distance: f64,
    /// The first fine triangle that has it, from 1 (0 where no fine one was asked), and the first coarse one.
    seen: [u32; 2],
}

impl Homes {
    /// Of N vertices.
    pub(super) fn new(count: usize) -> Self {
        Self { nearest: vec![NearestTriangle { distance: f64::INFINITY, seen: [0, u32::MAX] }; count] }
    }

    /// Takes note of a distance between a vertex and a fine (from 1, or 0) and a coarse triangle, if the vertex is in
    /// the list.
    pub(super) fn see(&mut self, vertex: u32, seen: [u32; 2], distance: f64) {
        if let Some(nearest) = self.nearest.get_mut(vertex as usize)
            && (distance, seen) < (nearest.distance, nearest.seen)
        {
            *nearest = NearestTriangle { distance, seen };
        }
    }

    /// Compares the vertices that lie over no triangle with all, and returns how far the farthest of all is, and the
    /// coarse triangles.
    pub(super) fn farthest(mut self, positions: &[DVec3], coarse: &[TriangleCorners]) -> (f64, Vec<u32>) {
        // Made when the first is asked for: most surfaces have few such vertices, or none.
        let mut spheres: Vec<(DVec3, f64)> = Vec::new();
        let unseen = self.nearest.iter_mut().zip(positions).filter(|(nearest, _)| nearest.seen[1] == u32::MAX);
        for (nearest, &p) in unseen {
            if spheres.is_empty() {
                spheres = coarse.iter().copied().map(sphere_around).collect();
            }
            let (mut least2, mut least) = (f64::INFINITY, f64::INFINITY);
            for (number, (&(center, radius), &corners)) in (0..).zip(spheres.iter().zip(coarse)) {
                // Further off than the nearest, by more than rounding could change.
                if p.distance_squared(center) > 1.001 * (radius + least).powi(2) {
                    continue;
                }
                let (distance2, _) = nearest_on(p, corners);
                if distance2 < least2 {
                    (least2, least) = (distance2, distance2.sqrt());
                    *nearest = NearestTriangle { distance: least, seen: [0, number] };
                }
            }
        }
        let farthest = self.nearest.iter().map(|nearest| nearest.distance).fold(0.0, f64::max);
        (farthest, self.nearest.iter().map(|nearest| nearest.seen[1]).collect())
    }
}

/// The centre of a triangle, and how far it reaches from there; infinitely far where rounding may take points on it for
/// anywhere in its plane: with height h over a sliver whose area is a part r of its edge's square, by about 1e-16 h/r².
fn sphere_around([a, b, c]: TriangleCorners) -> (DVec3, f64) {
    let center = (a + b + c) / 3.0;
    let radius2 = a.distance_squared(center).max(b.distance_squared(center)).max(c.distance_squared(center));
    let longest2 = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    let is_sliver = (b - a).cross(c - a).length() <= 1e-4 * longest2;
    (center, if is_sliver { f64::INFINITY } else { radius2.sqrt() })
}

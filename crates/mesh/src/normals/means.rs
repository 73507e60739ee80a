//! Weighted means of face normals.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::face::{Face, PARALLEL_MIN};
use super::{NormalReport, NormalWeighting};
use crate::numbering::Numbering;

/// A mean has vanished if its length is at most this fraction of the sum of the weights: a few rounding steps of the
/// `f32` positions.
const CANCELLED: f64 = 1e-6;

/// The normals and weights of so many triangles are computed by all threads, while one thread adds up those of the block
/// before in the order of the triangles: sums do not depend on the number of threads, and the block stays in the cache.
const BLOCK: usize = 1 << 14;

/// The normals of all vertices: one a point. `indices` has three a triangle, all in range.
pub(crate) fn vertex_normals(
    positions: &[Vec3],
    points: &Numbering,
    indices: &[u32],
    weighting: NormalWeighting,
) -> (Vec<Vec3>, NormalReport) {
    let means =
        Means::new(positions, indices, points.count(), weighting, |corner| points.numbers[indices[corner] as usize]);
    let mut report = means.report;
    let normals = points.numbers.iter().map(|&group| means.normal(group, &mut report)).collect();
    (normals, report)
}

/// The mean normal of every class of corners.
pub(super) struct Means {
    /// Zero where no triangle had a normal.
    normals: Vec<Vec3>,
    /// The classes whose mean vanished.
    cancelled: HashMap<u32, Largest>,
    /// Counts the degenerate triangles.
    pub(super) report: NormalReport,
}

/// The sum over one class.
#[derive(Clone, Copy, Default)]
struct NormalSum {
    n: DVec3,
    weights: f64,
}

/// The largest triangle of a class.
#[derive(Clone, Copy, Default)]
struct Largest {
    n: DVec3,
    area2: f64,
}

impl Means {
    /// The means of the classes of corners; `class` gives the class of each corner (3·triangle + corner), below
    /// `classes`.
    pub(super) fn new(
        positions: &[Vec3],
        indices: &[u32],
        classes: usize,
        weighting: NormalWeighting,
        class: impl Fn(usize) -> u32 + Sync,
    ) -> Self {
        let mut report = NormalReport::default();
        let mut sums = vec![NormalSum::default(); classes];
        let blocks: Vec<&[[u32; 3]]> = indices.as_chunks().0.chunks(BLOCK).collect();
        let share = |triangle: &[u32; 3]| {
            let face = Face::new(triangle.map(|i| positions[i as usize]))?;
            Some((face.n, face.weights(weighting)))
        };
        let compute = |block: usize, shares: &mut Vec<_>| {
            let triangles = blocks.get(block).copied().unwrap_or_default();
            triangles.par_iter().with_min_len(PARALLEL_MIN).map(share).collect_into_vec(shares);
        };
        let mut add = |block: usize, shares: &[Option<(DVec3, [f64; 3])>]| {
            for (triangle, share) in shares.iter().enumerate() {
                let Some((n, weights)) = share else {
                    report.degenerate_triangles += 1;
                    continue;
                };
                for (corner, weight) in weights.iter().enumerate() {
                    let sum = &mut sums[class(3 * (block * BLOCK + triangle) + corner) as usize];
                    sum.n += n * weight;
                    sum.weights += weight;
                }
            }
        };
        let (mut shares, mut next) = (Vec::new(), Vec::new());
        compute(0, &mut shares);
        if blocks.len() == 1 {
            add(0, &shares);
        } else {
            for block in 0..blocks.len() {
                rayon::join(|| add(block, &shares), || compute(block + 1, &mut next));
                std::mem::swap(&mut shares, &mut next);
            }
        }
        let (normals, cancelled) = settle(&sums);
        let mut means = Self { normals, cancelled, report };
        means.find_largest(positions, indices, class);
        means
    }

    /// Finds the largest triangle of each vanished mean, in a second pass.
    fn find_largest(&mut self, positions: &[Vec3], indices: &[u32], class: impl Fn(usize) -> u32) {
        if self.cancelled.is_empty() {
            return;
        }
        for (triangle, corners) in indices.as_chunks::<3>().0.iter().enumerate() {
            for corner in 0..3 {
                let Some(largest) = self.cancelled.get_mut(&class(3 * triangle + corner)) else { continue };
                let Some(face) = Face::new(corners.map(|i| positions[i as usize])) else { continue };
                if face.area2 > largest.area2 {
                    *largest = Largest { n: face.n, area2: face.area2 };
                }
            }
        }
    }

    /// The normal of a vertex of this class; counts those that are filled in.
    pub(super) fn normal(&self, class: u32, report: &mut NormalReport) -> Vec3 {
        let n = self.normals[class as usize];
        if n != Vec3::ZERO {
            n
        } else if let Some(largest) = self.cancelled.get(&class) {
            report.cancelled += 1;
            largest.n.as_vec3()
        } else {
            report.without_face += 1;
            Vec3::Y
        }
    }
}

/// The means that did not vanish, zero for the others, and the classes with weights whose mean vanished.
fn settle(sums: &[NormalSum]) -> (Vec<Vec3>, HashMap<u32, Largest>) {
    let settled = |sum: &NormalSum| {
        let length = sum.n.length();
        if length > CANCELLED * sum.weights { (sum.n / length).as_vec3() } else { Vec3::ZERO }
    };
    let normals: Vec<Vec3> = sums.par_iter().with_min_len(PARALLEL_MIN).map(settled).collect();
    let vanished = sums.iter().zip(&normals).enumerate().filter(|(_, (sum, n))| **n == Vec3::ZERO && sum.weights > 0.0);
    let cancelled = vanished.map(|(class, _)| (class as u32, Largest::default())).collect();
    (normals, cancelled)
}

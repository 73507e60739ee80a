//! Patches: runs of triangles that lie close together and face in similar directions.

use std::ops::Range;

use glam::Vec3;

use crate::Mesh;

/// Up to this number of patches, triangles are also separated by the direction they face: with more, borders between
/// directions would run all over the mesh.
const PARTED_BY_FACING: usize = 16;

/// Normals whose components along an axis differ by more than this are separated by direction rather than by position:
/// those of the sides of a thin sheet or of an edge, but not those of a slightly uneven surface.
const FACING_APART: f32 = 0.6;

/// A triangle among others, or a cluster of triangles.
#[derive(Clone, Copy)]
pub(super) struct Site {
    /// Its centre.
    pub(super) place: Vec3,
    /// The mean normal of its corners: the face normal would separate triangles of a noisy surface. 0 to separate by
    /// position alone.
    pub(super) facing: Vec3,
    pub(super) number: u32,
    /// The sort key: a coordinate, as an integer of the same order. Unset at first.
    pub(super) key: u32,
}

/// A mesh of up to this many triangles is one patch: cutting it would cost more draws than it saves.
const WHOLE: usize = 4096;

/// The most triangles in a patch of a larger mesh.
const PATCH: usize = 64;

impl Mesh {
    /// The most triangles in a patch of the mesh: all of them, up to 4096, else 64.
    pub fn triangles_of_a_patch(&self) -> usize {
        if self.triangle_count() <= WHOLE { WHOLE } else { PATCH }
    }

    /// Sorts triangles of the mesh so that neighbours in the list lie close together and face in similar directions,
    /// and cuts them into patches of up to `most` triangles (at least 1), all but one of them full. Within a patch they
    /// keep their order.
    ///
    /// Triangles are halved across the longest side of the box around their centres until a patch is left, as in a k-d
    /// tree; a few patches' triangles that face apart are halved by the longest side of the box around their normals
    /// instead.
    pub fn cut_into_patches(&self, triangles: &mut [[u32; 3]], most: usize) -> Vec<Range<usize>> {
        self.cut(triangles, most, true)
    }

    /// The same, by place alone unless `by_facing`.
    pub(super) fn cut(&self, triangles: &mut [[u32; 3]], most: usize, by_facing: bool) -> Vec<Range<usize>> {
        let most = most.max(1);
        let site = |(number, corners): (u32, &[u32; 3])| {
            let mean = |of: &[Vec3]| corners.iter().map(|&i| of[i as usize] * (1.0 / 3.0)).sum::<Vec3>();
            let facing = if by_facing { mean(self.normals()).normalize_or_zero() } else { Vec3::ZERO };
            Site { place: mean(self.positions()), facing, number, key: 0 }
        };
        let mut sites: Vec<Site> = (0..).zip(triangles.iter()).map(site).collect();
        part(&mut sites, most);
        put_in_order(triangles, &mut sites);
        (0..sites.len()).step_by(most).map(|start| start..(start + most).min(sites.len())).collect()
    }
}

/// Sorts triangles in the order of their sites, following the cycles of the permutation.
fn put_in_order(triangles: &mut [[u32; 3]], sites: &mut [Site]) {
    for first in 0..sites.len() {
        let (mut at, moved) = (first, triangles[first]);
        loop {
            let from = std::mem::replace(&mut sites[at].number, at as u32) as usize;
            if from == first {
                triangles[at] = moved;
                break;
            }
            triangles[at] = triangles[from];
            at = from;
        }
    }
}

/// More triangles than this are halved on two threads.
const WORTH_A_THREAD: usize = 1 << 14;

/// Sorts triangles so that each run of `most` is a patch.
pub(super) fn part(sites: &mut [Site], most: usize) {
    if sites.len() <= most {
        sites.sort_unstable_by_key(|site| site.number);
        return;
    }
    let size = |of: fn(&Site) -> Vec3| {
        let range = |(low, high): (Vec3, Vec3), site: &Site| (low.min(of(site)), high.max(of(site)));
        // Halved first, so that no finite box overflows.
        let (low, high) = sites.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), range);
        high * 0.5 - low * 0.5
    };
    let by_facing = if sites.len() <= PARTED_BY_FACING * most { size(|site| site.facing) } else { Vec3::ZERO };
    let (of, axis): (fn(&Site) -> Vec3, usize) = if by_facing.max_element() > 0.5 * FACING_APART {
        (|site| site.facing, by_facing.max_position())
    } else {
        (|site| site.place, size(|site| site.place).max_position())
    };
    // Whole patches on the first side, so that only the last one of all is not full.
    let half = (sites.len() / 2).next_multiple_of(most).min(sites.len() - 1);
    for site in &mut *sites {
        site.key = ordered(of(site)[axis]);
    }
    sites.select_nth_unstable_by_key(half, |site| u64::from(site.key) << 32 | u64::from(site.number));
    let (first, second) = sites.split_at_mut(half);
    if first.len() > WORTH_A_THREAD {
        rayon::join(|| part(first, most), || part(second, most));
    } else {
        part(first, most);
        part(second, most);
    }
}

/// An integer whose order is that of the numbers by [`f32::total_cmp`].
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_numbers() {
        let numbers =
            [f32::NEG_INFINITY, f32::MIN, -1.0, -f32::MIN_POSITIVE, -0.0, 0.0, 1e-45, 1.0, 2.5, f32::INFINITY];
        assert!(numbers.is_sorted_by(|a, b| a.total_cmp(b).is_lt()));
        assert!(numbers.map(ordered).is_sorted_by(|a, b| a < b));
    }
}

//! Intersections of rays with surfaces that are known by formula.
//!
//! A [`Surface`] is traced piece by piece, so that a picture can be made from the pieces whose [`hull`](Traced::hull)
//! comes near a pixel. Everything is in the space of the mesh, in f64.

mod net;
mod patch;
mod quadric;
mod ray;

#[cfg(test)]
mod tests;

use bevy_math::DVec3;
use halfway_mesh::{Surface, SurfacePiece};

use patch::Patches;
use quadric::{meet_disc, meet_quadric};
use ray::{Ray, extent};

pub(crate) use ray::SurfaceHit;

/// A surface prepared for rays: its patches are cut into small ones.
#[derive(Clone, Debug)]
pub(crate) struct Traced {
    /// The quadrics and the discs.
    plain: Vec<Plain>,
    patches: Patches,
    /// The longest edge of the box around the surface.
    extent: f64,
}

/// A piece that is intersected in closed form.
#[derive(Clone, Debug)]
struct Plain {
    piece: SurfacePiece,
    hull: Vec<DVec3>,
}

/// Two hits that are nearer to each other than this fraction of the surface's extent, and face the same way, are one
/// hit on the common edge of two pieces: far above the rounding of f64, far below a pixel.
const SAME_PLACE: f64 = 1e-9;

impl Traced {
    pub(crate) fn new(surface: &Surface) -> Self {
        let plain: Vec<Plain> = surface.pieces().iter().filter_map(Plain::new).collect();
        let patches = surface.pieces().iter().filter_map(|piece| match piece {
            SurfacePiece::Patch(patch) => Some(patch.clone()),
            _ => None,
        });
        let patches = Patches::new(patches.collect());
        let points = plain.iter().flat_map(|piece| &piece.hull).chain(patches.hulls()).copied();
        let extent = extent(points);
        Self { plain, patches, extent }
    }

    /// How many pieces there are.
    pub(crate) fn pieces(&self) -> usize {
        self.plain.len() + self.patches.len()
    }

    /// Points whose convex hull holds the piece.
    pub(crate) fn hull(&self, piece: usize) -> &[DVec3] {
        match self.plain.get(piece) {
            Some(plain) => &plain.hull,
            None => self.patches.hull(piece - self.plain.len()),
        }
    }

    /// Adds every hit at t > 0 of the ray origin + t·direction with the piece, in any order. The direction is not 0;
    /// its length does not matter.
    ///
    /// No ray is lost between pieces: on an edge that two of them share at least one is hit, often both; see
    /// [`settle`](Self::settle). A ray that only touches the surface hits it twice, once or not at all.
    pub(crate) fn meet(&self, piece: usize, origin: DVec3, direction: DVec3, hits: &mut Vec<SurfaceHit>) {
        let ray = Ray { origin, direction };
        match self.plain.get(piece).map(|plain| &plain.piece) {
            Some(SurfacePiece::Quadric(quadric)) => meet_quadric(quadric, &ray, hits),
            Some(SurfacePiece::Disc(disc)) => meet_disc(disc, &ray, hits),
            _ => self.patches.meet(piece - self.plain.len(), &ray, hits),
        }
    }

    /// Sorts the hits of one ray on all pieces by t, and merges hits of two pieces along their common edge: they lie
    /// together and face the ray with the same side.
    pub(crate) fn settle(&self, direction: DVec3, hits: &mut Vec<SurfaceHit>) {
        hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        let front = |hit: &SurfaceHit| hit.normal.dot(direction) < 0.0;
        let mut settled: Vec<SurfaceHit> = Vec::with_capacity(hits.len());
        for hit in hits.drain(..) {
            let is_same = |kept: &SurfaceHit| {
                kept.position.distance(hit.position) <= SAME_PLACE * self.extent && front(kept) == front(&hit)
            };
            // Hits of another surface that passes through may lie between.
            if !settled.iter().any(is_same) {
                settled.push(hit);
            }
        }
        *hits = settled;
    }
}

impl Plain {
    fn new(piece: &SurfacePiece) -> Option<Self> {
        let hull = match piece {
            SurfacePiece::Quadric(quadric) => {
                let (min, max) = (quadric.min(), quadric.max());
                let pick = |i: usize, bit: usize, axis: usize| if i & bit == 0 { min[axis] } else { max[axis] };
                (0..8).map(|i| DVec3::new(pick(i, 1, 0), pick(i, 2, 1), pick(i, 4, 2))).collect()
            }
            SurfacePiece::Disc(disc) => {
                let (a, b) = disc.normal().any_orthonormal_pair();
                let corner = |x: f64, y: f64| disc.center() + disc.radius() * (x * a + y * b);
                vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
            }
            SurfacePiece::Patch(_) => return None,
        };
        Some(Self { piece: piece.clone(), hull })
    }
}

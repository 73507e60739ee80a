//! What is so coarse or far away that it is shaded at the corners of its triangles.

use crate::geometry::turned::GroupErrors;
use halfway_lighting::Tolerance;

/// How far the corners of coarser triangles may be on the picture, in pixels, from the middle of a pixel that goes by
/// them: they are points of the mesh with its normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadedCorners {
    /// Where all three count: none is farther from a point of the triangle than the longest edge.
    all: f32,
    /// Where the nearest counts.
    nearest: f32,
}

/// Which corners count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CountedCorners {
    /// What is interpolated between shades at all three.
    All,
    /// At each fragment what the nearest shows.
    Nearest,
}

/// How far from a pixel's middle it may be sampled.
const SAMPLED: f32 = 0.5;

/// The most pixels that may go by one corner to each side: more would be seen as facets.
const WIDEST: f32 = 1.0;

/// What the roughness of a surface is over the spread of its normals within a triangle, at least, where the nearest
/// corner stands for what is around it: a third of the spread or more is noise then. (Of noise alone, 0.2; of a ball
/// 0.01, on which corners would be seen as grain.)
const ROUGH: f32 = 0.08;

impl ShadedCorners {
    /// Nothing goes by its corners.
    pub(crate) const NONE: Self = Self { all: 0.0, nearest: 0.0 };

    /// Within a tolerance, where the nearest may or may not count alone.
    pub(crate) fn new(tolerance: Tolerance, may_be_nearest: bool) -> Self {
        let all = tolerance.pixels + SAMPLED;
        Self { all, nearest: if may_be_nearest { all.min(WIDEST) } else { 0.0 } }
    }

    /// The most pixels that a unit of the mesh may take for these triangles to be small enough: no more for a group
    /// than for one whose parts it joins.
    pub(crate) fn pixels_per_unit(self, triangles: &GroupErrors) -> f32 {
        (self.all / triangles.longest_edge).max(self.nearest / triangles.corner_reach)
    }

    /// Which corners count for triangles with these edges and this reach, where a unit of the mesh takes so many
    /// pixels; those of the mesh itself, whose edges are infinite, are not shaded at corners.
    pub(crate) fn counted(
        self,
        [longest_edge, corner_reach]: [f32; 2],
        pixels_per_unit: impl FnOnce() -> f32,
    ) -> Option<CountedCorners> {
        if longest_edge.is_infinite() {
            return None;
        }
        let pixels = pixels_per_unit();
        if corner_reach * pixels <= self.nearest {
            Some(CountedCorners::Nearest)
        } else {
            (longest_edge * pixels <= self.all).then_some(CountedCorners::All)
        }
    }
}

/// How far points are from the nearest corners of their triangles, of what is rough; else infinite.
///
/// A group is rough only where those are whose parts it joins, as roughness is no more for it and the spread no less.
pub(crate) fn reach_of_rough(corner_reach: f32, roughness: f32, normal_spread: f32) -> f32 {
    if roughness > ROUGH * normal_spread { corner_reach } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_smooth_or_far_too_large_goes_by_all_or_none() {
        let tolerance = Tolerance { steps: 1.0, pixels: 0.5 };
        let corners = ShadedCorners::new(tolerance, true);
        let (all, nearest) = (Some(CountedCorners::All), Some(CountedCorners::Nearest));
        let infinite = f32::INFINITY;
        for (edge, reach, pixels, expected) in [
            (1.0, 0.55, 0.9, nearest),
            (1.0, 0.55, 1.8, nearest),
            (1.0, 0.55, 1.9, None),
            (1.0, infinite, 0.9, all),
            (1.0, infinite, 1.1, None),
            (infinite, infinite, 1e-6, None),
        ] {
            assert_eq!(corners.counted([edge, reach], || pixels), expected, "{edge}, {reach}, {pixels}");
            let is_nearest = expected == nearest;
            let expected = if is_nearest { (pixels <= 1.0 / edge).then_some(CountedCorners::All) } else { expected };
            assert_eq!(ShadedCorners::new(tolerance, false).counted([edge, reach], || pixels), expected, "all alone");
        }
        // Where much may move, one corner does not stand for as much.
        let wide = ShadedCorners::new(Tolerance { pixels: 3.5, ..tolerance }, true);
        assert_eq!([1.0, 1.9, 3.0].map(|pixels| wide.counted([1.0, 0.55], || pixels)), [nearest, all, all]);
        assert_eq!(ShadedCorners::NONE.counted([1.0, 0.55], || 1e-3), None);
        let reaches = [0.07, 0.09].map(|roughness| reach_of_rough(0.5, roughness, 1.0));
        assert_eq!(reaches.map(f32::to_bits), [infinite, 0.5].map(f32::to_bits));
    }
}

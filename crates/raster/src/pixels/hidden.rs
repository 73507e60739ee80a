//! Occlusion culling within a tile, with one sample a pixel: triangles behind drawn ones are neither lit nor drawn.

use crate::pixels::cover::{TINY_AT, TINY_PIXELS, TileBuffer};
use crate::simd::lanes::{Simd, counting_i, lanes, load, splat, splat_i};
use crate::vertices::placed::TILE;
use fearless_simd::prelude::*;

/// Pixels of a tile.
const PIXELS: usize = TILE * TILE;

impl TileBuffer {
    /// Whether a triangle of few pixels, with one sample each, is nowhere nearer than what has been drawn: its nearness is
    /// at most `most`.
    #[inline(always)]
    pub(crate) fn hides_tiny(&self, (pixels, first): (i32, [i32; 2]), most: f32) -> bool {
        let first = first[1] as usize * TILE + first[0] as usize;
        let depths = &self.depth[0];
        let mut left = pixels as u32;
        while left != 0 {
            let bit = left.trailing_zeros() as usize % TINY_PIXELS;
            if most > depths[(first + TINY_AT[bit]) % PIXELS] {
                return false;
            }
            left &= left - 1;
        }
        true
    }

    /// Whether all of some columns and rows show something that is at least as near as this.
    #[inline(always)]
    pub(crate) fn hides<S: Simd>(&self, simd: S, first: [usize; 2], last: [usize; 2], nearest: f32) -> bool {
        let nearest = splat(simd, nearest);
        let mut next = first[0];
        while next <= last[0] {
            // The last strip may begin earlier, so that it ends with the tile.
            let i = next.min(TILE - lanes::<S>());
            let column = counting_i(simd) + splat_i(simd, i as i32);
            let inside = column.simd_ge(splat_i(simd, first[0] as i32)) & column.simd_le(splat_i(simd, last[0] as i32));
            for row in first[1]..=last[1] {
                if (inside & load(simd, &self.depth[0], row * TILE + i).simd_lt(nearest)).any_true() {
                    return false;
                }
            }
            next = i + lanes::<S>();
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixels::cover::TINY_PLACES;
    use crate::simd::width::{VectorWidth, with_vectors};
    use halfway_lighting::Samples;

    const NEAR: f32 = 2.0;

    /// A tile that shows something at `NEAR` in all pixels but one.
    fn tile_with_a_hole([column, row]: [usize; 2]) -> TileBuffer {
        let mut tile = TileBuffer::new();
        tile.prepare(Samples::One, false, false);
        tile.depth[0].fill(NEAR);
        tile.depth[0][row * TILE + column] = 1.0;
        tile
    }

    fn hides(tile: &TileBuffer, first: [usize; 2], last: [usize; 2], nearest: f32, width: VectorWidth) -> bool {
        let level = width.level().expect("an available width");
        with_vectors!(level, simd => tile.hides(simd, first, last, nearest))
    }

    #[test]
    fn a_box_is_hidden_unless_one_of_its_pixels_is_not() {
        for width in VectorWidth::available() {
            for hole in [[0, 0], [5, 3], [31, 40], [62, 9], [63, 63]] {
                let tile = tile_with_a_hole(hole);
                for first in [[0, 0], [5, 3], [6, 3], [5, 4], [30, 39], [56, 0], [63, 63]] {
                    for last in [[5, 3], [4, 63], [31, 40], [61, 9], [62, 8], [63, 62], [63, 63]] {
                        if first[0] > last[0] || first[1] > last[1] {
                            continue;
                        }
                        let holds = [0, 1].iter().all(|&axis| (first[axis]..=last[axis]).contains(&hole[axis]));
                        assert_eq!(hides(&tile, first, last, NEAR, width), !holds, "{hole:?} in {first:?} to {last:?}");
                        // At equal depth the first drawn stays; anything nearer shows.
                        assert!(!hides(&tile, first, last, NEAR.next_up(), width));
                        assert!(hides(&tile, first, last, 1.0, width));
                    }
                }
            }
        }
    }

    #[test]
    fn a_tiny_triangle_is_hidden_unless_one_of_its_pixels_is_not() {
        let first = [20_i32, 30];
        for hole in 0..TINY_PIXELS {
            let place = [0, 1].map(|axis: usize| first[axis] as usize + TINY_PLACES[axis][hole] as usize);
            let tile = tile_with_a_hole(place);
            let all = (1 << TINY_PIXELS) - 1;
            assert!(!tile.hides_tiny((all, first), NEAR));
            assert!(!tile.hides_tiny((1 << hole, first), NEAR));
            assert!(tile.hides_tiny((all & !(1 << hole), first), NEAR));
            assert!(!tile.hides_tiny((all & !(1 << hole), first), NEAR.next_up()));
            assert!(tile.hides_tiny((all, first), 1.0));
        }
    }
}

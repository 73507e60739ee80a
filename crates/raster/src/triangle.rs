//! Triangles of a piece, as many at once as there are lanes: which pixels of the tile they may cover, and their edges.

use crate::lanes::{I, M, MOST_LANES, Simd, each, load_i, splat_i, store_i};
use crate::pass::{LeftOut, SampleCount};
use crate::vertices::{CLIPPED, GRID, Vertices};
use fearless_simd::prelude::*;

/// The longest side of a triangle's box on the grid that 32 bits take without care.
const SMALL: i32 = 64 * GRID;

type Lanes = [i32; MOST_LANES];

/// Up to as many triangles as there are lanes, relative to a tile.
#[derive(Default)]
pub(crate) struct Batch {
    /// The lanes of triangles that may cover pixels.
    pub(crate) small: u64,
    /// The lanes of triangles that must be clipped, or are large.
    pub(crate) others: u64,
    /// The lanes that show their backs, as far as that is known.
    pub(crate) backs: u64,
    /// The lanes whose area is positive: clockwise on the picture.
    pub(crate) clockwise: u64,
    /// Edge functions at the center of the tile's first pixel, less 1 where an edge does not own its pixels.
    pub(crate) edge: [Lanes; 3],
    /// By how much they grow from pixel to pixel, over 256.
    pub(crate) across: [Lanes; 3],
    pub(crate) down: [Lanes; 3],
    /// First and last column, first and last row of pixels that may be covered.
    pub(crate) bounds: [Lanes; 4],
}

/// What a batch has to know of the draw and the tile.
#[derive(Clone, Copy)]
pub(crate) struct Covering {
    pub(crate) left_out: LeftOut,
    /// Fronts wind clockwise.
    pub(crate) clockwise: bool,
    pub(crate) samples: SampleCount,
    /// The last column and row of the tile that are in the picture.
    pub(crate) last: [i32; 2],
}

impl Covering {
    /// How far samples lie from a pixel's center, in steps of the grid.
    pub(crate) fn reach(&self) -> i32 {
        match self.samples {
            SampleCount::One => 0,
            SampleCount::Four => 6 * GRID / 16,
        }
    }
}

impl Batch {
    /// Sets up `triangles`, at most as many as there are lanes.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(&mut self, simd: S, triangles: &[[u8; 3]], vertices: &Vertices, covering: &Covering) {
        let mut corners = [[0; MOST_LANES]; 3];
        let mut code_and = [0; MOST_LANES];
        let mut code_or = [0; MOST_LANES];
        for (lane, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                corners[k][lane] = vertices.packed[usize::from(triangle[k])];
            }
        }
        self.others = 0;
        let mut usable = M::<S>::from_bitmask(simd, (1 << triangles.len()) - 1);
        if vertices.any_code != 0 {
            for (lane, triangle) in triangles.iter().enumerate() {
                let [a, b, c] = each!(k in 3 => vertices.codes[usize::from(triangle[k])]);
                (code_and[lane], code_or[lane]) = (a & b & c, a | b | c);
            }
            let zero = splat_i(simd, 0);
            let clipped = load_i(simd, &code_or, 0).simd_gt(zero);
            let gone = (load_i(simd, &code_and, 0) & splat_i(simd, CLIPPED)).simd_gt(zero);
            self.others = (clipped & !gone & usable).to_bitmask();
            usable &= !clipped;
        }
        self.set_up(simd, each!(k in 3 => load_i(simd, &corners[k], 0)), usable, covering);
    }

    #[inline(always)]
    fn set_up<S: Simd>(&mut self, simd: S, packed: [I<S>; 3], usable: M<S>, covering: &Covering) {
        // From the center of the tile's first pixel.
        let from_center = splat_i(simd, 32 * GRID - GRID / 2);
        let x = each!(k in 3 => ((packed[k] << 16) >> 16) + from_center);
        let y = each!(k in 3 => (packed[k] >> 16) + from_center);
        let low = [least::<S>(x), least::<S>(y)];
        let high = [most::<S>(x), most::<S>(y)];
        let large = (high[0] - low[0]).simd_gt(splat_i(simd, SMALL)) | (high[1] - low[1]).simd_gt(splat_i(simd, SMALL));
        let reach = covering.reach();
        let mut meets = usable;
        for axis in 0..2 {
            let first = (low[axis] + splat_i(simd, GRID - 1 - reach)) >> 8;
            let last = (high[axis] + splat_i(simd, reach)) >> 8;
            let first = SimdBase::max(first, splat_i(simd, 0));
            let last = SimdBase::min(last, splat_i(simd, covering.last[axis]));
            meets &= first.simd_le(last);
            store_i::<S>(first, &mut self.bounds[2 * axis], 0);
            store_i::<S>(last, &mut self.bounds[2 * axis + 1], 0);
        }
        let zero = splat_i(simd, 0);
        let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        let clockwise = area.simd_gt(zero);
        let front = if covering.clockwise { clockwise } else { area.simd_lt(zero) };
        let shown = match covering.left_out {
            LeftOut::Back => front,
            LeftOut::Front => !front & !area.simd_eq(zero),
            LeftOut::Neither => !area.simd_eq(zero),
        };
        self.others |= (meets & large).to_bitmask();
        self.small = (meets & shown & !large).to_bitmask();
        self.backs = (!front).to_bitmask();
        self.clockwise = clockwise.to_bitmask();
        if self.small != 0 {
            // Corners in the order that makes the area positive.
            let second = [clockwise.select(x[1], x[2]), clockwise.select(y[1], y[2])];
            let third = [clockwise.select(x[2], x[1]), clockwise.select(y[2], y[1])];
            let corners = [[x[0], y[0]], second, third];
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let (across, down) = (from[1] - to[1], to[0] - from[0]);
                let owns = across.simd_gt(zero) | (across.simd_eq(zero) & down.simd_gt(zero));
                let bias = owns.select(zero, splat_i(simd, -1));
                store_i::<S>(bias - across * from[0] - down * from[1], &mut self.edge[k], 0);
                store_i::<S>(across, &mut self.across[k], 0);
                store_i::<S>(down, &mut self.down[k], 0);
            }
        }
    }
}

#[inline(always)]
fn least<S: Simd>(v: [I<S>; 3]) -> I<S> {
    SimdBase::min(SimdBase::min(v[0], v[1]), v[2])
}

#[inline(always)]
fn most<S: Simd>(v: [I<S>; 3]) -> I<S> {
    SimdBase::max(SimdBase::max(v[0], v[1]), v[2])
}

//! Sets up triangles of a piece, one vector at a time: the pixels of the tile that they may cover, their edges, and the
//! slopes of interpolated numbers.

use crate::input::attributes::SLOTS;
use crate::input::pieces::PIECE_TRIANGLES;
use crate::simd::lanes::{
    F, I, M, MOST_LANES, Simd, each, f32x4, lanes, load_i, splat, splat_i, store, store_fours_i, store_i,
};
use crate::triangles::planes::{DepthPlane, FLATTEST, LaneSlopes, Slopes};
use crate::triangles::samples::GRID_PLACES;
use crate::vertices::transform::{CLIPPED, FAR_AWAY, GRID, SMALL, Vertices, places_by_axis};
use fearless_simd::prelude::*;
use halfway_lighting::Samples;
use halfway_lighting::record::Cull;

/// Columns and rows of the box of a tiny triangle, at most.
pub(crate) const TINY: usize = 5;

type Lanes = [i32; MOST_LANES];

/// The corners of a piece's triangles, gathered from the vertices.
pub(crate) struct Corners {
    /// By corner: a number of each axis a triangle, in the order of [`Vertices::places`].
    places: [[[i32; 2]; PIECE_TRIANGLES]; 3],
    /// Whether some triangle has to be clipped; then all its corners' codes, and what they have in common.
    any_code: bool,
    code_or: [i32; PIECE_TRIANGLES],
    code_and: [i32; PIECE_TRIANGLES],
}

impl Corners {
    pub(crate) fn new() -> Self {
        Self {
            places: [[[0; 2]; PIECE_TRIANGLES]; 3],
            any_code: false,
            code_or: [0; PIECE_TRIANGLES],
            code_and: [0; PIECE_TRIANGLES],
        }
    }

    /// Gathers them. `rest` is the mesh's list of triangles from the piece's `count` ones on.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(
        &mut self,
        simd: S,
        (rest, count): (&[[u8; 3]], usize),
        vertices: &Vertices,
        vertex_count: usize,
    ) {
        let triangles = &rest[..count.min(PIECE_TRIANGLES)];
        if places_by_axis::<S>() {
            self.shuffle(simd, (rest.as_flattened(), triangles.len()), vertices, vertex_count);
        } else {
            for (k, &[a, b, c]) in triangles.iter().enumerate() {
                self.places[0][k] = vertices.places[usize::from(a)];
                self.places[1][k] = vertices.places[usize::from(b)];
                self.places[2][k] = vertices.places[usize::from(c)];
            }
        }
        self.any_code = vertices.any_code != 0;
        if self.any_code {
            for ((triangle, or), and) in triangles.iter().zip(&mut self.code_or).zip(&mut self.code_and) {
                let [a, b, c] = each!(k in 3 => vertices.codes[usize::from(triangle[k])]);
                (*or, *and) = (a | b | c, a & b & c);
            }
        }
    }

    /// Gathers places by axis: each shuffle takes the numbers of a vector of triangles out of those of 32 vertices.
    #[inline(always)]
    fn shuffle<S: Simd>(&mut self, simd: S, (rest, count): (&[u8], usize), vertices: &Vertices, vertex_count: usize) {
        let from = vertices.places.as_flattened();
        for at in (0..count).step_by(lanes::<S>()) {
            let mut last = [0; 4 * MOST_LANES];
            let of_these = rest[3 * at..].first_chunk().unwrap_or_else(|| {
                last[..rest.len() - 3 * at].copy_from_slice(&rest[3 * at..]);
                &last
            });
            let of_these = S::u8s::from_slice(simd, of_these);
            for k in 0..3 {
                // The number of the corner's vertex, four times.
                let number: I<S> = of_these.swizzle_dyn(S::u8s::from_slice(simd, &CORNER_BYTES[k])).bitcast();
                let bytes = ((number & splat_i(simd, 0x1f1f_1f1f)) << 2) | splat_i(simd, 0x0302_0100);
                let bytes: S::u8s = bytes.bitcast();
                let to = self.places[k].as_flattened_mut();
                for axis in 0..2 {
                    let list = &from[axis * SLOTS..];
                    let mut place = of_32::<S>(simd, list, 0, bytes);
                    for first in (32..vertex_count).step_by(32) {
                        let these = (number >> 5 & splat_i(simd, 7)).simd_eq(splat_i(simd, first as i32 / 32));
                        place = these.select(of_32::<S>(simd, list, first, bytes), place);
                    }
                    store_i::<S>(place, to, axis * PIECE_TRIANGLES + at);
                }
            }
        }
    }

    /// x and y of one corner of the triangles from `at` on.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, corner: usize, at: usize) -> (I<S>, I<S>) {
        let list = self.places[corner].as_flattened();
        if places_by_axis::<S>() {
            (load_i(simd, list, at), load_i(simd, list, PIECE_TRIANGLES + at))
        } else {
            load_i(simd, list, 2 * at).deinterleave(load_i(simd, list, 2 * at + lanes::<S>()))
        }
    }
}

/// Takes numbers out of 32 from `first` on: each byte of a lane from the place that `bytes` says.
#[inline(always)]
fn of_32<S: Simd>(simd: S, list: &[i32], first: usize, bytes: S::u8s) -> I<S> {
    load_i(simd, list, first).concat_swizzle_dyn(load_i(simd, list, first + lanes::<S>()), bytes)
}

/// For each corner the place of its number among the bytes of a vector of triangles, four times a lane.
const CORNER_BYTES: [[u8; 4 * MOST_LANES]; 3] = {
    let (mut bytes, mut k) = ([[0; 4 * MOST_LANES]; 3], 0);
    while k < 3 * 4 * MOST_LANES {
        let (corner, byte) = (k / (4 * MOST_LANES), k % (4 * MOST_LANES));
        bytes[corner][byte] = (byte / 4 * 3 + corner) as u8;
        k += 1;
    }
    bytes
};

/// A vector of triangles, relative to a tile.
#[derive(Default)]
pub(crate) struct Batch {
    /// The lanes of triangles that cover some of a few pixels.
    pub(crate) tiny: u64,
    /// The lanes of larger ones that may cover pixels.
    pub(crate) small: u64,
    /// The tiny triangles among them, if they are not separated.
    pub(crate) few: u64,
    /// The lanes of triangles that must be clipped, or are large.
    pub(crate) others: u64,
    /// The lanes that are known to show their backs.
    pub(crate) backs: u64,
    /// Edge functions at the center of the first pixel that may be covered, less 1 if an edge does not own its pixels.
    pub(crate) edge: [Lanes; 3],
    /// Their growth from pixel to pixel, divided by 256.
    pub(crate) across: [Lanes; 3],
    pub(crate) down: [Lanes; 3],
    /// First and last column, first and last row of pixels that may be covered.
    pub(crate) bounds: [Lanes; 4],
    /// The covered pixels of tiny triangles: bit [`TINY`]·row + column, counted from the first that may be covered.
    pub(crate) pixels: Lanes,
    /// With four samples the pixels whose samples are covered, by sample.
    pub(crate) samples: [[i32; 4]; MOST_LANES],
    /// The weights of slopes: see [`Batch::slopes`].
    weights: [[f32; MOST_LANES]; 6],
    /// The last two of them, with the first pixel that may be covered as the base.
    near: [[f32; MOST_LANES]; 2],
}

/// Inputs of a batch from the draw and the tile.
#[derive(Clone, Copy)]
pub(crate) struct Covering {
    pub(crate) cull: Cull,
    /// Fronts wind clockwise.
    pub(crate) clockwise: bool,
    pub(crate) samples: Samples,
    /// The last column and row of the tile that are in the picture.
    pub(crate) last: [i32; 2],
    /// Whether triangles store only their depth and the leading numbers; tiny ones are then separated.
    pub(crate) is_plain: bool,
}

impl Covering {
    /// The distance of samples from a pixel's center, in steps of the grid.
    pub(crate) fn reach(&self) -> i32 {
        match self.samples {
            Samples::One => 0,
            _ => 6 * GRID / 16,
        }
    }
}

/// The set-up of a batch's triangles, with derived values.
struct Outlines<S: Simd> {
    /// Corners from the center of the tile's first pixel, on the grid.
    x: [I<S>; 3],
    y: [I<S>; 3],
    first: [I<S>; 2],
    last: [I<S>; 2],
    clockwise: M<S>,
    /// The triangles that may cover pixels, and are neither clipped nor large.
    meet: M<S>,
    /// The tiny triangles, and those of them that are separated.
    few: M<S>,
    tiny: M<S>,
}

impl Batch {
    /// Sets up the triangles from `at` on, `count` of them, at most as many as there are lanes.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(&mut self, simd: S, corners: &Corners, at: usize, count: usize, covering: &Covering) {
        self.others = 0;
        let mut usable = M::<S>::from_bitmask(simd, (1 << count) - 1);
        let mut far_away = M::<S>::splat(simd, false);
        if corners.any_code {
            let zero = splat_i(simd, 0);
            let code = load_i(simd, &corners.code_or, at);
            let clipped = (code & splat_i(simd, CLIPPED)).simd_gt(zero);
            let gone = (load_i(simd, &corners.code_and, at) & splat_i(simd, CLIPPED)).simd_gt(zero);
            self.others = (clipped & !gone & usable).to_bitmask();
            usable &= !clipped;
            far_away = (code & splat_i(simd, FAR_AWAY)).simd_gt(zero);
        }
        let places = each!(k in 3 => corners.places(simd, k, at));
        let outlines = self.find(simd, &places, (usable, far_away), covering);
        let meet = outlines.meet.to_bitmask();
        (self.tiny, self.small, self.few) = (0, 0, 0);
        if meet != 0 {
            self.set_edges(simd, &outlines);
            let mut covers = outlines.meet;
            if outlines.tiny.any_true() {
                covers &= self.find_pixels(simd, &outlines, covering.samples);
            }
            self.tiny = (covers & outlines.tiny).to_bitmask();
            self.small = (covers & !outlines.tiny).to_bitmask();
            if !covering.is_plain {
                self.few = outlines.few.to_bitmask();
            }
            if self.tiny | self.small != 0 {
                self.weigh(simd, &places, &outlines);
            }
        }
    }

    /// Finds the triangles that show their fronts and may cover pixels.
    #[inline(always)]
    fn find<S: Simd>(
        &mut self,
        simd: S,
        places: &[(I<S>, I<S>); 3],
        (usable, far_away): (M<S>, M<S>),
        covering: &Covering,
    ) -> Outlines<S> {
        // From the center of the tile's first pixel; what is within a step of the grid is rounded away.
        let (half, from_center) = (splat_i(simd, 0x8000), splat_i(simd, 32 * GRID - GRID / 2));
        let x = each!(k in 3 => ((places[k].0 + half) >> 16) + from_center);
        let y = each!(k in 3 => ((places[k].1 + half) >> 16) + from_center);
        let low = [least::<S>(x), least::<S>(y)];
        let high = [most::<S>(x), most::<S>(y)];
        let side = SimdBase::max(high[0] - low[0], high[1] - low[1]);
        // Corners far away touch the tile in the same columns and rows, but their edges differ.
        let large = side.simd_gt(splat_i(simd, SMALL)) | far_away;
        let reach = covering.reach();
        let first = each!(axis in 2 => {
            SimdBase::max((low[axis] + splat_i(simd, GRID - 1 - reach)) >> 8, splat_i(simd, 0))
        });
        let last = each!(axis in 2 => {
            SimdBase::min((high[axis] + splat_i(simd, reach)) >> 8, splat_i(simd, covering.last[axis]))
        });
        let meets = usable & first[0].simd_le(last[0]) & first[1].simd_le(last[1]);
        let zero = splat_i(simd, 0);
        let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        let clockwise = area.simd_gt(zero);
        let front = if covering.clockwise { clockwise } else { area.simd_lt(zero) };
        let shown = match covering.cull {
            Cull::Back => front,
            Cull::Front => !front & !area.simd_eq(zero),
            Cull::None => !area.simd_eq(zero),
        };
        self.others |= (meets & large).to_bitmask();
        self.backs = (!front).to_bitmask();
        let meet = meets & shown & !large;
        let box_side = SimdBase::max(last[0] - first[0], last[1] - first[1]);
        let few = meet & box_side.simd_lt(splat_i(simd, TINY as i32));
        let tiny = if covering.is_plain { few } else { M::<S>::splat(simd, false) };
        Outlines { x, y, first, last, clockwise, meet, few, tiny }
    }

    #[inline(always)]
    fn set_edges<S: Simd>(&mut self, simd: S, outlines: &Outlines<S>) {
        let Outlines { x, y, first, last, clockwise, .. } = *outlines;
        for axis in 0..2 {
            store_i::<S>(first[axis], &mut self.bounds[2 * axis], 0);
            store_i::<S>(last[axis], &mut self.bounds[2 * axis + 1], 0);
        }
        // Corners in the order that makes the area positive.
        let second = [clockwise.select(x[1], x[2]), clockwise.select(y[1], y[2])];
        let third = [clockwise.select(x[2], x[1]), clockwise.select(y[2], y[1])];
        let corners = [[x[0], y[0]], second, third];
        let start = [first[0] << 8, first[1] << 8];
        let zero = splat_i(simd, 0);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let (across, down) = (from[1] - to[1], to[0] - from[0]);
            let owns = across.simd_gt(zero) | (across.simd_eq(zero) & down.simd_gt(zero));
            let bias = owns.select(zero, splat_i(simd, -1));
            let edge = across * (start[0] - from[0]) + down * (start[1] - from[1]) + bias;
            store_i::<S>(edge, &mut self.edge[k], 0);
            store_i::<S>(across, &mut self.across[k], 0);
            store_i::<S>(down, &mut self.down[k], 0);
        }
    }

    /// Finds the pixels that tiny triangles cover; returns the triangles that may cover some.
    #[inline(always)]
    fn find_pixels<S: Simd>(&mut self, simd: S, outlines: &Outlines<S>, samples: Samples) -> M<S> {
        let zero = splat_i(simd, 0);
        let pixels = self.covered(simd, outlines, [0; 2]);
        store_i::<S>(pixels, &mut self.pixels, 0);
        let mut any = pixels;
        if samples == Samples::Four {
            let by_sample = each!(k in 4 => self.covered(simd, outlines, GRID_PLACES[k]));
            any = by_sample[0] | by_sample[1] | by_sample[2] | by_sample[3];
            store_fours_i::<S>(by_sample, &mut self.samples, 0);
        }
        !outlines.tiny | any.simd_gt(zero)
    }

    /// The pixels whose sample at this offset from the center tiny triangles cover.
    #[inline(always)]
    fn covered<S: Simd>(&self, simd: S, outlines: &Outlines<S>, [x, y]: [i32; 2]) -> I<S> {
        let Outlines { first, last, tiny, .. } = *outlines;
        let across = each!(k in 3 => load_i(simd, &self.across[k], 0));
        let down = each!(k in 3 => load_i(simd, &self.down[k], 0));
        let mut row = each!(k in 3 => {
            (load_i(simd, &self.edge[k], 0) + across[k] * splat_i(simd, x) + down[k] * splat_i(simd, y)) >> 8
        });
        // Below 0 in columns and rows beyond the last.
        let columns = last[0] - first[0];
        let mut rows = last[1] - first[1];
        let (zero, one) = (splat_i(simd, 0), splat_i(simd, 1));
        let mut pixels = zero;
        for j in 0..TINY {
            if !(tiny & rows.simd_ge(zero)).any_true() {
                break;
            }
            let mut e = row;
            let mut column = columns;
            for i in 0..TINY {
                if !(tiny & column.simd_ge(zero)).any_true() {
                    break;
                }
                let outside = (e[0] | e[1] | e[2] | column | rows) >> 31;
                pixels |= splat_i(simd, 1 << (TINY * j + i)) & !outside;
                for k in 0..3 {
                    e[k] += across[k];
                }
                column -= one;
            }
            for k in 0..3 {
                row[k] += down[k];
            }
            rows -= one;
        }
        pixels
    }

    /// Prepares [`Batch::slopes`].
    #[inline(always)]
    fn weigh<S: Simd>(&mut self, simd: S, places: &[(I<S>, I<S>); 3], outlines: &Outlines<S>) {
        // In pixels from the tile's center.
        let unit = splat(simd, 1.0 / (GRID << 16) as f32);
        let mut x = each!(k in 3 => places[k].0.to_float::<F<S>>() * unit);
        let mut y = each!(k in 3 => places[k].1.to_float::<F<S>>() * unit);
        let mut area = area::<S>(x, y);
        let area_on_picture = outlines.clockwise.select(area, -area);
        let longest = SimdBase::max(extent::<S>(x), extent::<S>(y));
        let unsound = !area_on_picture.simd_ge(longest * splat(simd, FLATTEST));
        if (unsound & outlines.meet).any_true() {
            let (step, middle) = (splat(simd, 1.0 / GRID as f32), splat_i(simd, 32 * GRID - GRID / 2));
            for k in 0..3 {
                x[k] = unsound.select((outlines.x[k] - middle).to_float::<F<S>>() * step, x[k]);
                y[k] = unsound.select((outlines.y[k] - middle).to_float::<F<S>>() * step, y[k]);
            }
            area = self::area::<S>(x, y);
        }
        let inverse = splat(simd, 1.0) / area;
        let middle = splat(simd, 31.5);
        let zero = splat_i(simd, 0);
        let first = each!(axis in 2 => outlines.tiny.select(outlines.first[axis], zero));
        let to_first = each!(axis in 2 => first[axis].to_float::<F<S>>() - middle);
        let weights = [
            (y[2] - y[0]) * inverse,
            (y[1] - y[0]) * inverse,
            (x[1] - x[0]) * inverse,
            (x[2] - x[0]) * inverse,
            to_first[0] - x[0],
            to_first[1] - y[0],
        ];
        for k in 0..6 {
            store::<S>(weights[k], &mut self.weights[k], 0);
        }
        if self.few != 0 {
            for (axis, place) in [x[0], y[0]].into_iter().enumerate() {
                let to_first = outlines.first[axis].to_float::<F<S>>() - middle;
                store::<S>(to_first - place, &mut self.near[axis], 0);
            }
        }
    }

    /// The slopes of four numbers in a tiny or small lane, from their values at the three corners.
    #[inline(always)]
    pub(crate) fn slopes<S: Simd>(&self, simd: S, lane: usize, values: [&[f32; 4]; 3]) -> LaneSlopes<S> {
        self.slopes_from(simd, lane, [self.weights[4][lane], self.weights[5][lane]], values)
    }

    /// The same for a lane that is not tiny, with the first pixel that may be covered as the base.
    #[inline(always)]
    pub(crate) fn slopes_near<S: Simd>(&self, simd: S, lane: usize, values: [&[f32; 4]; 3]) -> LaneSlopes<S> {
        let to_first = each!(axis in 2 => self.weights[4 + axis][lane] + self.bounds[2 * axis][lane] as f32);
        self.slopes_from(simd, lane, to_first, values)
    }

    /// The nearness of a lane that is small, from that and more at its corners.
    #[inline(always)]
    pub(crate) fn depth<S: Simd>(&self, simd: S, lane: usize, values: [&[f32; 4]; 3]) -> DepthPlane {
        if self.few >> lane & 1 == 0 {
            return DepthPlane::new(&Slopes::of_lane(&self.slopes(simd, lane, values)), [0; 2]);
        }
        let slopes = self.slopes_from(simd, lane, each!(axis in 2 => self.near[axis][lane]), values);
        DepthPlane::new(&Slopes::of_lane(&slopes), [self.bounds[0][lane], self.bounds[2][lane]])
    }

    #[inline(always)]
    fn slopes_from<S: Simd>(&self, simd: S, lane: usize, to_first: [f32; 2], values: [&[f32; 4]; 3]) -> LaneSlopes<S> {
        let v = each!(k in 3 => f32x4::load_array_ref(simd, values[k]));
        let w = each!(k in 4 => f32x4::simd_from(simd, self.weights[k][lane]));
        let [to_x, to_y] = each!(axis in 2 => f32x4::simd_from(simd, to_first[axis]));
        let (d1, d2) = (v[1] - v[0], v[2] - v[0]);
        let dx = d1.mul_sub_precise(w[0], d2 * w[1]);
        let dy = d2.mul_sub_precise(w[2], d1 * w[3]);
        LaneSlopes { base: dy.mul_add_precise(to_y, dx.mul_add_precise(to_x, v[0])), dx, dy }
    }
}

/// Twice the area, from the corners' places.
#[inline(always)]
fn area<S: Simd>(x: [F<S>; 3], y: [F<S>; 3]) -> F<S> {
    (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
}

#[inline(always)]
fn extent<S: Simd>(v: [F<S>; 3]) -> F<S> {
    let most = SimdBase::max(SimdBase::max(v[0], v[1]), v[2]);
    most - SimdBase::min(SimdBase::min(v[0], v[1]), v[2])
}

#[inline(always)]
fn least<S: Simd>(v: [I<S>; 3]) -> I<S> {
    SimdBase::min(SimdBase::min(v[0], v[1]), v[2])
}

#[inline(always)]
fn most<S: Simd>(v: [I<S>; 3]) -> I<S> {
    SimdBase::max(SimdBase::max(v[0], v[1]), v[2])
}

//! Coverage of a triangle's pixels, the depth test, and the values stored for shading.

use crate::lighting::state::{Stage, State};
use crate::pixels::look::Look;
use crate::pixels::mapped_pixels::MappedPixels;
use crate::simd::lanes::{
    F, I, M, Simd, counting, counting_i, each, f32x4, fma, lanes, load, load_i, max, max_one, min, min_one, replace,
    splat, splat_i, store_i,
};
use crate::triangles::mapped::MappedTriangle;
use crate::triangles::planes::{DepthPlane, LaneSlopes, Planes, Slopes};
use crate::triangles::samples::GRID_PLACES;
use crate::triangles::setup::{Batch, TINY};
use crate::vertices::placed::TILE;
use crate::vertices::transform::GRID;
use fearless_simd::prelude::*;
use halfway_lighting::Samples;

/// Pixels of a tile.
pub(crate) const PIXELS: usize = TILE * TILE;

/// Numbers in a list of the tile's buffer: one a pixel, and one more cache line. With lists of 16 KiB the numbers of a
/// pixel would compete for the same few cache lines.
const LIST: usize = PIXELS + 16;

/// Pixels of a tiny triangle's box, at most.
pub(crate) const TINY_PIXELS: usize = TINY * TINY;
/// Their columns and rows.
pub(crate) const TINY_PLACES: [[f32; TINY_PIXELS]; 2] = {
    let (mut places, mut k) = ([[0.0; TINY_PIXELS]; 2], 0);
    while k < TINY_PIXELS {
        (places[0][k], places[1][k]) = ((k % TINY) as f32, (k / TINY) as f32);
        k += 1;
    }
    places
};
/// Their offsets from the first in the tile's lists.
pub(crate) const TINY_AT: [usize; TINY_PIXELS] = {
    let (mut at, mut k) = ([0; TINY_PIXELS], 0);
    while k < TINY_PIXELS {
        at[k] = k / TINY * TILE + k % TINY;
        k += 1;
    }
    at
};

/// Three edge functions over a tile: a pixel is covered if none is below 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EdgeFunctions {
    /// At the samples of the first pixel.
    pub(crate) at: [[i32; 4]; 3],
    /// At its center.
    pub(crate) center: [i32; 3],
    pub(crate) across: [i32; 3],
    pub(crate) down: [i32; 3],
    /// First and last column, first and last row.
    pub(crate) bounds: [i32; 4],
}

impl EdgeFunctions {
    /// Those of one lane.
    #[inline(always)]
    pub(crate) fn of_lane(batch: &Batch, lane: usize, samples: Samples) -> Self {
        let mut edges = Self {
            across: each!(k in 3 => batch.across[k][lane]),
            down: each!(k in 3 => batch.down[k][lane]),
            bounds: each!(k in 4 => batch.bounds[k][lane]),
            ..Self::default()
        };
        let [left, _, top, _] = edges.bounds;
        for k in 0..3 {
            let (across, down) = (edges.across[k], edges.down[k]);
            let edge = batch.edge[k][lane] - GRID * (across * left + down * top);
            edges.center[k] = edge >> 8;
            match samples {
                Samples::One => edges.at[k][0] = edges.center[k],
                _ => {
                    for (at, [dx, dy]) in edges.at[k].iter_mut().zip(GRID_PLACES) {
                        *at = (edge + across * dx + down * dy) >> 8;
                    }
                }
            }
        }
        edges
    }
}

/// Stored as the second sample's shader: all samples of the pixel equal the first one.
pub(crate) const EVEN: i32 = -1;

/// The nearest surface at each sample of a tile. With four samples each list holds all pixels' first samples, then all
/// second ones, and so on; the depths of a pixel's samples lie side by side.
pub(crate) struct TileBuffer {
    /// The [nearness](halfway_lighting::Lens::nearness), 0 where nothing is.
    pub(crate) depth: Vec<[f32; LIST]>,
    /// The number of its shader: 0 for nothing, else 2 + 2·state + 1 for backs; in the upper bits 2²⁸·the centroid's
    /// number. If the second sample's is [`EVEN`], the first one's lists hold for all samples.
    pub(crate) shader: Vec<[i32; LIST]>,
    /// With four samples, the triangle.
    pub(crate) triangle: Vec<[i32; LIST]>,
    pub(crate) triangles: i32,
    /// The nearness where it is shaded, with four samples.
    pub(crate) nearness: Vec<[f32; LIST]>,
    /// The leading numbers, replaced by the color once shaded.
    pub(crate) lead: Vec<[[f32; LIST]; 3]>,
    /// More of them.
    pub(crate) second: Vec<[[f32; LIST]; 3]>,
    /// Of colored draws the color over w; empty where the pass has none.
    pub(crate) paint: Vec<[[f32; LIST]; 3]>,
    /// The tile's triangles of draws with images or a mask.
    pub(crate) mapped_triangles: Vec<MappedTriangle>,
    /// The nearest of them; empty if the pass has none.
    pub(crate) mapped: Vec<[i32; LIST]>,
    pub(crate) face: Vec<[[f32; LIST]; 3]>,
    /// With four samples, whether any triangle has stored more than the leading numbers.
    pub(crate) keeps_more: bool,
}

/// The numbers that a triangle stores for shading.
#[derive(Clone, Copy, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is one list of the tile's buffer")]
pub(crate) struct Kept<'a> {
    pub(crate) lead: bool,
    pub(crate) second: bool,
    pub(crate) paint: bool,
    pub(crate) face: bool,
    /// The number of the tile's mapped triangle, if it is one.
    pub(crate) mapped: Option<i32>,
    /// The test of the mask, if there is one.
    pub(crate) mask: Option<(&'a Look<'a>, &'a State, bool)>,
}

impl<'a> Kept<'a> {
    /// Inputs of shading.
    #[inline(always)]
    pub(crate) fn new(look: &'a Look<'a>, state: &'a State, back: bool, mapped: Option<i32>) -> Self {
        if let Some(maps) = &state.maps {
            return Self { mapped, mask: maps.mask.is_some().then_some((look, state, back)), ..Self::default() };
        }
        Self {
            lead: state.stage != Stage::Unlit,
            second: state.stage == Stage::Mixed,
            paint: state.shades_paint(),
            face: state.opposite_normals,
            mapped: None,
            mask: None,
        }
    }
}

impl TileBuffer {
    pub(crate) fn new() -> Self {
        Self {
            depth: Vec::new(),
            shader: Vec::new(),
            triangle: Vec::new(),
            triangles: 0,
            nearness: Vec::new(),
            lead: Vec::new(),
            second: Vec::new(),
            paint: Vec::new(),
            mapped_triangles: Vec::new(),
            mapped: Vec::new(),
            face: Vec::new(),
            keeps_more: false,
        }
    }

    /// Allocates the memory of a tile.
    #[expect(clippy::large_stack_arrays, reason = "48 KiB, once for each list")]
    pub(crate) fn prepare(&mut self, samples: Samples, painted: bool, mapped: bool) {
        let count = samples.count() as usize;
        self.depth.resize(count, [0.0; LIST]);
        self.shader.resize(count, [0; LIST]);
        for list in [&mut self.lead, &mut self.second, &mut self.face] {
            list.resize(count, [[0.0; LIST]; 3]);
        }
        if mapped {
            self.mapped.resize(count, [0; LIST]);
        }
        if painted {
            self.paint.resize(count, [[0.0; LIST]; 3]);
        }
        if samples == Samples::Four {
            self.nearness.resize(count, [0.0; LIST]);
            self.triangle.resize(count, [0; LIST]);
        }
    }

    /// Empties a tile.
    pub(crate) fn clear(&mut self) {
        self.depth.as_flattened_mut().fill(0.0);
        for (list, nothing) in self.shader.iter_mut().zip([0, EVEN]) {
            list.fill(nothing);
        }
        self.triangles = 0;
        self.mapped_triangles.clear();
        self.keeps_more = false;
    }

    /// Draws a triangle of few pixels with one sample each: those of `pixels`, counted from `first`.
    #[inline(always)]
    pub(crate) fn cover_tiny<S: Simd>(
        &mut self,
        simd: S,
        (pixels, first): (i32, [i32; 2]),
        slopes: &LaneSlopes<S>,
        [least, most]: [f32; 2],
        shader: i32,
        keeps_lead: bool,
    ) {
        let first = first[1] as usize * TILE + first[0] as usize;
        let (depths, shaders, [a, b, c]) = (&mut self.depth[0], &mut self.shader[0], &mut self.lead[0]);
        let mut left = pixels as u32;
        while left != 0 {
            let bit = left.trailing_zeros() as usize % TINY_PIXELS;
            left &= left - 1;
            let [x, y] = each!(axis in 2 => f32x4::simd_from(simd, TINY_PLACES[axis][bit]));
            let v = slopes.dx.mul_add_precise(x, slopes.dy.mul_add_precise(y, slopes.base));
            let depth = min_one(max_one(v[0], least), most);
            let pixel = (first + TINY_AT[bit]) % PIXELS;
            if depth > depths[pixel] {
                depths[pixel] = depth;
                shaders[pixel] = shader;
                if keeps_lead {
                    (a[pixel], b[pixel], c[pixel]) = (v[1], v[2], v[3]);
                }
            }
        }
    }

    #[inline(always)]
    pub(crate) fn keep_more<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        at: (usize, usize),
        [i, j]: [f32; 2],
        kept: Kept,
    ) {
        let (sample, pixel) = at;
        if kept.second {
            let v = value(simd, &planes.second, i, j);
            for c in 0..3 {
                self.second[sample][c][pixel] = v[c + 1];
            }
        }
        if kept.paint {
            let v = value(simd, &planes.paint, i, j);
            for c in 0..3 {
                self.paint[sample][c][pixel] = v[c + 1];
            }
        }
        if let Some(number) = kept.mapped {
            self.mapped[sample][pixel] = number;
        }
        if kept.face {
            for c in 0..3 {
                self.face[sample][c][pixel] = planes.face[c];
            }
        }
    }

    /// Draws a lane's triangle that is not tiny: in strips of one vector, row by row.
    #[inline(always)]
    pub(crate) fn cover_small<S: Simd>(
        &mut self,
        simd: S,
        (batch, lane): (&Batch, usize),
        slopes: &LaneSlopes<S>,
        range: [f32; 2],
        shader: i32,
        keeps_lead: bool,
    ) {
        let [left, right, top, bottom] = each!(k in 4 => batch.bounds[k][lane]);
        let count = lanes::<S>() as i32;
        let shader = splat_i(simd, shader);
        let lead = Slopes::of_lane(slopes);
        let (least, most) = (splat(simd, range[0]), splat(simd, range[1]));
        let (depths, shaders, leads) = (&mut self.depth[0], &mut self.shader[0], &mut self.lead[0]);
        let mut next = left;
        while next <= right {
            // The last strip may begin earlier, so that it ends with the tile.
            let i = next.min(TILE as i32 - count);
            next = i + count;
            let steps = counting_i(simd) + splat_i(simd, i - left);
            let mut e: [I<S>; 3] = each!(k in 3 => {
                steps * splat_i(simd, batch.across[k][lane]) + splat_i(simd, batch.edge[k][lane] >> 8)
            });
            let x = counting(simd) + splat(simd, i as f32);
            let mut y = splat(simd, top as f32);
            let mut place = top as usize * TILE + i as usize;
            for _ in top..=bottom {
                let covered = (e[0] | e[1] | e[2]).simd_ge(splat_i(simd, 0));
                if covered.any_true() {
                    let place = place & (PIXELS - 1);
                    let depth = min::<S>(max::<S>(plane(simd, &lead, 0, x, y), least), most);
                    let before = load(simd, depths, place);
                    let nearer = covered & depth.simd_gt(before);
                    replace::<S>(simd, nearer, depth, depths, place);
                    store_i::<S>(nearer.select(shader, load_i(simd, shaders, place)), shaders, place);
                    if keeps_lead {
                        for c in 0..3 {
                            replace::<S>(simd, nearer, plane(simd, &lead, c + 1, x, y), &mut leads[c], place);
                        }
                    }
                }
                place += TILE;
                y += splat(simd, 1.0);
                for k in 0..3 {
                    e[k] += splat_i(simd, batch.down[k][lane]);
                }
            }
        }
    }

    /// The same for any triangle.
    #[inline(always)]
    pub(crate) fn cover_strips<S: Simd>(
        &mut self,
        simd: S,
        edges: &EdgeFunctions,
        planes: &Planes,
        shader: i32,
        kept: Kept,
    ) {
        let [left, right, top, bottom] = edges.bounds;
        let count = lanes::<S>() as i32;
        let shader = splat_i(simd, shader);
        let DepthPlane { base, dx, dy, first } = planes.depth;
        let [base, dx, dy] = each!(k in 3 => splat(simd, [base, dx, dy][k]));
        let zero = splat_i(simd, 0);
        let mut next = left;
        while next <= right {
            // The last strip may begin earlier, so that it ends with the tile.
            let i = next.min(TILE as i32 - count);
            next = i + count;
            let mut e: [I<S>; 3] = each!(k in 3 => {
                let at = edges.at[k][0] + edges.across[k] * i + edges.down[k] * top;
                counting_i(simd) * splat_i(simd, edges.across[k]) + splat_i(simd, at)
            });
            let x = counting(simd) + splat(simd, i as f32);
            let from_first = counting(simd) + splat(simd, (i - first[0]) as f32);
            let mut y = splat(simd, top as f32);
            for j in top..=bottom {
                let covered = (e[0] | e[1] | e[2]).simd_ge(zero);
                if covered.any_true() {
                    let at = (j as usize * TILE + i as usize) & (PIXELS - 1);
                    let row = fma::<S>(dy, splat(simd, (j - first[1]) as f32), base);
                    let depth = clamped(simd, fma::<S>(dx, from_first, row), planes);
                    let before = load(simd, &self.depth[0], at);
                    let mut nearer = covered & depth.simd_gt(before);
                    if kept.mask.is_some() {
                        nearer &= self.left_by_mask(simd, kept, [x, y], depth, nearer);
                    }
                    if nearer.any_true() {
                        replace::<S>(simd, nearer, depth, &mut self.depth[0], at);
                        store_i::<S>(nearer.select(shader, load_i(simd, &self.shader[0], at)), &mut self.shader[0], at);
                        self.keep(simd, planes, at, [x, y], nearer, kept);
                    }
                }
                y += splat(simd, 1.0);
                for k in 0..3 {
                    e[k] += splat_i(simd, edges.down[k]);
                }
            }
        }
    }

    /// The pixels that the mask keeps; all of them without a mask.
    #[inline(never)]
    pub(crate) fn left_by_mask<S: Simd>(
        &self,
        simd: S,
        kept: Kept,
        place: [F<S>; 2],
        nearness: F<S>,
        shown: M<S>,
    ) -> M<S> {
        let (Some((look, state, back)), Some(number)) = (kept.mask, kept.mapped) else { return shown };
        let of = shown.select(splat_i(simd, number), splat_i(simd, -1));
        let nearness = shown.select(nearness, splat(simd, 1.0));
        let pixels = MappedPixels { triangles: &self.mapped_triangles, of, place, nearness };
        pixels.are_there(simd, look.pass, state, back)
    }

    #[inline(always)]
    pub(crate) fn keep<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        at: usize,
        [x, y]: [F<S>; 2],
        shown: M<S>,
        kept: Kept,
    ) {
        if let Some(number) = kept.mapped {
            let before = load_i(simd, &self.mapped[0], at);
            store_i::<S>(shown.select(splat_i(simd, number), before), &mut self.mapped[0], at);
        }
        for c in 0..3 {
            if kept.lead {
                replace::<S>(simd, shown, plane(simd, &planes.lead, c + 1, x, y), &mut self.lead[0][c], at);
            }
            if kept.second {
                replace::<S>(simd, shown, plane(simd, &planes.second, c + 1, x, y), &mut self.second[0][c], at);
            }
            if kept.paint {
                replace::<S>(simd, shown, plane(simd, &planes.paint, c + 1, x, y), &mut self.paint[0][c], at);
            }
            if kept.face {
                replace::<S>(simd, shown, splat(simd, planes.face[c]), &mut self.face[0][c], at);
            }
        }
    }
}

/// The lanes that the edge functions cover, from pixel (i, j) on.
#[inline(always)]
pub(crate) fn covered<S: Simd>(simd: S, edges: &EdgeFunctions, i: i32, j: i32) -> M<S> {
    let [left, right, ..] = edges.bounds;
    let steps = counting_i(simd);
    let [a, b, c]: [I<S>; 3] = each!(k in 3 => {
        let first = edges.at[k][0] + edges.across[k] * i + edges.down[k] * j;
        steps * splat_i(simd, edges.across[k]) + splat_i(simd, first)
    });
    let inside = (a | b | c).simd_ge(splat_i(simd, 0));
    let column = steps + splat_i(simd, i);
    inside & column.simd_ge(splat_i(simd, left)) & column.simd_le(splat_i(simd, right))
}

/// The nearness, kept between the corners'.
#[inline(always)]
pub(crate) fn clamped<S: Simd>(simd: S, nearness: F<S>, planes: &Planes) -> F<S> {
    let [least, most] = planes.range;
    min::<S>(max::<S>(nearness, splat(simd, least)), splat(simd, most))
}

/// One of the numbers at points of the tile.
#[inline(always)]
pub(crate) fn plane<S: Simd>(simd: S, slopes: &Slopes, k: usize, x: F<S>, y: F<S>) -> F<S> {
    let row = fma::<S>(splat(simd, slopes.dy[k]), y, splat(simd, slopes.base[k]));
    fma::<S>(splat(simd, slopes.dx[k]), x, row)
}

#[inline(always)]
fn vectors<S: Simd>(simd: S, slopes: &Slopes) -> (f32x4<S>, f32x4<S>, f32x4<S>) {
    let Slopes { base, dx, dy } = slopes;
    (f32x4::from_slice(simd, base), f32x4::from_slice(simd, dx), f32x4::from_slice(simd, dy))
}

/// All four numbers at a point of the tile.
#[inline(always)]
pub(crate) fn value<S: Simd>(simd: S, slopes: &Slopes, x: f32, y: f32) -> f32x4<S> {
    let (base, dx, dy) = vectors(simd, slopes);
    dx.mul_add_precise(f32x4::simd_from(simd, x), dy.mul_add_precise(f32x4::simd_from(simd, y), base))
}

//! Coverage with four samples a pixel, and what a triangle leaves in them.

use crate::cover::{EdgeFunctions, Kept, PIXELS, TINY_AT, TINY_PIXELS, TINY_PLACES, TileBuffer, value};
use crate::lanes::{I, M, Simd, counting_i, each, f32x4, lanes, max_one, min_one, splat, splat_i};
use crate::placed::TILE;
use crate::planes::{LaneSlopes, Planes};
use crate::samples::{CENTROIDS, OFFSETS};
use fearless_simd::{i32x4, mask32x4, prelude::*};

/// Where the number of the centroid begins among a shader's bits.
pub(crate) const CENTROID_SHIFT: i32 = 28;
/// The bits of a shader below it.
pub(crate) const SHADER_BITS: i32 = (1 << CENTROID_SHIFT) - 1;

impl TileBuffer {
    /// Draws a triangle of few pixels with four samples each: those whose bits are set in `samples`, counted from `first`.
    /// It is shaded once a pixel, at the center or, where that is not covered, at the centroid of the samples that are.
    #[inline(always)]
    pub(crate) fn cover_tiny_four<S: Simd>(
        &mut self,
        simd: S,
        (centers, samples, first): (i32, [i32; 4], [i32; 2]),
        slopes: &LaneSlopes<S>,
        [least, most]: [f32; 2],
        shader: i32,
        keeps_lead: bool,
    ) {
        self.triangles += 1;
        let first = first[1] as usize * TILE + first[0] as usize;
        let each_sample = i32x4::load_array_ref(simd, &samples);
        let [base, dx, dy] = each!(k in 3 => {
            f32x4::simd_from(simd, [slopes.base, slopes.dx, slopes.dy][k][0])
        });
        let [x, y] = each!(axis in 2 => f32x4::load_array_ref(simd, &OFFSETS[axis]));
        let base = dx.mul_add_precise(x, dy.mul_add_precise(y, base));
        let mut left = (samples[0] | samples[1] | samples[2] | samples[3]) as u32;
        while left != 0 {
            let bit = left.trailing_zeros() as usize % TINY_PIXELS;
            left &= left - 1;
            let bits = i32x4::simd_from(simd, 1 << bit);
            let covered = (each_sample & bits).simd_eq(bits);
            let [x, y] = each!(axis in 2 => TINY_PLACES[axis][bit]);
            let depth =
                dx.mul_add_precise(f32x4::simd_from(simd, x), dy.mul_add_precise(f32x4::simd_from(simd, y), base));
            let depth = clamped_four(simd, depth, [least, most]);
            let pixel = (first + TINY_AT[bit]) % PIXELS;
            let mask = self.nearer_of_four(simd, pixel, covered, depth);
            if mask == 0 {
                continue;
            }
            let all = covered.to_bitmask() as usize % 16;
            let place = if all == 15 || centers >> bit & 1 != 0 { 0 } else { all };
            let [x, y] = [x + CENTROIDS[place][0], y + CENTROIDS[place][1]];
            let v = slopes.dx.mul_add_precise(
                f32x4::simd_from(simd, x),
                slopes.dy.mul_add_precise(f32x4::simd_from(simd, y), slopes.base),
            );
            let inverse_w = min_one(max_one(v[0], least), most);
            self.keep_samples(
                pixel,
                mask,
                shader | (place as i32) << CENTROID_SHIFT,
                inverse_w,
                keeps_lead.then_some(v),
            );
        }
    }

    /// Replaces a pixel's depths where these are nearer; returns which are.
    #[inline(always)]
    fn nearer_of_four<S: Simd>(&mut self, simd: S, pixel: usize, covered: mask32x4<S>, depth: f32x4<S>) -> usize {
        let at = &mut self.depth.as_flattened_mut()[4 * pixel..4 * pixel + 4];
        let before = f32x4::from_slice(simd, at);
        let nearer = covered & depth.simd_gt(before);
        // As integers, as in [`replace`](crate::lanes::replace).
        let [depth, before]: [i32x4<S>; 2] = [depth.bitcast(), before.bitcast()];
        let kept: f32x4<S> = nearer.select(depth, before).bitcast();
        kept.store_slice(at);
        nearer.to_bitmask() as usize % 16
    }

    /// Puts what a triangle leaves into some of a pixel's samples.
    #[inline(always)]
    fn keep_samples<S: Simd>(
        &mut self,
        pixel: usize,
        mask: usize,
        shader: i32,
        inverse_w: f32,
        lead: Option<f32x4<S>>,
    ) {
        let pixel = pixel % PIXELS;
        let Self { shader: shaders, triangle, inverse_w: inverses, lead: leads, triangles, .. } = self;
        let (Ok(shaders), Ok(triangle), Ok(inverses), Ok(leads)) = (
            <&mut [_; 4]>::try_from(&mut shaders[..]),
            <&mut [_; 4]>::try_from(&mut triangle[..]),
            <&mut [_; 4]>::try_from(&mut inverses[..]),
            <&mut [_; 4]>::try_from(&mut leads[..]),
        ) else {
            return;
        };
        let mut left = mask;
        while left != 0 {
            let sample = left.trailing_zeros() as usize % 4;
            left &= left - 1;
            shaders[sample][pixel] = shader;
            triangle[sample][pixel] = *triangles;
            inverses[sample][pixel] = inverse_w;
            if let Some(v) = lead {
                for c in 0..3 {
                    leads[sample][c][pixel] = v[c + 1];
                }
            }
        }
    }

    /// The same for a triangle of any size.
    #[inline(always)]
    pub(crate) fn cover_four<S: Simd>(
        &mut self,
        simd: S,
        edges: &EdgeFunctions,
        planes: &Planes,
        shader: i32,
        kept: Kept,
    ) {
        let [left, right, top, bottom] = edges.bounds;
        self.triangles += 1;
        for j in top..=bottom {
            let mut next = left;
            while next <= right {
                let first = next.min(TILE as i32 - lanes::<S>() as i32);
                // Pixels of which some sample is covered, without those that the strip before has had.
                let mut covered =
                    covered_by_any(simd, edges, first, j).to_bitmask() >> (next - first) << (next - first);
                next = first + lanes::<S>() as i32;
                while covered != 0 {
                    let i = first + covered.trailing_zeros() as i32;
                    covered &= covered - 1;
                    self.cover_pixel(simd, edges, planes, shader, kept, [i, j]);
                }
            }
        }
    }

    #[inline(always)]
    fn cover_pixel<S: Simd>(
        &mut self,
        simd: S,
        edges: &EdgeFunctions,
        planes: &Planes,
        shader: i32,
        kept: Kept,
        [i, j]: [i32; 2],
    ) {
        let pixel = (j as usize * TILE + i as usize) % PIXELS;
        let (covered, depth) = samples(simd, edges, planes, i, j);
        let place = centroid(edges, i, j, covered.to_bitmask() as usize % 16);
        let [x, y] = [i as f32 + CENTROIDS[place][0], j as f32 + CENTROIDS[place][1]];
        let v = value(simd, &planes.lead, x, y);
        let inverse_w = min_one(max_one(v[0], planes.range[0]), planes.range[1]);
        if kept.mask.is_some() {
            let first = counting_i(simd).simd_eq(splat_i(simd, 0));
            let place = [splat(simd, x), splat(simd, y)];
            if !self.left_by_mask(simd, kept, place, splat(simd, inverse_w), first).any_true() {
                return;
            }
        }
        let mask = self.nearer_of_four(simd, pixel, covered, depth);
        if mask == 0 {
            return;
        }
        let shader = shader | (place as i32) << CENTROID_SHIFT;
        self.keep_samples(pixel, mask, shader, inverse_w, kept.lead.then_some(v));
        if kept.second || kept.paint || kept.face || kept.mapped.is_some() {
            for sample in (0..4).filter(|sample| mask >> sample & 1 != 0) {
                self.keep_more(simd, planes, (sample, pixel), [x, y], kept);
            }
        }
    }
}

/// Pixels of which some sample is covered, from (i, j) on.
#[inline(always)]
fn covered_by_any<S: Simd>(simd: S, edges: &EdgeFunctions, i: i32, j: i32) -> M<S> {
    let grown = each!(k in 3 => counting_i(simd) * splat_i(simd, edges.across[k]));
    let mut outside = splat_i(simd, -1);
    for sample in 0..4 {
        let [a, b, c]: [I<S>; 3] = each!(k in 3 => {
            grown[k] + splat_i(simd, edges.at[k][sample] + edges.across[k] * i + edges.down[k] * j)
        });
        outside &= a | b | c;
    }
    outside.simd_ge(splat_i(simd, 0))
}

/// Which samples of a pixel are covered, and 1/w at each.
#[inline(always)]
pub(crate) fn samples<S: Simd>(
    simd: S,
    edges: &EdgeFunctions,
    planes: &Planes,
    i: i32,
    j: i32,
) -> (mask32x4<S>, f32x4<S>) {
    let [a, b, c] = each!(k in 3 => {
        i32x4::from_slice(simd, &edges.at[k]) + (edges.across[k] * i + edges.down[k] * j)
    });
    let covered = (a | b | c).simd_ge(i32x4::simd_from(simd, 0));
    let [x, y] = each!(axis in 2 => f32x4::from_slice(simd, &OFFSETS[axis]));
    let [base, dx, dy] = [planes.lead.base[0], planes.lead.dx[0], planes.lead.dy[0]];
    let row = f32x4::simd_from(simd, dy).mul_add_precise(y + j as f32, f32x4::simd_from(simd, base));
    let depth = f32x4::simd_from(simd, dx).mul_add_precise(x + i as f32, row);
    (covered, clamped_four(simd, depth, planes.range))
}

#[inline(always)]
fn clamped_four<S: Simd>(simd: S, depth: f32x4<S>, range: [f32; 2]) -> f32x4<S> {
    let [least, most] = each!(k in 2 => f32x4::simd_from(simd, range[k]));
    let depth = depth.simd_gt(least).select(depth, least);
    depth.simd_lt(most).select(depth, most)
}

/// The number of the place where a pixel is shaded: 0 where its center is covered, else the samples that are.
#[inline(always)]
pub(crate) fn centroid(edges: &EdgeFunctions, i: i32, j: i32, mask: usize) -> usize {
    let [a, b, c] = each!(k in 3 => edges.center[k] + edges.across[k] * i + edges.down[k] * j);
    if mask == 15 || a | b | c >= 0 { 0 } else { mask }
}

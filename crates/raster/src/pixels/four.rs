//! Coverage with four samples a pixel, and the values stored for shading.
//!
//! Most pixels show one triangle in all four samples. Its values are then stored once, for the first sample, and the
//! second one's shader is [`EVEN`]; before a triangle covers only some of the samples, all four are written out.

use crate::pixels::cover::{
    EVEN, EdgeFunctions, Kept, PIXELS, TINY_AT, TINY_PIXELS, TINY_PLACES, TileBuffer, clamped, plane, value,
};
use crate::simd::lanes::{
    I, M, MOST_LANES, Simd, counting, counting_i, each, f32x4, fma, lanes, load, load_i, max_one, min_one, replace,
    splat, splat_i, store_i,
};
use crate::triangles::planes::{DepthPlane, LaneSlopes, Planes};
use crate::triangles::samples::{CENTROIDS, OFFSETS};
use crate::vertices::placed::TILE;
use fearless_simd::{i32x4, mask32x4, prelude::*};

/// The lowest bit of the centroid's number in a shader.
pub(crate) const CENTROID_SHIFT: i32 = 28;
/// The bits of a shader below it.
pub(crate) const SHADER_BITS: i32 = (1 << CENTROID_SHIFT) - 1;

/// The bits of all samples of a pixel.
const ALL: usize = 15;

impl TileBuffer {
    /// Draws a triangle of few pixels with four samples each: those whose bits are set in `samples`, counted from
    /// `first`. It is shaded once a pixel, at the center or, if that is not covered, at the centroid of the covered
    /// samples.
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
        let (sample_x, sample_y) = (x, y);
        let mut left = (samples[0] | samples[1] | samples[2] | samples[3]) as u32;
        while left != 0 {
            let bit = left.trailing_zeros() as usize % TINY_PIXELS;
            left &= left - 1;
            let bits = i32x4::simd_from(simd, 1 << bit);
            let covered = (each_sample & bits).simd_eq(bits);
            let [x, y] = each!(axis in 2 => TINY_PLACES[axis][bit]);
            let depth = dx.mul_add_precise(sample_x + x, dy.mul_add_precise(sample_y + y, base));
            let depth = clamped_four(simd, depth, [least, most]);
            let pixel = (first + TINY_AT[bit]) % PIXELS;
            let mask = self.nearer_of_four(simd, pixel, covered, depth);
            if mask == 0 {
                continue;
            }
            let all = covered.to_bitmask() as usize % 16;
            let place = if all == ALL || centers >> bit & 1 != 0 { 0 } else { all };
            let [x, y] = [x + CENTROIDS[place][0], y + CENTROIDS[place][1]];
            let v = slopes.dx.mul_add_precise(
                f32x4::simd_from(simd, x),
                slopes.dy.mul_add_precise(f32x4::simd_from(simd, y), slopes.base),
            );
            let nearness = min_one(max_one(v[0], least), most);
            let shader = shader | (place as i32) << CENTROID_SHIFT;
            self.keep_samples(pixel, mask, shader, nearness, keeps_lead.then(|| [v[1], v[2], v[3]]));
        }
    }

    /// Replaces a pixel's depths where the new ones are nearer; returns the mask of replaced samples.
    #[inline(always)]
    fn nearer_of_four<S: Simd>(&mut self, simd: S, pixel: usize, covered: mask32x4<S>, depth: f32x4<S>) -> usize {
        let at = &mut self.depth.as_flattened_mut()[4 * pixel..4 * pixel + 4];
        let before = f32x4::from_slice(simd, at);
        let nearer = covered & depth.simd_gt(before);
        // As integers, as in [`replace`](crate::simd::lanes::replace).
        let [depth, before]: [i32x4<S>; 2] = [depth.bitcast(), before.bitcast()];
        let kept: f32x4<S> = nearer.select(depth, before).bitcast();
        kept.store_slice(at);
        nearer.to_bitmask() as usize % 16
    }

    /// Stores a triangle's values in some of a pixel's samples.
    #[inline(always)]
    fn keep_samples(&mut self, pixel: usize, mask: usize, shader: i32, nearness: f32, lead: Option<[f32; 3]>) {
        let pixel = pixel % PIXELS;
        if mask != ALL && self.shader[1][pixel] == EVEN {
            self.write_out(pixel);
        }
        let Self { shader: shaders, triangle, nearness: inverses, lead: leads, triangles, .. } = self;
        let (Ok(shaders), Ok(triangle), Ok(inverses), Ok(leads)) = (
            <&mut [_; 4]>::try_from(&mut shaders[..]),
            <&mut [_; 4]>::try_from(&mut triangle[..]),
            <&mut [_; 4]>::try_from(&mut inverses[..]),
            <&mut [_; 4]>::try_from(&mut leads[..]),
        ) else {
            return;
        };
        let mut left = if mask == ALL { 1 } else { mask };
        while left != 0 {
            let sample = left.trailing_zeros() as usize % 4;
            left &= left - 1;
            shaders[sample][pixel] = shader;
            triangle[sample][pixel] = *triangles;
            inverses[sample][pixel] = nearness;
            if let Some(v) = lead {
                for c in 0..3 {
                    leads[sample][c][pixel] = v[c];
                }
            }
        }
        if mask == ALL {
            shaders[1][pixel] = EVEN;
        }
    }

    /// Copies the first sample's values to the others of a pixel.
    #[inline(never)]
    fn write_out(&mut self, pixel: usize) {
        let Self { shader, triangle, nearness, lead, second, paint, mapped, face, keeps_more, .. } = self;
        repeat(shader, pixel);
        repeat(triangle, pixel);
        repeat(nearness, pixel);
        repeat_three(lead, pixel);
        if *keeps_more {
            repeat(mapped, pixel);
            for lists in [second, paint, face] {
                repeat_three(lists, pixel);
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
        let count = lanes::<S>() as i32;
        self.triangles += 1;
        self.keeps_more |= kept.second || kept.paint || kept.face || kept.mapped.is_some();
        let least = each!(k in 3 => edges.at[k].into_iter().fold(i32::MAX, i32::min));
        let more: [I<S>; 3] =
            each!(k in 3 => splat_i(simd, edges.at[k].into_iter().fold(i32::MIN, i32::max) - least[k]));
        let mut next = left;
        while next <= right {
            // The last strip may begin earlier, so that it ends with the tile; its first pixels have been drawn then.
            let i = next.min(TILE as i32 - count);
            let drawn = next - i;
            next = i + count;
            let mut e: [I<S>; 3] = each!(k in 3 => {
                let at = least[k] + edges.across[k] * i + edges.down[k] * top;
                counting_i(simd) * splat_i(simd, edges.across[k]) + splat_i(simd, at)
            });
            for j in top..=bottom {
                // A pixel that no edge excludes as a whole may still have no sample inside all three.
                let [a, b, c] = each!(k in 3 => e[k] + more[k]);
                let some = (a | b | c).simd_ge(splat_i(simd, 0));
                let mut parts = some.to_bitmask() >> drawn << drawn;
                if parts != 0 {
                    let all = (e[0] | e[1] | e[2]).simd_ge(splat_i(simd, 0));
                    let whole = if kept.mask.is_some() { 0 } else { all.to_bitmask() & parts };
                    parts &= !whole;
                    if whole != 0 {
                        self.cover_whole(simd, planes, shader, kept, ([i, j], whole));
                    }
                }
                while parts != 0 {
                    let lane = parts.trailing_zeros() as i32;
                    parts &= parts - 1;
                    self.cover_pixel(simd, edges, planes, shader, kept, [i + lane, j]);
                }
                for k in 0..3 {
                    e[k] += splat_i(simd, edges.down[k]);
                }
            }
        }
    }

    /// Draws the pixels from (i, j) on with a bit in `whole`, whose samples are all covered.
    #[inline(always)]
    fn cover_whole<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        shader: i32,
        kept: Kept,
        ([i, j], whole): ([i32; 2], u64),
    ) {
        let at = (j as usize * TILE + i as usize) & (PIXELS - 1);
        let samples = self.nearer_of_whole(simd, planes, ([i, j], at), whole);
        // The pixels whose samples are all nearer, and those with some.
        let pairs = samples & samples >> 1;
        let all = bit_of_four(pairs & pairs >> 2);
        let pairs = samples | samples >> 1;
        let mut some = bit_of_four(pairs | pairs >> 2) & !all;
        if all != 0 {
            let place = [counting(simd) + splat(simd, i as f32), splat(simd, j as f32)];
            let shown = M::<S>::from_bitmask(simd, all);
            let nearness = clamped(simd, plane(simd, &planes.lead, 0, place[0], place[1]), planes);
            replace::<S>(simd, shown, nearness, &mut self.nearness[0], at);
            let number = self.triangles;
            let [first, second, ..] = &mut self.shader[..] else { return };
            for (list, value) in [(first, shader), (second, EVEN), (&mut self.triangle[0], number)] {
                store_i::<S>(shown.select(splat_i(simd, value), load_i(simd, list, at)), list, at);
            }
            self.keep(simd, planes, at, place, shown, kept);
        }
        while some != 0 {
            let lane = some.trailing_zeros() as usize % MOST_LANES;
            some &= some - 1;
            let place = [i as f32 + lane as f32, j as f32];
            let v = value(simd, &planes.lead, place[0], place[1]);
            let mask = (samples >> (4 * lane)) as usize & ALL;
            self.keep_pixel(simd, planes, (at + lane, mask), place, shader, kept, v);
        }
    }

    /// Replaces depths of the pixels from (i, j) on with a bit in `whole`, where the new ones are nearer; returns the
    /// replaced samples, four bits a pixel.
    #[inline(always)]
    fn nearer_of_whole<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        ([i, j], at): ([i32; 2], usize),
        whole: u64,
    ) -> u64 {
        // A vector holds all samples of some pixels.
        let pixels = lanes::<S>() / 4;
        let DepthPlane { base, dx, dy, first: from } = planes.depth;
        let [x, y] = each!(axis in 2 => load(simd, &SAMPLES_OF_PIXELS[axis], 0));
        let row = fma::<S>(splat(simd, dy), y + splat(simd, (j - from[1]) as f32), splat(simd, base));
        let depths = self.depth.as_flattened_mut();
        let mut samples = 0;
        for first in (0..lanes::<S>()).step_by(pixels) {
            let here = whole >> first & ((1 << pixels) - 1);
            if here == 0 {
                continue;
            }
            let x = x + splat(simd, (i + first as i32 - from[0]) as f32);
            let depth = clamped(simd, fma::<S>(splat(simd, dx), x, row), planes);
            let place = 4 * (at + first);
            let covered = M::<S>::from_bitmask(simd, four_of_bit(here));
            let nearer = covered & depth.simd_gt(load(simd, depths, place));
            replace::<S>(simd, nearer, depth, depths, place);
            samples |= nearer.to_bitmask() << (4 * first);
        }
        samples
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
        if kept.mask.is_some() {
            let nearness = min_one(max_one(v[0], planes.range[0]), planes.range[1]);
            let first = counting_i(simd).simd_eq(splat_i(simd, 0));
            let place = [splat(simd, x), splat(simd, y)];
            if !self.left_by_mask(simd, kept, place, splat(simd, nearness), first).any_true() {
                return;
            }
        }
        let mask = self.nearer_of_four(simd, pixel, covered, depth);
        if mask != 0 {
            let shader = shader | (place as i32) << CENTROID_SHIFT;
            self.keep_pixel(simd, planes, (pixel, mask), [x, y], shader, kept, v);
        }
    }

    /// Stores a triangle's values, with the leading numbers `v` at the point where it is shaded, in samples of a pixel.
    #[inline(always)]
    fn keep_pixel<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        (pixel, mask): (usize, usize),
        place: [f32; 2],
        shader: i32,
        kept: Kept,
        v: f32x4<S>,
    ) {
        let nearness = min_one(max_one(v[0], planes.range[0]), planes.range[1]);
        self.keep_samples(pixel, mask, shader, nearness, kept.lead.then(|| [v[1], v[2], v[3]]));
        if kept.second || kept.paint || kept.face || kept.mapped.is_some() {
            let written = if mask == ALL { 1 } else { mask };
            for sample in (0..4).filter(|sample| written >> sample & 1 != 0) {
                self.keep_more(simd, planes, (sample, pixel), place, kept);
            }
        }
    }
}

/// Copies a pixel's value from the first sample's list to the others.
fn repeat<T: Copy, const N: usize>(lists: &mut [[T; N]], pixel: usize) {
    if let [first, others @ ..] = lists {
        for other in others {
            other[pixel] = first[pixel];
        }
    }
}

fn repeat_three<const N: usize>(lists: &mut [[[f32; N]; 3]], pixel: usize) {
    if let [first, others @ ..] = lists {
        for other in others {
            for c in 0..3 {
                other[c][pixel] = first[c][pixel];
            }
        }
    }
}

/// The positions of the samples of neighbouring pixels, pixel by pixel, relative to the center of the first.
const SAMPLES_OF_PIXELS: [[f32; MOST_LANES]; 2] = {
    let (mut places, mut lane) = ([[0.0; MOST_LANES]; 2], 0);
    while lane < MOST_LANES {
        places[0][lane] = OFFSETS[0][lane % 4] + (lane / 4) as f32;
        places[1][lane] = OFFSETS[1][lane % 4];
        lane += 1;
    }
    places
};

/// Each of up to four bits four times.
#[inline(always)]
fn four_of_bit(bits: u64) -> u64 {
    let bits = (bits | bits << 6) & 0x0303;
    let bits = (bits | bits << 3) & 0x1111;
    bits * 15
}

/// The lowest of every four bits, next to each other.
#[inline(always)]
fn bit_of_four(bits: u64) -> u64 {
    let bits = bits & 0x1111_1111_1111_1111;
    let bits = (bits | bits >> 3) & 0x0303_0303_0303_0303;
    let bits = (bits | bits >> 6) & 0x000f_000f_000f_000f;
    let bits = (bits | bits >> 12) & 0x0000_00ff_0000_00ff;
    (bits | bits >> 24) & 0xffff
}

/// Which samples of a pixel are covered, and the nearness at each.
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
    let DepthPlane { base, dx, dy, first } = planes.depth;
    let row = f32x4::simd_from(simd, dy).mul_add_precise(y + (j - first[1]) as f32, f32x4::simd_from(simd, base));
    let depth = f32x4::simd_from(simd, dx).mul_add_precise(x + (i - first[0]) as f32, row);
    (covered, clamped_four(simd, depth, planes.range))
}

#[inline(always)]
fn clamped_four<S: Simd>(simd: S, depth: f32x4<S>, range: [f32; 2]) -> f32x4<S> {
    let [least, most] = each!(k in 2 => f32x4::simd_from(simd, range[k]));
    let depth = depth.simd_gt(least).select(depth, least);
    depth.simd_lt(most).select(depth, most)
}

/// The number of the point where a pixel is shaded: 0 if its center is covered, else the bits of the covered samples.
#[inline(always)]
pub(crate) fn centroid(edges: &EdgeFunctions, i: i32, j: i32, mask: usize) -> usize {
    let [a, b, c] = each!(k in 3 => edges.center[k] + edges.across[k] * i + edges.down[k] * j);
    if mask == 15 || a | b | c >= 0 { 0 } else { mask }
}

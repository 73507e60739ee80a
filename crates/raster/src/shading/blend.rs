//! Blends fragments over the colors behind them, in drawing order.

use crate::lighting::state::Stage;
use crate::pixels::cover::{EdgeFunctions, TileBuffer, clamped, covered, plane};
use crate::pixels::four::{centroid, samples};
use crate::pixels::look::Look;
use crate::shading::encode::kept;
use crate::shading::shade::{Fragments, state_of};
use crate::simd::lanes::{F, M, Simd, V3, counting, each, fma, lanes, load, replace, saturate, splat, splat_i, splat3};
use crate::triangles::planes::{Planes, Slopes};
use crate::triangles::samples::CENTROIDS;
use crate::vertices::placed::TILE;
use fearless_simd::prelude::*;
use halfway_lighting::Samples;

/// For a vector of pixels: the visible samples of a triangle, and the points where it is shaded.
struct ShownSamples<S: Simd> {
    masks: [M<S>; 4],
    any: M<S>,
    place: [F<S>; 2],
}

impl TileBuffer {
    /// Blends a triangle over colors.
    #[inline(always)]
    pub(crate) fn blend<S: Simd>(&mut self, simd: S, edges: &EdgeFunctions, planes: &Planes, shader: i32, look: &Look) {
        let [left, right, top, bottom] = edges.bounds;
        for j in top..=bottom {
            let mut done = left;
            while done <= right {
                // The last vector of a row begins earlier, so that it ends with the tile.
                let i = done.min(TILE as i32 - lanes::<S>() as i32);
                let shown = match look.pass.samples {
                    Samples::One => self.shown_in_one(simd, edges, planes, [i, j]),
                    _ => self.shown_in_four(simd, edges, planes, [i, j]),
                };
                let column = counting(simd) + splat(simd, i as f32);
                let new = column.simd_ge(splat(simd, done as f32));
                if (shown.any & new).any_true() {
                    self.lay_over(simd, planes, shader, look, [i, j], &shown, new);
                }
                done = i + lanes::<S>() as i32;
            }
        }
    }

    #[inline(always)]
    fn shown_in_one<S: Simd>(
        &self,
        simd: S,
        edges: &EdgeFunctions,
        planes: &Planes,
        [i, j]: [i32; 2],
    ) -> ShownSamples<S> {
        let place = [counting(simd) + splat(simd, i as f32), splat(simd, j as f32)];
        let depth = clamped(simd, plane(simd, &planes.lead, 0, place[0], place[1]), planes);
        let at = j as usize * TILE + i as usize;
        let any = covered(simd, edges, i, j) & depth.simd_gt(load(simd, &self.depth[0], at));
        ShownSamples { masks: [any; 4], any, place }
    }

    #[inline(always)]
    fn shown_in_four<S: Simd>(
        &self,
        simd: S,
        edges: &EdgeFunctions,
        planes: &Planes,
        [i, j]: [i32; 2],
    ) -> ShownSamples<S> {
        let [left, right, ..] = edges.bounds;
        let mut bits = [0_u64; 4];
        let mut place = [counting(simd) + splat(simd, i as f32), splat(simd, j as f32)];
        for lane in 0..lanes::<S>() {
            let column = i + lane as i32;
            if column < left || column > right {
                continue;
            }
            let (covered, depth) = samples(simd, edges, planes, column, j);
            let at = 4 * (j as usize * TILE + column as usize);
            let before = fearless_simd::f32x4::from_slice(simd, &self.depth.as_flattened()[at..at + 4]);
            let nearer = (covered & depth.simd_gt(before)).to_bitmask();
            if nearer == 0 {
                continue;
            }
            let center = centroid(edges, column, j, covered.to_bitmask() as usize);
            for axis in 0..2 {
                place[axis][lane] += CENTROIDS[center][axis];
            }
            for (sample, bits) in bits.iter_mut().enumerate() {
                *bits |= (nearer >> sample & 1) << lane;
            }
        }
        let masks = each!(sample in 4 => M::<S>::from_bitmask(simd, bits[sample]));
        ShownSamples { masks, any: masks[0] | masks[1] | masks[2] | masks[3], place }
    }

    /// opacity·I + (1 − opacity)·B, where B is the color behind.
    #[inline(always)]
    fn lay_over<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        shader: i32,
        look: &Look,
        [i, j]: [i32; 2],
        shown: &ShownSamples<S>,
        new: M<S>,
    ) {
        let (state, back) = state_of(look.states, shader);
        let [x, y] = shown.place;
        let fragments = Fragments {
            place: shown.place,
            nearness: clamped(simd, plane(simd, &planes.lead, 0, x, y), planes),
            lead: three(simd, &planes.lead, x, y),
            second: if state.stage == Stage::Mixed { three(simd, &planes.second, x, y) } else { [splat(simd, 0.0); 3] },
            mapped: if state.maps.is_some() {
                let number = self.mapped_triangles.len() as i32 - 1;
                shown.any.select(splat_i(simd, number), splat_i(simd, -1))
            } else {
                splat_i(simd, -1)
            },
            triangles: &self.mapped_triangles,
            paint: if state.shades_paint() { three(simd, &planes.paint, x, y) } else { [splat(simd, 0.0); 3] },
            face: splat3(simd, planes.face),
        };
        let color = kept(simd, fragments.color_apart(simd, look, state, back), look.pass.pixels);
        let mut opacity = splat(simd, state.side(look.pass, back).opacity);
        if state.paints() {
            opacity *= saturate(
                simd,
                plane(simd, &planes.paint, 0, x, y) / look.screen.inverse_w_at(simd, fragments.nearness),
            );
        }
        let mut new = new;
        if state.maps.is_some() {
            let of_maps = fragments.of_maps();
            opacity = of_maps.opacities(simd, look.pass, state, back);
            new &= of_maps.are_there(simd, look.pass, state, back);
        }
        for sample in 0..look.pass.samples.count() as usize {
            let at = j as usize * TILE + i as usize;
            let show = shown.masks[sample] & new;
            for c in 0..3 {
                let before = load(simd, &self.lead[sample][c], at);
                let over = fma::<S>(opacity, color[c] - before, before);
                replace::<S>(simd, show, over, &mut self.lead[sample][c], at);
            }
        }
    }
}

/// The three numbers at points of the tile.
#[inline(always)]
fn three<S: Simd>(simd: S, slopes: &Slopes, x: F<S>, y: F<S>) -> V3<S> {
    each!(k in 3 => plane(simd, slopes, k + 1, x, y))
}

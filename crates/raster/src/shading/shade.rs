//! Shades the nearest surfaces of a tile, a vector of pixels at a time.

use crate::input::pass::Pass;
use crate::lighting::state::{Stage, State};
use crate::lighting::{Irradiance, Points, added, reflected, tinted, to_viewer};
use crate::pixels::cover::{EVEN, TileBuffer};
use crate::pixels::four::{CENTROID_SHIFT, SHADER_BITS};
use crate::pixels::look::Look;
use crate::pixels::mapped_pixels::MappedPixels;
use crate::shading::encode::{bytes, cleared, kept};
use crate::shading::surroundings::behind;
use crate::simd::lanes::{
    F, I, M, Simd, V3, add, counting, dot, each, lanes, load, load_i, load3, max, min, neg, safe_normalize, scale,
    select3, splat, splat_i, splat3, store,
};
use crate::triangles::mapped::MappedTriangle;
use crate::triangles::samples::CENTROIDS;
use crate::vertices::placed::TILE;
use fearless_simd::prelude::*;
use halfway_lighting::Samples;
use halfway_lighting::equations::NORMAL_MIN;

/// Values interpolated in some pixels.
#[derive(Clone, Copy)]
pub(crate) struct Fragments<'a, S: Simd> {
    /// In pixels from the tile's first.
    pub(crate) place: [F<S>; 2],
    pub(crate) nearness: F<S>,
    pub(crate) lead: V3<S>,
    /// More of it.
    pub(crate) second: V3<S>,
    /// The vertices' color, over w.
    pub(crate) paint: V3<S>,
    /// The numbers of mapped triangles, −1 for others, and all mapped triangles of the tile.
    pub(crate) mapped: I<S>,
    pub(crate) triangles: &'a [MappedTriangle],
    pub(crate) face: V3<S>,
}

impl<S: Simd> Fragments<'_, S> {
    /// Their colors, all of one state and side, by a function of its own in each width.
    pub(crate) fn color_apart(&self, simd: S, look: &Look, state: &State, back: bool) -> V3<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                if state.shades_apart() {
                    self.painted(simd, look, state, back)
                } else {
                    self.color(simd, look, state, back)
                }
            },
        )
    }

    /// Their colors if only the material decides how they reflect light; most of the drawing code, and fastest when
    /// inlined.
    #[inline(always)]
    pub(crate) fn color(&self, simd: S, look: &Look, state: &State, back: bool) -> V3<S> {
        let side = state.side(look.pass, back);
        match state.stage {
            Stage::Unlit => splat3(simd, side.base),
            Stage::Flat => self.lead,
            Stage::Vertex => self.interpolated(simd, look, self.lead),
            Stage::Fragment | Stage::Mixed => {
                let terms =
                    state.fragment_terms(simd, look.pass, &self.points(simd, look, state, back), state.gloss(back));
                if state.stage == Stage::Fragment {
                    return reflected(simd, &terms, side);
                }
                add::<S>(self.interpolated(simd, look, self.second), added(simd, &terms, side))
            }
        }
    }

    /// The colors of draws with vertex colors or images.
    #[inline(always)]
    fn painted(&self, simd: S, look: &Look, state: &State, back: bool) -> V3<S> {
        let side = state.side(look.pass, back);
        if state.maps.is_some() {
            return self.of_maps().colors(simd, look, state, back);
        }
        let color = self.interpolated(simd, look, self.paint);
        let color = each!(c in 3 => min::<S>(color[c], splat(simd, 1.0)));
        if state.stage == Stage::Unlit {
            return tinted(simd, &Irradiance::none(simd), side, color);
        }
        let terms = state.fragment_terms(simd, look.pass, &self.points(simd, look, state, back), state.gloss(back));
        let shade = tinted(simd, &terms, side, color);
        if state.stage == Stage::Fragment {
            return shade;
        }
        add::<S>(self.interpolated(simd, look, self.second), shade)
    }

    /// The part of shading that reads images.
    #[inline(always)]
    pub(crate) fn of_maps(&self) -> MappedPixels<'_, S> {
        MappedPixels { triangles: self.triangles, of: self.mapped, place: self.place, nearness: self.nearness }
    }

    /// Colors over w as colors. None is below 0; across a triangle seen edge-on slopes leave the range of its corners.
    #[inline(always)]
    fn interpolated(&self, simd: S, look: &Look, over_w: V3<S>) -> V3<S> {
        let colors = scale::<S>(over_w, look.screen.w_at(simd, self.nearness));
        each!(c in 3 => max::<S>(colors[c], splat(simd, 0.0)))
    }

    #[inline(always)]
    fn points(&self, simd: S, look: &Look, state: &State, back: bool) -> Points<S> {
        let w = look.screen.w_at(simd, self.nearness);
        let way = look.screen.way(simd, look.tile, self.place);
        let n = self.fragment_normal(simd, w, state, back);
        let p = [way[0] * w, way[1] * w, -look.screen.depth_at(simd, self.nearness, w)];
        // The ray through the pixel, not p: it has a direction however far p is.
        let v = to_viewer(simd, [way[0], way[1], splat(simd, -1.0)], n, look.pass.local_viewer);
        Points::new(simd, p, n, v)
    }

    /// The interpolated normal on the visible side, replaced by the triangle's own if it vanishes.
    #[inline(always)]
    fn fragment_normal(&self, simd: S, w: F<S>, state: &State, back: bool) -> V3<S> {
        let mut n = safe_normalize(simd, self.lead);
        if state.opposite_normals {
            let interpolated = scale::<S>(self.lead, w);
            let short = dot::<S>(interpolated, interpolated).simd_le(splat(simd, NORMAL_MIN * NORMAL_MIN));
            n = select3::<S>(short, self.face, n);
        }
        if back { neg::<S>(n) } else { n }
    }
}

/// A shader with one color for all its pixels, and its encoded value.
#[derive(Clone, Copy)]
pub(crate) struct Even<S: Simd> {
    shader: i32,
    bytes: I<S>,
}

impl<S: Simd> Even<S> {
    /// Nothing is drawn.
    #[inline(always)]
    pub(crate) fn clear(simd: S, pass: &Pass) -> Self {
        Self { shader: 0, bytes: bytes(simd, cleared(simd, pass.clear, pass.pixels), pass.pixels) }
    }
}

impl TileBuffer {
    /// Replaces the leading numbers by colors in the target's range.
    #[inline(always)]
    pub(crate) fn shade<S: Simd>(&mut self, simd: S, look: &Look, rows: usize) {
        let clear = cleared(simd, look.pass.clear, look.pass.pixels);
        for at in (0..rows * TILE).step_by(lanes::<S>()) {
            match look.pass.samples {
                Samples::One => {
                    let color = self.shade_one_apart(simd, look, at, behind(simd, look, at, clear));
                    self.put(simd, (0, at), color, look);
                }
                _ => self.shade_four(simd, look, at, behind(simd, look, at, clear)),
            }
        }
    }

    pub(crate) fn shade_one_apart<S: Simd>(&self, simd: S, look: &Look, at: usize, clear: V3<S>) -> V3<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                if look.painted {
                    self.shade_one::<S, true>(simd, look, at, clear)
                } else {
                    self.shade_one::<S, false>(simd, look, at, clear)
                }
            },
        )
    }

    /// The color of pixels with one sample each. Tiles that are not `PAINTED` take the fast path of plain draws.
    #[inline(always)]
    fn shade_one<S: Simd, const PAINTED: bool>(&self, simd: S, look: &Look, at: usize, clear: V3<S>) -> V3<S> {
        let shaders = load_i(simd, &self.shader[0], at);
        let mut left = (!shaders.simd_eq(splat_i(simd, 0))).to_bitmask();
        let mut color = clear;
        while left != 0 {
            let shader = self.shader[0][at + left.trailing_zeros() as usize];
            let same = shaders.simd_eq(splat_i(simd, shader));
            left &= !same.to_bitmask();
            let place = pixels(simd, at);
            // Lanes that are not drawn have no nearness and must not divide by 0.
            let nearness = same.select(load(simd, &self.depth[0], at), splat(simd, 1.0));
            let (state, back) = state_of(look.states, shader);
            let fragments = self.fragments(simd, (state, same), (0, at), place, nearness);
            let shade = if PAINTED {
                fragments.color_apart(simd, look, state, back)
            } else {
                fragments.color(simd, look, state, back)
            };
            color = select3::<S>(same, shade, color);
        }
        color
    }

    /// The same as bytes. `even` caches shaders of one color, so that vectors of one of them are not computed again.
    #[inline(always)]
    pub(crate) fn bytes_of_one<S: Simd, const PAINTED: bool>(
        &self,
        simd: S,
        look: &Look,
        at: usize,
        clear: V3<S>,
        even: &mut [Even<S>; 2],
    ) -> I<S> {
        let shaders = load_i(simd, &self.shader[0], at);
        for Even { shader, bytes } in even.iter() {
            if shaders.simd_eq(splat_i(simd, *shader)).all_true() {
                return *bytes;
            }
        }
        let color = if PAINTED {
            self.shade_one_apart(simd, look, at, clear)
        } else {
            self.shade_one::<S, false>(simd, look, at, clear)
        };
        let bytes = bytes(simd, color, look.pass.pixels);
        let shader = self.shader[0][at];
        let one = shader != 0 && state_of(look.states, shader).0.is_even();
        if one && shaders.simd_eq(splat_i(simd, shader)).all_true() {
            even[1] = Even { shader, bytes };
        }
        bytes
    }

    /// The pixels from `at` on whose samples are all equal.
    #[inline(always)]
    fn even<S: Simd>(&self, simd: S, at: usize) -> M<S> {
        load_i(simd, &self.shader[1], at).simd_eq(splat_i(simd, EVEN))
    }

    /// The color of pixels with four samples each.
    #[inline(always)]
    pub(crate) fn color_of_four<S: Simd>(&mut self, simd: S, look: &Look, at: usize, clear: V3<S>) -> V3<S> {
        if self.even(simd, at).all_true() {
            return kept(simd, self.shade_samples(simd, look, (0, at), clear), look.pass.pixels);
        }
        self.shade_four(simd, look, at, clear);
        self.resolved(simd, at, Samples::Four)
    }

    #[inline(always)]
    fn shade_four<S: Simd>(&mut self, simd: S, look: &Look, at: usize, clear: V3<S>) {
        if self.even(simd, at).all_true() {
            let color = self.shade_samples(simd, look, (0, at), clear);
            for sample in 0..4 {
                self.put(simd, (sample, at), color, look);
            }
            return;
        }
        for sample in 0..4 {
            let color = self.shade_samples(simd, look, (sample, at), clear);
            self.put(simd, (sample, at), color, look);
        }
    }

    /// The color of one sample each, those before being shaded.
    #[inline(always)]
    fn shade_samples<S: Simd>(&self, simd: S, look: &Look, (sample, at): (usize, usize), clear: V3<S>) -> V3<S> {
        let triangle = load_i(simd, &self.triangle[sample], at);
        let mut left = (!load_i(simd, &self.shader[sample], at).simd_eq(splat_i(simd, 0))).to_bitmask();
        let mut color = clear;
        if sample > 0 {
            let even = self.even(simd, at);
            color = select3::<S>(even, load3(simd, &self.lead[0], at), color);
            left &= !even.to_bitmask();
        }
        // The shading of another sample of the pixel is reused.
        for before in 0..sample {
            let lit = !load_i(simd, &self.shader[before], at).simd_eq(splat_i(simd, 0));
            let same = triangle.simd_eq(load_i(simd, &self.triangle[before], at)) & lit;
            let other = load3(simd, &self.lead[before], at);
            let here = fearless_simd::SimdMask::from_bitmask(simd, left);
            color = select3::<S>(same & here, other, color);
            left &= !same.to_bitmask();
        }
        while left != 0 {
            let shader = self.shader[sample][at + left.trailing_zeros() as usize] & SHADER_BITS;
            let all = load_i(simd, &self.shader[sample], at);
            let same = (all & splat_i(simd, SHADER_BITS)).simd_eq(splat_i(simd, shader));
            let fresh = same & fearless_simd::SimdMask::from_bitmask(simd, left);
            left &= !same.to_bitmask();
            let mut place = pixels(simd, at);
            for axis in 0..2 {
                for lane in 0..lanes::<S>() {
                    place[axis][lane] += CENTROIDS[(all[lane] >> CENTROID_SHIFT) as usize & 15][axis];
                }
            }
            let nearness = fresh.select(load(simd, &self.nearness[sample], at), splat(simd, 1.0));
            let (state, back) = state_of(look.states, shader);
            let fragments = self.fragments(simd, (state, fresh), (sample, at), place, nearness);
            color = select3::<S>(fresh, fragments.color_apart(simd, look, state, back), color);
        }
        color
    }

    #[inline(always)]
    fn fragments<S: Simd>(
        &self,
        simd: S,
        (state, shown): (&State, M<S>),
        (sample, at): (usize, usize),
        place: [F<S>; 2],
        nearness: F<S>,
    ) -> Fragments<'_, S> {
        let zero = [splat(simd, 0.0); 3];
        Fragments {
            place,
            nearness,
            lead: load3(simd, &self.lead[sample], at),
            second: if state.stage == Stage::Mixed { load3(simd, &self.second[sample], at) } else { zero },
            mapped: if state.maps.is_some() {
                shown.select(load_i(simd, &self.mapped[sample], at), splat_i(simd, -1))
            } else {
                splat_i(simd, -1)
            },
            triangles: &self.mapped_triangles,
            paint: if state.shades_paint() { load3(simd, &self.paint[sample], at) } else { zero },
            face: if state.opposite_normals { load3(simd, &self.face[sample], at) } else { zero },
        }
    }

    #[inline(always)]
    fn put<S: Simd>(&mut self, simd: S, (sample, at): (usize, usize), color: V3<S>, look: &Look) {
        let color = kept(simd, color, look.pass.pixels);
        for c in 0..3 {
            store::<S>(color[c], &mut self.lead[sample][c], at);
        }
    }

    /// The colors of pixels: their own, or the mean of their samples.
    #[inline(always)]
    pub(crate) fn resolved<S: Simd>(&self, simd: S, at: usize, samples: Samples) -> V3<S> {
        match samples {
            Samples::One => load3(simd, &self.lead[0], at),
            Samples::Four | Samples::Sixteen | Samples::SixtyFour => {
                // Quarters first: the sum of the four largest numbers would overflow.
                let [a, b, c, d] = each!(sample in 4 => {
                    scale::<S>(load3(simd, &self.lead[sample], at), splat(simd, 0.25))
                });
                add::<S>(add::<S>(a, b), add::<S>(c, d))
            }
        }
    }
}

/// The meaning of a shader's number.
#[inline(always)]
pub(crate) fn state_of(states: &[State], shader: i32) -> (&State, bool) {
    (&states[(shader as usize >> 1) - 1], shader & 1 != 0)
}

/// The number of a state's shader.
pub(crate) fn shader_of(state: u32, back: bool) -> i32 {
    2 + 2 * state as i32 + i32::from(back)
}

/// Column and row of pixels from `at` on, all in one row.
#[inline(always)]
fn pixels<S: Simd>(simd: S, at: usize) -> [F<S>; 2] {
    [counting(simd) + splat(simd, (at % TILE) as f32), splat(simd, (at / TILE) as f32)]
}

//! Pixels of draws with images or a mask.

use crate::input::attributes::{
    AMBIENT_OF_VERTICES, COLOR, FRAME, MIRROR_NORMAL, NORMAL, OF_VERTICES, PARTS, PLACE, UVS,
};
use crate::input::pass::{DrawMaps, MapCall, Pass};
use crate::lighting::state::{Stage, State};
use crate::lighting::{Irradiance, Points, to_viewer};
use crate::pixels::look::Look;
use crate::simd::lanes::{F, I, M, Simd, V3, each, lanes, splat, splat_i, splat3};
use crate::simd::lobe::{AxialGloss, Gloss};
use crate::triangles::mapped::{MappedTriangle, PartsOf};
use crate::triangles::planes::Slopes;
use crate::vertices::placed::TILE;
use fearless_simd::prelude::*;
use halfway_lighting::Reflectance;
use halfway_lighting::equations::{NORMAL_MIN, bumped_normal, lobe_axes, mapped_normal};
use halfway_lighting::record::MaterialRecord;
use halfway_texture::normals::{SlopeSpread, lean_lobe, mean_length, spread_length, toksvig};
use halfway_texture::{FarNormals, MapKind, UvTransform, lookup};

/// A pixel of a mapped triangle.
pub(crate) struct MappedPixel<'a> {
    pub(crate) triangle: &'a MappedTriangle,
    maps: &'a DrawMaps,
    pass: &'a Pass<'a>,
    /// In pixels from the tile's first.
    pub(crate) place: [f32; 2],
    w: f32,
}

/// The filtered normal map at a pixel.
#[derive(Clone, Copy)]
pub(crate) struct SeenNormals {
    /// The mean, or the normal of the mean slopes, encoded as a texel.
    texel: [f32; 3],
    amount: f32,
    roughness: Roughness,
}

/// The roughness of the filtered normals, scaled by the amount.
#[derive(Clone, Copy)]
enum Roughness {
    None,
    /// The length of the mean.
    Length(f32),
    /// The covariance of the slopes.
    Covariance([f32; 3]),
}

/// Highlights of a pixel.
pub(crate) struct PixelGloss {
    /// The exponent of round highlights, or of the mirrored environment.
    pub(crate) exponent: f32,
    /// Their factor.
    factor: f32,
    /// The inverse of their widths along the axes, if they are anisotropic.
    widths: Option<[f32; 3]>,
}

/// The texture coordinates of a pixel, and their change to the next pixel along x and along y.
struct OnImage {
    uv: [f32; 2],
    footprint: [[f32; 2]; 2],
}

impl MappedPixel<'_> {
    /// Four numbers.
    fn group(&self, group: usize) -> [f32; 4] {
        let Slopes { base, dx, dy } = &self.triangle.groups[group];
        let [x, y] = each!(axis in 2 => self.place[axis] - self.triangle.first[axis]);
        each!(k in 4 => (base[k] + dx[k] * x + dy[k] * y) * self.w)
    }

    pub(crate) fn three(&self, group: usize) -> [f32; 3] {
        let [a, b, c, _] = self.group(group);
        [a, b, c]
    }

    /// How 1/w grows from pixel to pixel.
    fn inverse_w_steps(&self) -> [f32; 2] {
        self.triangle.nearness.map(|step| self.pass.lens.inverse_w_step(step))
    }

    /// u/w, v/w and 1/w are linear over the picture: by the quotient rule ∂u = w·(∂(u/w) − u·∂(1/w)).
    fn on_image(&self, call: &MapCall) -> OnImage {
        let data = &self.pass.maps[call.map as usize];
        let Slopes { dx, dy, .. } = &self.triangle.groups[UVS];
        let all = self.group(UVS);
        let first = 2 * call.uv_set as usize;
        let uv = [all[first], all[first + 1]];
        let [wx, wy] = self.inverse_w_steps();
        let ways = [(dx, wx), (dy, wy)].map(|(slope, of_w)| {
            let way = each!(k in 2 => self.w * (slope[first + k] - uv[k] * of_w));
            each!(k in 2 => data.rows[k][0] * way[0] + data.rows[k][1] * way[1])
        });
        let uv = UvTransform::apply(&data.rows, uv);
        OnImage { uv, footprint: ways }
    }

    /// The filtered texels of an image, each number in 0 to 1.
    fn texel(&self, call: &MapCall) -> [f32; 4] {
        let OnImage { uv, footprint } = self.on_image(call);
        let data = &self.pass.maps[call.map as usize];
        // Sums of the largest texels may be NaN.
        lookup::filtered(&data.pyramid, &call.sampling, uv, footprint).map(|t| if t > 0.0 { t.min(1.0) } else { 0.0 })
    }

    /// The factor of an image: 1 where there is none.
    fn factor(&self, kind: MapKind) -> [f32; 4] {
        let Some(call) = &self.maps.calls[kind as usize] else { return [1.0; 4] };
        let amount = self.pass.maps[call.map as usize].amount;
        self.texel(call).map(|number| 1.0 + amount * (number - 1.0))
    }

    pub(crate) fn factor_of_one(&self, kind: MapKind) -> f32 {
        self.maps.calls[kind as usize].map_or(1.0, |call| self.factor(kind)[call.channel as usize])
    }

    /// The factor of the solid: 1 where there is none.
    fn solid(&self) -> [f32; 3] {
        let Some(solid) = &self.maps.solid else { return [1.0; 3] };
        let p = self.three(PLACE);
        let Slopes { dx, dy, .. } = &self.triangle.groups[PLACE];
        let [wx, wy] = self.inverse_w_steps();
        // As of images.
        let way = |slope: &[f32; 4], of_w: f32| each!(axis in 3 => self.w * (slope[axis] - p[axis] * of_w));
        solid.color_at(p, [way(dx, wx), way(dy, wy)])
    }

    /// The opacity, without the material's.
    fn opacity(&self, state: &State) -> f32 {
        let of_vertices = if !state.colored {
            1.0
        } else if state.stage == Stage::Flat {
            self.triangle.alpha
        } else {
            self.group(COLOR)[3].clamp(0.0, 1.0)
        };
        let has_own = self.maps.has(MapKind::Opacity);
        of_vertices * if has_own { self.factor_of_one(MapKind::Opacity) } else { self.factor(MapKind::Color)[3] }
    }

    /// The filtered normal map, if light is shaded at the fragments.
    pub(crate) fn normals(&self, state: &State) -> Option<SeenNormals> {
        let call = self.maps.calls[MapKind::Normal as usize].as_ref()?;
        if !matches!(state.stage, Stage::Fragment | Stage::Mixed) {
            return None;
        }
        let data = &self.pass.maps[call.map as usize];
        // A mirrored direction turns twice as far.
        let turned = if state.reflectance == Reflectance::Phong { 2.0 * data.amount } else { data.amount };
        if call.far_normals == FarNormals::Lean {
            let OnImage { uv, footprint } = self.on_image(call);
            let seen = SlopeSpread::filtered(&data.pyramid, &call.sampling, uv, footprint);
            let roughness = Roughness::Covariance(seen.covariance(turned));
            return Some(SeenNormals { texel: seen.texel(), amount: data.amount, roughness });
        }
        let [r, g, b, _] = self.texel(call);
        let texel = [r, g, b];
        let has_length = call.far_normals == FarNormals::Toksvig;
        let roughness = if has_length { Roughness::Length(mean_length(texel, turned)) } else { Roughness::None };
        Some(SeenNormals { texel, amount: data.amount, roughness })
    }

    /// The interpolated normal as images turn it where light is shaded at the fragments, or the triangle's under flat
    /// shading; of the front. `way` is x and y where w is 1, and changes by `steps` to the next pixel.
    pub(crate) fn normal(&self, state: &State, seen: Option<&SeenNormals>, way: [f32; 2], steps: [f32; 2]) -> [f32; 3] {
        let n = match state.stage {
            Stage::Flat => return self.triangle.face,
            Stage::Unlit | Stage::Vertex => self.three(MIRROR_NORMAL),
            Stage::Fragment | Stage::Mixed => self.three(NORMAL),
        };
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        let is_short = state.opposite_normals && length <= NORMAL_MIN;
        let otherwise = if is_short { self.triangle.face } else { n.map(|x| x / length.max(f32::MIN_POSITIVE)) };
        if matches!(state.stage, Stage::Unlit | Stage::Vertex) {
            return otherwise;
        }
        if let Some(SeenNormals { texel, amount, .. }) = seen.copied() {
            let [x, y, z, w] = self.group(FRAME);
            return mapped_normal(n, [x, y, z], w, texel, amount, otherwise);
        }
        let Some(call) = &self.maps.calls[MapKind::Height as usize] else { return otherwise };
        let OnImage { uv, footprint } = self.on_image(call);
        let data = &self.pass.maps[call.map as usize];
        let d = lookup::level(data.pyramid.size(), footprint);
        let [along_u, along_v] = lookup::gradient(&data.pyramid, &call.sampling, uv, d, call.channel);
        let rises = footprint.map(|[u, v]| data.amount * (along_u * u + along_v * v));
        // p = (way·w, −depth), and ∂w = −w²·∂(1/w).
        let lens = &self.pass.lens;
        let [nx, ny] = self.triangle.nearness;
        let along = [(0, nx), (1, ny)].map(|(axis, step)| {
            let grown = -self.w * self.w * lens.inverse_w_step(step);
            let mut to_next = [way[0] * grown, way[1] * grown, -lens.depth_step(step, self.w)];
            to_next[axis] += steps[axis] * self.w;
            to_next
        });
        bumped_normal(n, self.three(FRAME), along, rises, otherwise)
    }

    /// The highlights of a material with this exponent.
    pub(crate) fn gloss(&self, seen: Option<&SeenNormals>, exponent: f32) -> PixelGloss {
        let exponent = exponent * self.factor_of_one(MapKind::Shininess);
        match seen.map_or(Roughness::None, |seen| seen.roughness) {
            Roughness::None => PixelGloss { exponent, factor: 1.0, widths: None },
            Roughness::Length(length) => {
                let [exponent, factor] = toksvig(length, exponent);
                PixelGloss { exponent, factor, widths: None }
            }
            Roughness::Covariance(covariance) => {
                let [aa, ab, bb, factor] = lean_lobe(covariance, exponent);
                let [exponent, _] = toksvig(spread_length(covariance), exponent);
                PixelGloss { exponent, factor, widths: Some([aa, ab, bb]) }
            }
        }
    }

    /// The axes of highlights about a normal of the front.
    fn axes(&self, n: [f32; 3]) -> [[f32; 3]; 2] {
        let [x, y, z, w] = self.group(FRAME);
        lobe_axes(n, [x, y, z], w)
    }
}

/// Pixels of mapped draws of one state: each names its triangle, or −1.
pub(crate) struct MappedPixels<'a, S: Simd> {
    pub(crate) triangles: &'a [MappedTriangle],
    pub(crate) of: I<S>,
    pub(crate) place: [F<S>; 2],
    pub(crate) nearness: F<S>,
}

impl<S: Simd> MappedPixels<'_, S> {
    fn pixel<'a>(&'a self, lane: usize, pass: &'a Pass<'a>, maps: &'a DrawMaps) -> Option<MappedPixel<'a>> {
        let triangle = self.triangles.get(usize::try_from(self.of[lane]).ok()?)?;
        let place = [self.place[0][lane], self.place[1][lane]];
        Some(MappedPixel { triangle, maps, pass, place, w: 1.0 / pass.lens.inverse_w(self.nearness[lane]) })
    }

    /// Their opacities, including the material's; 0 without a triangle.
    #[inline(never)]
    pub(crate) fn opacities(&self, simd: S, pass: &Pass, state: &State, back: bool) -> F<S> {
        let mut opacities = splat(simd, 0.0);
        let Some(maps) = &state.maps else { return opacities };
        for lane in 0..lanes::<S>() {
            if let Some(pixel) = self.pixel(lane, pass, maps) {
                opacities[lane] = state.side(pass, back).opacity * pixel.opacity(state);
            }
        }
        opacities
    }

    /// Whether the mask keeps them; always without a mask.
    pub(crate) fn are_there(&self, simd: S, pass: &Pass, state: &State, back: bool) -> M<S> {
        let cutoff = state.maps.and_then(|maps| maps.mask).unwrap_or(f32::NEG_INFINITY);
        self.opacities(simd, pass, state, back).simd_ge(splat(simd, cutoff))
    }

    /// Their colors.
    #[inline(never)]
    pub(crate) fn colors(&self, simd: S, look: &Look, state: &State, back: bool) -> V3<S> {
        simd.vectorize(
            #[inline(always)]
            || self.colors_here(simd, look, state, back),
        )
    }

    #[inline(always)]
    fn colors_here(&self, simd: S, look: &Look, state: &State, back: bool) -> V3<S> {
        let Some(maps) = &state.maps else { return splat3(simd, [0.0; 3]) };
        let at_fragments = matches!(state.stage, Stage::Fragment | Stage::Mixed);
        let lit = if at_fragments { self.lit(simd, look, state, maps, back) } else { Irradiance::none(simd) };
        let side = state.side(look.pass, back);
        let mut colors = splat3(simd, [0.0; 3]);
        for lane in 0..lanes::<S>() {
            let Some(pixel) = self.pixel(lane, look.pass, maps) else { continue };
            let of_lights = [lit.ambient, lit.diffuse, lit.specular].map(|of| each!(c in 3 => of[c][lane]));
            let [mut ambient, diffuse, mut specular] = parts(&pixel, state, side, of_lights);
            if maps.surrounded
                && let Some(around) = look.pass.surroundings
            {
                let [of_normal, of_mirror] = pixel.surrounded(around, look, state, back);
                ambient = each!(c in 3 => ambient[c] + of_normal[c]);
                specular = each!(c in 3 => specular[c] + of_mirror[c]);
            }
            let [color, shiny, glow] =
                [MapKind::Color, MapKind::Specular, MapKind::Emission].map(|kind| pixel.factor(kind));
            let occlusion = pixel.factor_of_one(MapKind::Occlusion);
            let cut = pixel.solid();
            for c in 0..3 {
                let tinted = cut[c] * color[c] * (occlusion * ambient[c] + diffuse[c]);
                colors[c][lane] = tinted + shiny[c] * specular[c] + glow[c] * side.emission[c];
            }
        }
        colors
    }

    /// The light at the pixels.
    #[inline(always)]
    fn lit(&self, simd: S, look: &Look, state: &State, maps: &DrawMaps, back: bool) -> Irradiance<S> {
        let w = look.screen.w_at(simd, self.nearness);
        let way = each!(axis in 2 => {
            let first = splat(simd, look.tile[axis] as f32 * TILE as f32);
            let pixel = self.place[axis] + first;
            pixel * splat(simd, look.screen.way_step[axis]) + splat(simd, look.screen.way_start[axis])
        });
        let mut n = splat3(simd, [0.0, 0.0, 1.0]);
        let side = state.side(look.pass, back);
        let (mut exponents, mut factors) = (splat(simd, side.shininess), splat(simd, 1.0));
        let changes = maps.changes_exponents();
        let mut axial = AxialGloss::none(simd, state.gloss(back));
        for lane in 0..lanes::<S>() {
            let Some(pixel) = self.pixel(lane, look.pass, maps) else { continue };
            let seen = pixel.normals(state);
            let turned = pixel.normal(state, seen.as_ref(), [way[0][lane], way[1][lane]], look.screen.way_step);
            for axis in 0..3 {
                n[axis][lane] = if back { -turned[axis] } else { turned[axis] };
            }
            if changes {
                let gloss = pixel.gloss(seen.as_ref(), side.shininess);
                (exponents[lane], factors[lane]) = (gloss.exponent, gloss.factor);
                if let Some(widths) = gloss.widths {
                    axial.set(lane, pixel.axes(turned), widths);
                }
            }
        }
        let v = to_viewer(simd, [way[0], way[1], splat(simd, -1.0)], n, look.pass.local_viewer);
        let points = Points::new(simd, [way[0] * w, way[1] * w, -look.screen.depth_at(simd, self.nearness, w)], n, v);
        if !changes {
            return state.fragment_terms(simd, look.pass, &points, state.gloss(back));
        }
        if maps.far_normals() == FarNormals::Lean {
            axial.otherwise = exponents;
            let sum = state.fragment_terms(simd, look.pass, &points, axial);
            return Irradiance { specular: each!(c in 3 => sum.specular[c] * factors), ..sum };
        }
        // The lights are summed once for each exponent.
        let mut sum = Irradiance::none(simd);
        let mut left = (!self.of.simd_lt(splat_i(simd, 0))).to_bitmask();
        while left != 0 {
            let first = left.trailing_zeros();
            let exponent = exponents[first as usize];
            let same = exponents.simd_eq(splat(simd, exponent));
            left &= !(same.to_bitmask() | 1 << first);
            let gloss = Gloss::new(state.reflectance, &MaterialRecord { shininess: exponent, ..*side });
            sum = sum.or(same, &state.fragment_terms(simd, look.pass, &points, gloss));
        }
        Irradiance { specular: each!(c in 3 => sum.specular[c] * factors), ..sum }
    }
}

/// The ambient, diffuse and specular part of a pixel; `lit` is the light at the fragment.
fn parts(pixel: &MappedPixel, state: &State, side: &MaterialRecord, lit: PartsOf) -> PartsOf {
    // Across a triangle seen edge-on slopes leave the range of its corners.
    let interpolated = |group| pixel.three(group).map(|x| x.max(0.0));
    match state.stage {
        Stage::Flat => return pixel.triangle.parts,
        Stage::Vertex => return each!(part in 3 => interpolated(PARTS + part)),
        Stage::Unlit | Stage::Fragment | Stage::Mixed => {}
    }
    let color = if state.colored { pixel.three(COLOR).map(|x| x.clamp(0.0, 1.0)) } else { [1.0; 3] };
    let [mut ambient, mut diffuse, mut specular] = [
        each!(c in 3 => color[c] * (side.base[c] + side.ambient[c] * lit[0][c])),
        each!(c in 3 => color[c] * side.diffuse[c] * lit[1][c]),
        each!(c in 3 => side.specular[c] * lit[2][c]),
    ];
    if state.stage == Stage::Mixed {
        let of_vertices = interpolated(OF_VERTICES);
        let to = if state.vertex.diffuse { &mut diffuse } else { &mut specular };
        *to = each!(c in 3 => to[c] + of_vertices[c]);
        if state.vertex.diffuse {
            let of_vertices = interpolated(AMBIENT_OF_VERTICES);
            ambient = each!(c in 3 => ambient[c] + of_vertices[c]);
        }
    }
    [ambient, diffuse, specular]
}

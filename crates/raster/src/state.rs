//! What shading takes from draws and surfaces, looked up by the number that a pixel keeps.

use crate::lanes::Simd;
use crate::lighting::{Gloss, Irradiance, Points, gathered, gathered_here};
use crate::pass::{
    DrawCall, Highlight, LeftOut, LightRange, MapCall, MapData, Pass, ShadedTerms, SideData, SurfaceData,
};
use crate::power::Exponent;

/// Where a draw's terms are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Nowhere: only the base.
    Unlit,
    /// At a triangle's centroid.
    Flat,
    /// At the vertices.
    Vertex,
    /// At the fragments.
    Fragment,
    /// Some there, some here.
    Mixed,
}

/// An image of a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StateMap {
    pub(crate) call: MapCall,
    /// Where on it texture coordinates lie.
    pub(crate) rows: [[f32; 3]; 2],
    /// Its columns and rows.
    pub(crate) size: [f32; 2],
}

/// A surface in a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) stage: Stage,
    pub(crate) surface: u32,
    pub(crate) vertex: ShadedTerms,
    pub(crate) fragment: ShadedTerms,
    pub(crate) highlight: Highlight,
    /// Whether triangles keep their own normal for where the interpolated one vanishes.
    pub(crate) opposite_normals: bool,
    /// Whether backs are drawn.
    pub(crate) backs: bool,
    /// Whether the vertices' colors count.
    pub(crate) colored: bool,
    /// The image that is looked up.
    pub(crate) map: Option<StateMap>,
    /// Exponents of the highlights of front and back, halved for Blinn–Phong.
    exponents: [Exponent; 2],
}

impl State {
    pub(crate) fn new(draw: &DrawCall, surface: u32, data: &SurfaceData, maps: &[MapData]) -> Self {
        let lit = |terms: ShadedTerms, [all, diffuse, specular]: [LightRange; 3]| {
            let has_diffuse = terms.diffuse && !(all.is_empty() && diffuse.is_empty());
            let has_specular = terms.specular && !(all.is_empty() && specular.is_empty());
            ShadedTerms { diffuse: has_diffuse, specular: has_specular }
        };
        let vertex = lit(draw.vertex, data.vertex_ranges());
        let fragment = lit(draw.fragment, data.fragment_ranges());
        let stage = match (vertex.is_empty(), fragment.is_empty()) {
            // A flat triangle has the color of one point, whatever light there is.
            (true, true) if draw.flat && (draw.colored || draw.map.is_some()) => Stage::Flat,
            (true, true) => Stage::Unlit,
            (false, true) if draw.flat => Stage::Flat,
            (false, true) => Stage::Vertex,
            (true, false) => Stage::Fragment,
            (false, false) => Stage::Mixed,
        };
        let exponent = |side: &SideData| match draw.highlight {
            Highlight::Phong => Exponent::new(side.exponent),
            Highlight::BlinnPhong => Exponent::new(side.exponent).halved(),
        };
        Self {
            stage,
            surface,
            vertex,
            fragment,
            highlight: draw.highlight,
            opposite_normals: draw.opposite_normals && matches!(stage, Stage::Fragment | Stage::Mixed),
            backs: draw.left_out != LeftOut::Back,
            colored: draw.colored,
            map: draw.map.and_then(|call| {
                let MapData { pyramid, rows } = maps.get(call.map as usize)?;
                Some(StateMap { call, rows: *rows, size: pyramid.size().map(|side| side as f32) })
            }),
            exponents: [exponent(&data.front), exponent(&data.back)],
        }
    }

    /// How a side takes light.
    pub(crate) fn gloss(&self, back: bool) -> Gloss {
        Gloss { highlight: self.highlight, exponent: self.exponents[usize::from(back)] }
    }

    /// What the lights of the vertex terms bring to points.
    #[inline(always)]
    pub(crate) fn vertex_terms<S: Simd>(&self, simd: S, pass: &Pass, points: &Points<S>, back: bool) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered(simd, (pass.lights, pass.lists), surface.vertex_ranges(), points, self.gloss(back), self.vertex)
    }

    /// What the lights of the fragment terms bring to points.
    #[inline(always)]
    pub(crate) fn fragment_terms<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        points: &Points<S>,
        back: bool,
    ) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered_here(
            simd,
            (pass.lights, pass.lists),
            surface.fragment_ranges(),
            points,
            self.gloss(back),
            self.fragment,
        )
    }

    /// Whether fragments take the vertices' colors: where no color has been shaded before them.
    #[inline(always)]
    pub(crate) fn shades_paint(&self) -> bool {
        self.colored && matches!(self.stage, Stage::Unlit | Stage::Fragment | Stage::Mixed)
    }

    /// Whether more than the material says at the fragments how light is given back.
    #[inline(always)]
    pub(crate) fn shades_apart(&self) -> bool {
        self.map.is_some() || self.shades_paint()
    }

    /// Whether all its pixels have one color.
    pub(crate) fn is_even(&self) -> bool {
        self.stage == Stage::Unlit && !self.is_painted()
    }

    /// Whether anything but the material says what ambient and diffuse light is given back.
    #[inline(always)]
    pub(crate) fn is_painted(&self) -> bool {
        self.colored || self.map.is_some()
    }

    /// Whether vertices keep two sums: what the image multiplies, and what it does not.
    #[inline(always)]
    pub(crate) fn keeps_parts(&self) -> bool {
        self.map.is_some() && matches!(self.stage, Stage::Flat | Stage::Vertex)
    }

    /// The material of a side.
    pub(crate) fn side<'a>(&self, pass: &Pass<'a>, back: bool) -> &'a SideData {
        let surface = &pass.surfaces[self.surface as usize];
        if back { &surface.back } else { &surface.front }
    }
}

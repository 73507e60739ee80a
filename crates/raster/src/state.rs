//! What shading takes from draws and surfaces, looked up by the number that a pixel keeps.

use crate::lanes::Simd;
use crate::lighting::{Irradiance, Points, ShadedTerms, gathered, gathered_here};
use crate::lobe::{AxialGloss, Gloss};
use crate::pass::{Cull, DrawCall, MapCall, Pass};
use halfway_lighting::record::{LightRange, MaterialRecord, SurfaceLights, SurfaceRecord};
use halfway_lighting::{Frequency, Reflectance};
use halfway_texture::{FarNormals, MapKind, SolidTexture};

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

/// What a draw's fragments take from images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StateMaps {
    pub(crate) calls: [Option<MapCall>; MapKind::COUNT],
    pub(crate) mask: Option<f32>,
    /// Factors of tangents, and of w.
    pub(crate) signs: [f32; 2],
    /// What it is cut from.
    pub(crate) solid: Option<SolidTexture>,
    /// Whether the environment lights it.
    pub(crate) surrounded: bool,
}

impl StateMaps {
    /// `None` where the draw has neither images nor a mask, nor a solid or an environment.
    pub(crate) fn of(draw: &DrawCall) -> Option<Self> {
        let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
        let signs = [sign(draw.inside_out), sign(draw.clockwise)];
        draw.is_mapped().then_some(Self {
            calls: draw.maps,
            mask: draw.mask,
            signs,
            solid: draw.solid,
            surrounded: draw.surrounded,
        })
    }

    pub(crate) fn has(&self, kind: MapKind) -> bool {
        self.calls[kind as usize].is_some()
    }

    /// Whether images change the exponent of highlights.
    pub(crate) fn changes_exponents(&self) -> bool {
        self.has(MapKind::Shininess) || self.far_normals() != FarNormals::Mean
    }

    /// What highlights take of normals of an image beside where they point.
    pub(crate) fn far_normals(&self) -> FarNormals {
        self.calls[MapKind::Normal as usize].map_or(FarNormals::Mean, |call| call.far_normals)
    }

    /// Whether something of it may be cut out.
    pub(crate) fn is_masked(&self) -> bool {
        self.mask.is_some()
    }
}

/// A surface in a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) stage: Stage,
    pub(crate) surface: u32,
    pub(crate) vertex: ShadedTerms,
    pub(crate) fragment: ShadedTerms,
    pub(crate) reflectance: Reflectance,
    /// Whether triangles keep their own normal for where the interpolated one vanishes.
    pub(crate) opposite_normals: bool,
    /// Whether backs are drawn.
    pub(crate) backs: bool,
    /// Whether the vertices' colors count.
    pub(crate) colored: bool,
    /// Images and a mask.
    pub(crate) maps: Option<StateMaps>,
    /// How front and back take light.
    glosses: [Gloss; 2],
}

impl State {
    pub(crate) fn new(draw: &DrawCall, number: u32, surface: &SurfaceRecord) -> Self {
        let lit = |frequency: fn(Frequency) -> bool| {
            let terms = [draw.terms.diffuse, draw.terms.specular].map(frequency);
            // The environment takes normals as lights would have them.
            let SurfaceLights { both, diffuse, specular } = &surface.lights;
            let reaches = |range: &LightRange| draw.surrounded || !(both.is_empty() && range.is_empty());
            ShadedTerms { diffuse: terms[0] && reaches(diffuse), specular: terms[1] && reaches(specular) }
        };
        let flat = draw.terms.has(Frequency::Triangle);
        let vertex = lit(|term| matches!(term, Frequency::Triangle | Frequency::Vertex));
        let fragment = lit(|term| term == Frequency::Fragment);
        let stage = match (vertex.is_empty(), fragment.is_empty()) {
            // A flat triangle has the color of one point, whatever light there is.
            (true, true) if flat && (draw.colored || draw.is_mapped()) => Stage::Flat,
            (true, true) => Stage::Unlit,
            (false, true) if flat => Stage::Flat,
            (false, true) => Stage::Vertex,
            (true, false) => Stage::Fragment,
            (false, false) => Stage::Mixed,
        };
        Self {
            stage,
            surface: number,
            vertex,
            fragment,
            reflectance: draw.reflectance,
            opposite_normals: draw.opposite_normals
                && (matches!(stage, Stage::Fragment | Stage::Mixed) || draw.surrounded && stage != Stage::Flat),
            backs: draw.cull != Cull::Back,
            colored: draw.colored,
            maps: StateMaps::of(draw),
            glosses: [&surface.front, &surface.back].map(|side| Gloss::new(draw.reflectance, side.shininess)),
        }
    }

    /// The same of pieces of which no interpolated normal vanishes.
    pub(crate) fn without_opposite_normals(self) -> Self {
        Self { opposite_normals: false, ..self }
    }

    /// How a side takes light.
    pub(crate) fn gloss(&self, back: bool) -> Gloss {
        self.glosses[usize::from(back)]
    }

    /// What the lights of the vertex terms bring to points.
    #[inline(always)]
    pub(crate) fn vertex_terms<S: Simd>(&self, simd: S, pass: &Pass, points: &Points<S>, back: bool) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered(simd, (pass.lights, pass.lists), &surface.lights, points, self.gloss(back), self.vertex)
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
        self.fragment_terms_of(simd, pass, points, self.gloss(back))
    }

    /// The same for another exponent.
    #[inline(always)]
    pub(crate) fn fragment_terms_of<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        points: &Points<S>,
        gloss: Gloss,
    ) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered_here(simd, (pass.lights, pass.lists), &surface.lights, points, gloss, self.fragment)
    }

    /// The same for highlights that are not round.
    pub(crate) fn axial_terms<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        points: &Points<S>,
        axial: AxialGloss<S>,
    ) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered(simd, (pass.lights, pass.lists), &surface.lights, points, axial, self.fragment)
    }

    /// Whether the vertices' colors go a way of their own, which they do unless images have part in it.
    #[inline(always)]
    pub(crate) fn paints(&self) -> bool {
        self.colored && self.maps.is_none()
    }

    /// Whether fragments take them: where no color has been shaded before them.
    #[inline(always)]
    pub(crate) fn shades_paint(&self) -> bool {
        self.paints() && matches!(self.stage, Stage::Unlit | Stage::Fragment | Stage::Mixed)
    }

    /// Whether more than the material says at the fragments how light is given back.
    #[inline(always)]
    pub(crate) fn shades_apart(&self) -> bool {
        self.maps.is_some() || self.shades_paint()
    }

    /// Whether all its pixels have one color.
    pub(crate) fn is_even(&self) -> bool {
        self.stage == Stage::Unlit && !self.is_painted()
    }

    /// Whether anything but the material says what ambient and diffuse light is given back.
    #[inline(always)]
    pub(crate) fn is_painted(&self) -> bool {
        self.colored || self.maps.is_some()
    }

    /// The material of a side.
    pub(crate) fn side<'a>(&self, pass: &Pass<'a>, back: bool) -> &'a MaterialRecord {
        let surface = &pass.surfaces[self.surface as usize];
        if back { &surface.back } else { &surface.front }
    }
}

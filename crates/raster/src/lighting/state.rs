//! Inputs of shading from draws and surfaces, looked up by the number that a pixel keeps.

use crate::input::pass::{DrawCall, DrawMaps, Pass};
use crate::lighting::{Irradiance, Points, ShadedTerms, gathered, gathered_here};
use crate::simd::lanes::Simd;
use crate::simd::lobe::{Gloss, PointLobe};
use halfway_lighting::record::Cull;
use halfway_lighting::record::{LightRange, MaterialRecord, SurfaceLights, SurfaceRecord};
use halfway_lighting::{Frequency, Reflectance};

/// The stage at which a draw's terms are shaded.
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
    /// The diffuse and the specular term at different ones.
    Mixed,
}

/// A surface in a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent fact about the draw")]
pub(crate) struct State {
    pub(crate) stage: Stage,
    pub(crate) surface: u32,
    pub(crate) vertex: ShadedTerms,
    pub(crate) fragment: ShadedTerms,
    pub(crate) reflectance: Reflectance,
    /// Whether triangles store their own normal, for pixels where the interpolated one vanishes.
    pub(crate) opposite_normals: bool,
    /// Whether backs are drawn.
    pub(crate) backs: bool,
    /// Whether vertex colors are used.
    pub(crate) colored: bool,
    /// Fronts wind clockwise.
    pub(crate) clockwise: bool,
    pub(crate) maps: Option<DrawMaps>,
    /// The highlights of front and back.
    glosses: [Gloss; 2],
}

impl State {
    pub(crate) fn new(draw: &DrawCall, number: u32, surface: &SurfaceRecord) -> Self {
        let surrounded = draw.maps.is_some_and(|maps| maps.surrounded);
        let lit = |frequency: fn(Frequency) -> bool| {
            let terms = [draw.terms.diffuse, draw.terms.specular].map(frequency);
            // The environment uses the same normals as lights.
            let SurfaceLights { both, diffuse, specular } = &surface.lights;
            let reaches = |range: &LightRange| surrounded || !(both.is_empty() && range.is_empty());
            ShadedTerms { diffuse: terms[0] && reaches(diffuse), specular: terms[1] && reaches(specular) }
        };
        let flat = draw.terms.has(Frequency::Triangle);
        let vertex = lit(|term| matches!(term, Frequency::Triangle | Frequency::Vertex));
        let fragment = lit(|term| term == Frequency::Fragment);
        let stage = match (vertex.is_empty(), fragment.is_empty()) {
            // A flat triangle has the color of one point.
            (true, true) if flat && (draw.colored || draw.maps.is_some()) => Stage::Flat,
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
                && (matches!(stage, Stage::Fragment | Stage::Mixed) || surrounded && stage != Stage::Flat),
            backs: draw.cull != Cull::Back,
            colored: draw.colored,
            clockwise: draw.clockwise,
            maps: draw.maps,
            glosses: [&surface.front, &surface.back].map(|side| Gloss::new(draw.reflectance, side)),
        }
    }

    /// The same for pieces without vanishing interpolated normals.
    pub(crate) fn without_opposite_normals(self) -> Self {
        Self { opposite_normals: false, ..self }
    }

    /// The highlights of a side.
    pub(crate) fn gloss(&self, back: bool) -> Gloss {
        self.glosses[usize::from(back)]
    }

    /// Light of the vertex terms at points.
    #[inline(always)]
    pub(crate) fn vertex_terms<S: Simd>(&self, simd: S, pass: &Pass, points: &Points<S>, back: bool) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered(simd, (pass.lights, pass.lists), &surface.lights, points, self.gloss(back), self.vertex)
    }

    /// The light of the fragment terms at points with these highlights.
    #[inline(always)]
    pub(crate) fn fragment_terms<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        points: &Points<S>,
        lobe: impl PointLobe<S>,
    ) -> Irradiance<S> {
        let surface = &pass.surfaces[self.surface as usize];
        gathered_here(simd, (pass.lights, pass.lists), &surface.lights, points, lobe, self.fragment)
    }

    /// Whether vertex colors are interpolated separately, which they are unless the draw has images.
    #[inline(always)]
    pub(crate) fn paints(&self) -> bool {
        self.colored && self.maps.is_none()
    }

    /// Whether fragments use them: if no earlier stage has shaded a color.
    #[inline(always)]
    pub(crate) fn shades_paint(&self) -> bool {
        self.paints() && matches!(self.stage, Stage::Unlit | Stage::Fragment | Stage::Mixed)
    }

    /// Whether fragments need more than the material to reflect light.
    #[inline(always)]
    pub(crate) fn shades_apart(&self) -> bool {
        self.maps.is_some() || self.shades_paint()
    }

    /// Whether all its pixels have one color.
    pub(crate) fn is_even(&self) -> bool {
        self.stage == Stage::Unlit && !self.is_painted()
    }

    /// Whether vertex colors or images change the ambient and diffuse reflectance.
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

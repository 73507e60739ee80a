//! What one object is drawn with: its pipeline, its material record, and what light lists have to know of it.

use crate::batch::terms::{Chosen, TermMask};
use crate::geometry::detail::LevelsOfDetail;
use crate::lights::gather::{Lights, rgb};
use crate::lights::lists::Surface;
use crate::pipelines::key::{Cull, PipelineKey, Stage};
use crate::shaders::light_slots::{Highlights, Lists};
use crate::shaders::records::{DrawRecord, MaterialRecord, exponent};
use crate::target::frame::Frame;
use bevy_math::Vec3;
use halfway_lighting::{Faces, InvalidValue, Material, Reflectance, Viewer};

/// The components that say how an object reflects light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reflecting<'a> {
    pub(crate) front: &'a Material,
    pub(crate) back: &'a Material,
    pub(crate) reflectance: Reflectance,
    pub(crate) faces: Faces,
}

/// The same as a key: the materials' numbers, and the rest.
pub(crate) type ReflectingBits = ([u32; 14], [u32; 14], Reflectance, Faces);

/// What follows from them, whatever the object's place and shading.
#[derive(Clone, Debug)]
pub(crate) struct Look {
    pub(crate) invalid: Option<InvalidValue>,
    /// The number of its record without lists.
    pub(crate) material: u32,
    /// Whether its ambient, diffuse and specular reflectances are anything but black.
    reflects: [bool; 3],
    /// log₂ of the exponent where it is a power of two, the same on both sides.
    squarings: Option<u8>,
    /// The larger exponent of its sides.
    pub(crate) exponent: f32,
}

/// What every object's pipeline takes from the frame.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    pub(crate) lights: &'a Lights,
    pub(crate) allowed: &'a LevelsOfDetail,
    pub(crate) frame: &'a Frame,
    pub(crate) viewer: Viewer,
    /// Whether the adapter is a software one.
    pub(crate) software: bool,
}

/// What an object's pipeline takes from its place, its mesh and its shading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    pub(crate) chosen: Chosen,
    pub(crate) blend: bool,
    pub(crate) mirrored: bool,
    pub(crate) opposite_normals: bool,
}

impl Reflecting<'_> {
    pub(crate) fn bits(&self) -> ReflectingBits {
        (bits(self.front), bits(self.back), self.reflectance, self.faces)
    }

    /// Checks the components; `number` gives the record its number.
    pub(crate) fn look(&self, ambient: Vec3, number: impl FnOnce(DrawRecord) -> u32) -> Look {
        let invalid = self.front.validate().err().or_else(|| {
            // A back side without a material of its own has been checked with the front.
            self.back.validate().err().map(|invalid| InvalidValue { owner: "BackMaterial", ..invalid })
        });
        let sides = self.sides();
        let any = |of: fn(&Material) -> Vec3| sides.into_iter().any(|material| of(material) != Vec3::ZERO);
        Look {
            material: if invalid.is_none() { number(self.record(ambient)) } else { 0 },
            invalid,
            reflects: [any(|side| rgb(side.ambient)), any(|side| rgb(side.diffuse)), any(|side| rgb(side.specular))],
            squarings: self.squarings(),
            exponent: sides.map(|side| exponent(side, self.reflectance)).into_iter().fold(0.0, f32::max),
        }
    }

    /// The materials of the sides that are seen.
    fn sides(&self) -> [&Material; 2] {
        match self.faces {
            Faces::Front => [self.front; 2],
            Faces::Back => [self.back; 2],
            Faces::Both => [self.front, self.back],
        }
    }

    fn squarings(&self) -> Option<u8> {
        let [front, back] = self.sides().map(|side| exponent(side, self.reflectance));
        let is_power_of_two =
            (1.0..=65536.0).contains(&front) && (front as u32).is_power_of_two() && front.fract() == 0.0;
        (front.to_bits() == back.to_bits() && is_power_of_two).then(|| (front as u32).trailing_zeros() as u8)
    }

    /// Seen only from behind, the back is what the shader lights as front; see
    /// [`InstanceRecord::new`](crate::shaders::records::InstanceRecord::new).
    fn record(&self, ambient: Vec3) -> DrawRecord {
        let [front, back] = self.sides().map(|side| MaterialRecord::new(side, self.reflectance, ambient));
        DrawRecord::new(front, back)
    }

    /// What light lists have to know, where these terms are shaded.
    pub(crate) fn surface(&self, key: &PipelineKey) -> Surface<'_> {
        Surface { sides: self.sides(), reflectance: self.reflectance, vertex: key.vertex, fragment: key.fragment }
    }

    /// The pipeline. A term that the material or the lights leave black is not in it.
    pub(crate) fn key(&self, look: &Look, drawn: Drawn, shared: Shared) -> PipelineKey {
        let Shared { lights, frame, viewer, .. } = shared;
        let [reflects_ambient, reflects_diffuse, reflects_specular] = look.reflects;
        let lit = !lights.records.is_empty();
        let attenuated_ambient = lights.attenuated_ambient && reflects_ambient;
        let diffuse = lit && (reflects_diffuse || attenuated_ambient);
        let specular = lit && lights.specular && reflects_specular;
        let used = |mask: TermMask| TermMask { diffuse: mask.diffuse && diffuse, specular: mask.specular && specular };
        let (vertex, fragment) = (used(drawn.chosen.vertex), used(drawn.chosen.fragment));
        let stage = match (vertex.is_empty(), fragment.is_empty()) {
            (true, true) => Stage::Unlit,
            (false, true) if drawn.chosen.flat => Stage::Flat,
            (false, true) => Stage::Vertex,
            (true, false) => Stage::Fragment,
            (false, false) => Stage::Mixed,
        };
        let lit = stage != Stage::Unlit;
        let specular = vertex.specular || fragment.specular;
        // Switches that make no difference are set one way, so that they make no variants.
        PipelineKey {
            blend: drawn.blend,
            stage,
            lists: if lit { Lists::new(lights.counts) } else { Lists::counted([0; 3], Highlights::All) },
            vertex,
            fragment,
            per_instance: false,
            blinn_phong: self.reflectance != Reflectance::Phong || !specular,
            local_viewer: viewer == Viewer::Local && specular,
            attenuated_ambient: attenuated_ambient && (vertex.diffuse || fragment.diffuse),
            shared_colour: lights.shared_colour && specular,
            ranged: lights.ranged && lit,
            squarings: look.squarings.filter(|_| specular),
            geometric_fallback: drawn.opposite_normals && !fragment.is_empty(),
            cull: if self.faces == Faces::Both { Cull::None } else { Cull::Back },
            clockwise: drawn.mirrored != (self.faces == Faces::Back),
            samples: frame.samples.count(),
            format: frame.format,
            encoded: frame.encoded,
        }
    }
}

impl PipelineKey {
    /// The passes that draw an object: two for a blended two-sided one, the far side first.
    pub(crate) fn passes(self) -> impl Iterator<Item = Self> {
        let far_side = (self.blend && self.cull == Cull::None).then_some(Self { cull: Cull::Front, ..self });
        let near_side = if far_side.is_some() { Self { cull: Cull::Back, ..self } } else { self };
        far_side.into_iter().chain([near_side])
    }
}

/// A material's numbers, for use as a key.
fn bits(material: &Material) -> [u32; 14] {
    let Material { ambient, diffuse, specular, emission, shininess, opacity } = material;
    let mut bits = [0; 14];
    for (colour, out) in [ambient, diffuse, specular, emission].into_iter().zip(bits.chunks_exact_mut(3)) {
        out.copy_from_slice(&rgb(*colour).to_array().map(f32::to_bits));
    }
    (bits[12], bits[13]) = (shininess.to_bits(), opacity.to_bits());
    bits
}

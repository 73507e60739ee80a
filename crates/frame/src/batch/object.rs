//! One object as it is drawn: its key, its material record, and the inputs of its light lists.

use crate::batch::key::{DrawKey, MapLooks};
use crate::geometry::meshes::PaintOf;
use crate::lights::gather::Lights;
use crate::lights::lists::Reflector;
use crate::lights::slots::Lists;
use crate::view::camera::View;
use bevy_math::Vec3;
use halfway_lighting::equations::{Coefficients, Eye, specular_exponent};
use halfway_lighting::record::Cull;
use halfway_lighting::record::{MaterialRecord, SurfaceRecord};
use halfway_lighting::{
    Encoding, Faces, Fields, Frequency, InvalidValue, Material, Problem, Reflectance, Shading, Terms,
};
use halfway_texture::{MapKind, Maps, SolidKind, SolidTexture, WrongMap};

/// The components that say how an object reflects light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reflecting<'a> {
    pub(crate) front: &'a Material,
    pub(crate) back: &'a Material,
    pub(crate) shading: Shading,
    pub(crate) reflectance: Reflectance,
    pub(crate) faces: Faces,
    /// The mesh has colors that count.
    pub colored: bool,
    /// The lookups of the images.
    pub maps: MapLooks,
    /// A mask cuts away low opacity.
    pub masked: bool,
    /// The pattern of the solid that it is cut from.
    pub solid: Option<SolidKind>,
    /// An environment lights it.
    pub surrounded: bool,
}

/// The same as a key: the materials' bits, and the rest.
pub(crate) type ReflectingBits = ([MaterialBits; 2], Reflectance, Faces, [bool; 2]);
type MaterialBits = [u32; size_of::<Material>() / 4];

/// Everything that follows from the appearance, whatever the object's place and shading.
#[derive(Clone, Debug)]
pub(crate) struct Appearance {
    pub(crate) invalid: Option<InvalidValue>,
    /// The number of its record without lights.
    pub(crate) material: u32,
    /// Whether its ambient, diffuse and specular reflectances are anything but black.
    reflects: [bool; 3],
    /// log₂ of the exponent where it is a power of two, the same on both sides.
    squarings: Option<u8>,
}

/// Inputs from the frame for every object's key and lists.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    pub(crate) lights: &'a Lights,
    pub(crate) view: &'a View,
    /// The encoding of the picture's bytes; `None` for floating point.
    pub(crate) encoding: Option<Encoding>,
    pub(crate) eye: Eye<f32>,
    /// The length of a world unit in the eye space of the shaders.
    pub(crate) unit: f32,
    /// The share of a tolerance that is left for the values.
    pub(crate) share: f64,
}

/// Inputs for an object's key from its place, its mesh and its shading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circumstances {
    pub terms: Terms,
    pub blend: bool,
    pub(crate) mirrored: bool,
    pub(crate) opposite_normals: bool,
}

impl Reflecting<'_> {
    pub(crate) fn bits(&self) -> ReflectingBits {
        (
            [self.front, self.back].map(|material| bytemuck::cast(*material)),
            self.reflectance,
            self.faces,
            [self.is_painted(), self.is_lit()],
        )
    }

    /// Whether light has part in it; else it shows its base color.
    fn is_lit(&self) -> bool {
        self.shading != Shading::Unlit
    }

    /// Whether what multiplies ambient and diffuse light is not in the material alone.
    fn is_painted(&self) -> bool {
        self.surrounded || self.colored || self.masked || self.solid.is_some() || !self.maps.is_empty()
    }

    /// Checks the components; `number` gives the record its number.
    pub(crate) fn look(&self, ambient: Vec3, number: impl FnOnce(SurfaceRecord) -> u32) -> Appearance {
        let invalid = self.front.validate().err().or_else(|| {
            // A back side without a material of its own has been checked with the front.
            self.back.validate().err().map(|invalid| InvalidValue { owner: "BackMaterial", ..invalid })
        });
        let sides = self.coefficients();
        let any = |of: fn(&Coefficients<f32>) -> [f32; 3]| sides.iter().flat_map(of).any(|channel| channel != 0.0);
        Appearance {
            material: if invalid.is_none() { number(self.record(ambient)) } else { 0 },
            invalid,
            reflects: [any(|side| side.ka), any(|side| side.kd), any(|side| side.ks)],
            squarings: self.squarings(),
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

    fn coefficients(&self) -> [Coefficients<f32>; 2] {
        let of_side = |side| if self.is_lit() { Coefficients::from(side) } else { Coefficients::from(side).unlit() };
        self.sides().map(of_side)
    }

    fn exponents(&self) -> [f32; 2] {
        self.sides().map(|side| specular_exponent(self.reflectance, side.shininess))
    }

    fn squarings(&self) -> Option<u8> {
        let [front, back] = self.exponents();
        let is_power_of_two =
            (1.0..=65536.0).contains(&front) && (front as u32).is_power_of_two() && front.fract() == 0.0;
        (front.to_bits() == back.to_bits() && is_power_of_two).then(|| (front as u32).trailing_zeros() as u8)
    }

    /// Seen only from behind, the back is what the shader lights as front; see
    /// [`InstanceRecord::new`](halfway_lighting::record::InstanceRecord::new).
    fn record(&self, ambient: Vec3) -> SurfaceRecord {
        let ambient = if self.is_lit() { ambient } else { Vec3::ONE };
        let [front, back] =
            self.coefficients().map(|side| MaterialRecord::new(&side, self.reflectance, ambient, self.is_painted()));
        SurfaceRecord { front, back, ..SurfaceRecord::default() }
    }

    /// Inputs for light lists, where these terms are shaded.
    pub(crate) fn reflector(&self, terms: Terms) -> Reflector {
        let mut sides = self.coefficients();
        if self.maps.change_exponents() {
            // They lower it, and what has a lower one is brighter everywhere.
            for side in &mut sides {
                side.shininess = 0.0;
            }
        }
        if self.maps.has(MapKind::Emission) {
            // An image may leave nothing of it, behind which anything could be left out.
            for side in &mut sides {
                side.ke = [0.0; 3];
            }
        }
        Reflector { sides, reflectance: self.reflectance, terms }
    }

    /// The draw. A term that the material or the lights leave black is not in it.
    pub(crate) fn key(&self, look: &Appearance, circumstances: Circumstances, shared: Shared) -> DrawKey {
        let Shared { lights, eye, .. } = shared;
        let [reflects_ambient, reflects_diffuse, reflects_specular] = look.reflects;
        let lit = !lights.is_empty();
        let attenuated_ambient = lights.needs.attenuated_ambient && reflects_ambient;
        let used = |used: bool, term: Frequency| if lit && used { term } else { Frequency::Never };
        let terms = Terms {
            diffuse: used(reflects_diffuse || attenuated_ambient, circumstances.terms.diffuse),
            specular: used(lights.needs.highlights && reflects_specular, circumstances.terms.specular),
        };
        let key = DrawKey {
            blend: circumstances.blend,
            lists: Lists::new(lights.len(), lights.kinds),
            terms,
            per_instance: false,
            blinn_phong: self.reflectance != Reflectance::Phong,
            local_viewer: eye.is_local(),
            attenuated_ambient,
            shared_color: !lights.needs.own_specular,
            ranged: lights.needs.range,
            squarings: look.squarings,
            geometric_fallback: circumstances.opposite_normals,
            cull: if self.faces == Faces::Both { Cull::None } else { Cull::Back },
            clockwise: circumstances.mirrored != (self.faces == Faces::Back),
            colored: self.colored,
            maps: self.maps,
            masked: self.masked,
            inside_out: self.faces == Faces::Back,
            solid: self.solid,
            surrounded: self.surrounded,
        };
        DrawKey { terms: circumstances.terms, ..key }.with_terms(terms)
    }
}

/// The first number of an object's images, mask or solid that cannot be used.
pub(super) fn wrong_paint((_, maps, alpha, solid): PaintOf) -> Option<InvalidValue> {
    let of_maps = maps.and_then(Maps::wrong).map(|WrongMap { kind, field, value, expected }| {
        let field = format!("{}.{field}", kind.name());
        Fields::for_owner("Maps").error(&field, Problem::Number { value, expected })
    });
    let of_solid = || {
        let wrong = solid.and_then(SolidTexture::wrong)?;
        let problem = Problem::Number { value: wrong.value, expected: wrong.expected };
        Some(Fields::for_owner("SolidTexture").error(wrong.field, problem))
    };
    of_maps.or_else(|| alpha.and_then(|alpha| alpha.validate().err())).or_else(of_solid)
}

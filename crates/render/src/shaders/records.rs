//! What the GPU reads: the same bytes as the structs of the WGSL texts, which a test compares.

use crate::view::camera::{Projection, View};
use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_math::{Vec3, Vec3A};
use bytemuck::{Pod, Zeroable};
use halfway_lighting::equations::{Coefficients, ConeTerms, Light, Place, specular_exponent};
use halfway_lighting::{Faces, Reflectance};
use halfway_texture::SolidTexture;

/// One instance in its vertex buffer: `eye_from_model` as rows, the normal matrix as columns, and the number of its
/// record, which only draws of several records read.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct InstanceRecord {
    pub(crate) rows: [[f32; 4]; 3],
    pub(crate) normal: [[f32; 3]; 3],
    pub(crate) record: u32,
}

pub(crate) const INSTANCE_BYTES: u64 = size_of::<InstanceRecord>() as u64;

/// Its parts, by their locations in the texts.
pub(crate) const INSTANCE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 9 => Uint32];

/// The projection as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct ViewRecord {
    pub(crate) scale: [f32; 2],
    pub(crate) near: f32,
    pub(crate) padding: f32,
}

impl From<&View> for ViewRecord {
    fn from(view: &View) -> Self {
        let Projection { scale, near } = view.projection;
        Self { scale, near: near * view.unit() as f32, padding: 0.0 }
    }
}

/// A light as the shader reads it; `Light` in lighting.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct LightRecord {
    pub(crate) position: [f32; 3],
    pub(crate) inverse_range: f32,
    pub(crate) diffuse: [f32; 3],
    pub(crate) constant: f32,
    pub(crate) specular: [f32; 3],
    pub(crate) linear: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) quadratic: f32,
    pub(crate) ambient: [f32; 3],
    pub(crate) cos_cutoff: f32,
    pub(crate) exponent: f32,
    pub(crate) inner_scale: f32,
    pub(crate) inner_offset: f32,
    pub(crate) padding: f32,
}

/// A material as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct MaterialRecord {
    pub(crate) base: [f32; 3],
    pub(crate) shininess: f32,
    pub(crate) diffuse: [f32; 3],
    pub(crate) opacity: f32,
    pub(crate) specular: [f32; 3],
    padding0: f32,
    pub(crate) ambient: [f32; 3],
    padding1: f32,
}

/// Material and light lists; `Draw` in records.wgsl. Its size is the largest alignment of offsets that WebGPU
/// lets an adapter ask for.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct DrawRecord {
    pub(crate) front: MaterialRecord,
    pub(crate) back: MaterialRecord,
    pub(crate) lists: RecordLists,
    /// ke, where it is not part of the base.
    pub(crate) front_emission: [f32; 3],
    pub(crate) padding0: f32,
    pub(crate) back_emission: [f32; 3],
    pub(crate) padding1: f32,
}

/// What an object is cut from; `SolidData` in surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SolidRecord {
    pub(crate) rows: [[f32; 4]; 3],
    /// The first color, and how many octaves.
    pub(crate) first: [f32; 3],
    pub(crate) octaves: u32,
    /// The second color.
    pub(crate) second: [f32; 4],
}

impl From<&SolidTexture> for SolidRecord {
    fn from(solid: &SolidTexture) -> Self {
        let [first, [r, g, b]] = solid.colors;
        Self { rows: solid.solid_from_object, first, octaves: solid.octaves, second: [r, g, b, 0.0] }
    }
}

pub(crate) const RECORD_BYTES: u64 = size_of::<DrawRecord>() as u64;

/// Light lists of a record, each as how many directional, point and spot lights, and where their numbers begin. All 0
/// where the lights are compiled in.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct RecordLists {
    pub(crate) vertex: [u32; 4],
    /// Lights without their specular terms.
    pub(crate) vertex_diffuse: [u32; 4],
    /// Lights with nothing but their specular terms.
    pub(crate) vertex_specular: [u32; 4],
    pub(crate) fragment: [u32; 4],
    pub(crate) fragment_diffuse: [u32; 4],
    pub(crate) fragment_specular: [u32; 4],
}

impl InstanceRecord {
    /// With only back faces shown, the surface is lit inside out: its normals turn, and so do its windings.
    /// `unit` is the [view's](crate::View), which scales positions.
    pub(crate) fn new(model_view: &ModelView, normal_matrix: &NormalMatrix, faces: Faces, unit: f32) -> Self {
        let m = model_view.eye_from_model.matrix3.transpose();
        let t = model_view.eye_from_model.translation;
        let row = |row: Vec3A, translation: f32| [row.x, row.y, row.z, translation].map(|x| x * unit);
        let side = if faces == Faces::Back { -1.0 } else { 1.0 };
        Self {
            rows: [row(m.x_axis, t.x), row(m.y_axis, t.y), row(m.z_axis, t.z)],
            normal: (normal_matrix.0 * side).to_cols_array_2d(),
            record: 0,
        }
    }
}

impl DrawRecord {
    /// One of nothing but the sides' emission.
    pub(crate) fn with_emission([front_emission, back_emission]: [[f32; 3]; 2]) -> Self {
        Self { front_emission, back_emission, ..Self::default() }
    }
}

impl MaterialRecord {
    /// The record of a material under ambient light: Ga, and La of the lights that do not attenuate it.
    pub(crate) fn new(material: &Coefficients<f32>, opacity: f32, reflectance: Reflectance, ambient: Vec3) -> Self {
        let unlit = Vec3::from_array(material.ke) + Vec3::from_array(material.ka) * ambient;
        Self {
            base: unlit.to_array(),
            shininess: specular_exponent(reflectance, material.shininess),
            diffuse: material.kd,
            opacity,
            specular: material.ks,
            ambient: material.ka,
            ..Self::default()
        }
    }
}

impl From<&Light<f64>> for LightRecord {
    /// Whatever leaves the range of f32 becomes the largest number in it.
    fn from(light: &Light<f64>) -> Self {
        let vector = |v: [f64; 3]| v.map(|x| x as f32);
        let (Place::Point(position) | Place::Directional(position)) = light.place;
        let mut record = Self { diffuse: vector(light.ld), specular: vector(light.ls), ..Self::default() };
        record.place(position, light.attenuation, light.range);
        if light.attenuate_ambient {
            record.ambient = vector(light.la);
        }
        if let Some(cone) = &light.cone {
            record.direction = vector(cone.direction);
            record.cos_cutoff = number(cone.cos_cutoff);
            record.exponent = number(cone.exponent);
            (record.inner_scale, record.inner_offset) = inner_fade(cone);
        }
        record
    }
}

/// The nearest number of f32, or the largest.
fn number(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}

impl LightRecord {
    /// Puts it somewhere, or toward somewhere, with its falloff in the same unit of length.
    pub(crate) fn place(&mut self, position: [f64; 3], attenuation: [f64; 3], range: Option<f64>) {
        self.position = position.map(|x| x as f32);
        [self.constant, self.linear, self.quadratic] = attenuation.map(number);
        self.inverse_range = range.map_or(0.0, |range| number(range.recip()));
    }
}

impl LightRecord {
    /// Whether it has a specular color.
    pub(crate) fn is_specular(&self) -> bool {
        self.specular.iter().any(|&channel| channel > 0.0)
    }

    /// Whether it attenuates an ambient color.
    pub(crate) fn attenuates_ambient(&self) -> bool {
        self.ambient.iter().any(|&channel| channel > 0.0)
    }

    /// Whether its specular color is a copy of its diffuse color.
    #[expect(clippy::float_cmp, reason = "a shared color is a copy")]
    pub(crate) fn shares_color(&self) -> bool {
        self.specular == self.diffuse
    }

    /// Whether it has a range.
    pub(crate) fn is_ranged(&self) -> bool {
        self.inverse_range > 0.0
    }
}

/// The inner cone's fade of `KHR_lights_punctual`, s = clamp((cos φ − cos cutoff)/(cos inner − cos cutoff), 0, 1), as
/// scale and offset of cos φ; 0 and 1, which is s = 1, where there is no inner cone or it is as wide as the cutoff.
fn inner_fade(cone: &ConeTerms<f64>) -> (f32, f32) {
    let width = cone.cos_inner.map_or(0.0, |cos_inner| cos_inner - cone.cos_cutoff);
    if width > 0.0 { ((1.0 / width) as f32, (-cone.cos_cutoff / width) as f32) } else { (0.0, 1.0) }
}

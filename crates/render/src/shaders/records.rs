//! What the GPU reads: the same bytes as the structs of the WGSL texts, which a test compares.

use crate::lights::gather::rgb;
use crate::view::matrices::{ModelView, NormalMatrix};
use bevy_math::{Vec3, Vec3A};
use bytemuck::{Pod, Zeroable};
use halfway_lighting::{Faces, Material, Reflectance, matched_shininess};

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

/// The projection as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct ViewRecord {
    pub(crate) scale: [f32; 2],
    pub(crate) near: f32,
    pub(crate) padding: f32,
}

/// A light as the shader reads it; `Light` in lighting.wgsl. 128 bytes, so that every second one begins at an offset that
/// any adapter can bind.
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
    pub(crate) padding: [f32; 9],
}

impl LightRecord {
    /// One that adds nothing.
    pub(crate) const BLACK: Self = Self {
        position: [0.0, 0.0, 1.0],
        inverse_range: 0.0,
        diffuse: [0.0; 3],
        constant: 1.0,
        specular: [0.0; 3],
        linear: 0.0,
        direction: [0.0; 3],
        quadratic: 0.0,
        ambient: [0.0; 3],
        cos_cutoff: 1.0,
        exponent: 0.0,
        inner_scale: 0.0,
        inner_offset: 1.0,
        padding: [0.0; 9],
    };
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
    pub(crate) padding: [u32; 16],
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
    pub(crate) fragment: [u32; 4],
    pub(crate) fragment_diffuse: [u32; 4],
}

impl DrawRecord {
    pub(crate) fn new(front: MaterialRecord, back: MaterialRecord) -> Self {
        Self { front, back, ..Self::default() }
    }
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

impl MaterialRecord {
    pub(crate) fn new(material: &Material, reflectance: Reflectance, ambient: Vec3) -> Self {
        let ka = rgb(material.ambient);
        Self {
            base: (rgb(material.emission) + ka * ambient).to_array(),
            shininess: exponent(material, reflectance),
            diffuse: rgb(material.diffuse).to_array(),
            opacity: material.opacity,
            specular: rgb(material.specular).to_array(),
            ambient: ka.to_array(),
            ..Self::default()
        }
    }
}

/// α of Phong, β of Blinn–Phong, or the β that matches α.
pub(crate) fn exponent(material: &Material, reflectance: Reflectance) -> f32 {
    match reflectance {
        Reflectance::BlinnPhongMatched => matched_shininess(material.shininess),
        _ => material.shininess,
    }
}

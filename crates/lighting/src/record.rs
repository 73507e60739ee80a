//! Records: lights, materials and instances as plain data in eye space, which whatever draws reads as it is. On the GPU
//! they are the structs of the same names in the WGSL texts, byte for byte.
//!
//! All numbers are finite: whatever leaves the range of f32 becomes the largest number in it.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Mat3, Vec3, Vec3A};

use crate::equations::{Coefficients, specular_exponent};
use crate::lights::Light;
use crate::range::Range;
use crate::{Faces, Reflectance};

/// A light. Each kind says by its [`LightKind::record`](crate::lights::LightKind::record) what it fills; the rest is 0
/// or plays no part.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightRecord {
    /// Its position, or the unit vector toward it.
    pub position: [f32; 3],
    /// 1/R, or 0 for no end.
    pub inverse_range: f32,
    /// Ld.
    pub diffuse: [f32; 3],
    /// a of 1/(a + b·d + c·d²).
    pub constant: f32,
    /// Ls.
    pub specular: [f32; 3],
    /// b.
    pub linear: f32,
    /// The way a spot shines, unit length.
    pub direction: [f32; 3],
    /// c.
    pub quadratic: f32,
    /// La, where it is attenuated; else black, and the color is part of [`MaterialRecord::base`].
    pub ambient: [f32; 3],
    /// cos(cutoff).
    pub cos_cutoff: f32,
    /// e of cosᵉ φ.
    pub exponent: f32,
    /// Scale of the inner cone's fade s = clamp(cos φ·scale + offset, 0, 1); 0 without an inner cone.
    pub inner_scale: f32,
    /// Its offset; 1 without an inner cone.
    pub inner_offset: f32,
    /// The number of its [`Kind`](crate::lights::Kind).
    pub kind: u32,
}

impl Default for LightRecord {
    /// A black directional one.
    fn default() -> Self {
        Self {
            position: [0.0, 0.0, 1.0],
            inverse_range: 0.0,
            diffuse: [0.0; 3],
            constant: 1.0,
            specular: [0.0; 3],
            linear: 0.0,
            direction: [0.0, 0.0, -1.0],
            quadratic: 0.0,
            ambient: [0.0; 3],
            cos_cutoff: 0.0,
            exponent: 0.0,
            inner_scale: 0.0,
            inner_offset: 1.0,
            kind: 0,
        }
    }
}

impl From<&Light<f64>> for LightRecord {
    fn from(light: &Light<f64>) -> Self {
        light.record()
    }
}

/// One side of a surface: its colors, exponent and opacity.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MaterialRecord {
    /// ke + ka·(Ga + Σ La) of the lights that do not attenuate their ambient.
    pub base: [f32; 3],
    /// The exponent of the highlight; a matched one is matched already.
    pub shininess: f32,
    /// kd.
    pub diffuse: [f32; 3],
    /// 0 to 1; counts where the draw blends.
    pub opacity: f32,
    /// ks.
    pub specular: [f32; 3],
    #[doc(hidden)]
    pub padding0: f32,
    /// ka, for the lights that attenuate their ambient.
    pub ambient: [f32; 3],
    #[doc(hidden)]
    pub padding1: f32,
    /// ke of painted surfaces, apart from what colors multiply; of others it is part of the base, and this 0.
    pub emission: [f32; 3],
    #[doc(hidden)]
    pub padding2: f32,
}

impl MaterialRecord {
    /// A material under ambient light: Ga, and La of the lights that do not attenuate it. Surfaces are `painted` where
    /// colors of vertices, images, a mask, a solid or an environment have part in what they reflect.
    pub fn new(material: &Coefficients<f32>, reflectance: Reflectance, ambient: Vec3, painted: bool) -> Self {
        let in_base = if painted { [0.0; 3] } else { material.ke };
        let unlit = Vec3::from_array(in_base) + Vec3::from_array(material.ka) * ambient;
        Self {
            base: unlit.to_array().map(finite),
            shininess: finite(specular_exponent(reflectance, material.shininess)),
            diffuse: material.kd,
            opacity: material.opacity,
            specular: material.ks,
            ambient: material.ka,
            emission: if painted { material.ke } else { [0.0; 3] },
            ..Self::default()
        }
    }

    /// Its fields but for padding, in the order of the struct.
    pub const FIELDS: [RecordField; 7] = [
        RecordField { name: "base", first: offset_of!(Self, base), count: 3, range: Range::NON_NEGATIVE },
        RecordField { name: "shininess", first: offset_of!(Self, shininess), count: 1, range: Range::NON_NEGATIVE },
        RecordField { name: "diffuse", first: offset_of!(Self, diffuse), count: 3, range: Range::NON_NEGATIVE },
        RecordField { name: "opacity", first: offset_of!(Self, opacity), count: 1, range: Range::UNIT },
        RecordField { name: "specular", first: offset_of!(Self, specular), count: 3, range: Range::NON_NEGATIVE },
        RecordField { name: "ambient", first: offset_of!(Self, ambient), count: 3, range: Range::NON_NEGATIVE },
        RecordField { name: "emission", first: offset_of!(Self, emission), count: 3, range: Range::NON_NEGATIVE },
    ];

    /// The first field with a number out of its range, and that number.
    pub fn wrong(&self) -> Option<(&'static RecordField, f32)> {
        let numbers: &[f32] = bytemuck::cast_slice(std::slice::from_ref(self));
        Self::FIELDS.iter().find_map(|field| {
            let own = &numbers[field.first / size_of::<f32>()..][..field.count];
            own.iter().find(|number| !field.range.contains(**number)).map(|number| (field, *number))
        })
    }
}

/// A field of a record: one number, or the channels of a color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordField {
    /// Its name, here and in the WGSL struct.
    pub name: &'static str,
    /// Where it begins, in bytes.
    pub first: usize,
    /// How many numbers it has.
    pub count: usize,
    /// The range of each.
    pub range: Range,
}

/// The side of triangles that is culled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cull {
    /// The back: triangles that wind clockwise in the picture.
    #[default]
    Back,
    /// The front.
    Front,
    /// None: both sides are lit.
    None,
}

/// Some lights of a frame's list of numbers.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct LightRange {
    /// The first number's place in the list.
    pub start: u32,
    /// How many lights.
    pub count: u32,
}

impl LightRange {
    /// Whether it names none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// The lights that reach a surface, by which of their terms count.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct SurfaceLights {
    /// With all terms.
    pub both: LightRange,
    /// More of them, whose highlights are left out.
    pub diffuse: LightRange,
    /// More of them, of which nothing but the highlights counts.
    pub specular: LightRange,
}

/// Both sides of a surface, and the lights that reach it. Its size is the largest alignment of offsets that WebGPU lets
/// an adapter ask for.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SurfaceRecord {
    /// The side whose corners are seen counter-clockwise, unless the draw says otherwise.
    pub front: MaterialRecord,
    /// The other side.
    pub back: MaterialRecord,
    /// The lights.
    pub lights: SurfaceLights,
    #[doc(hidden)]
    pub padding: [u32; 18],
}

/// The transform of a mesh and its material.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct InstanceRecord {
    /// The rows of `eye_from_model`.
    pub eye_from_model: [[f32; 4]; 3],
    /// The columns of the normal matrix, sign(det M)·cof(M) up to a positive factor; negative where the surface is lit
    /// inside out.
    pub normal: [[f32; 3]; 3],
    /// The number of its surface.
    pub surface: u32,
}

impl InstanceRecord {
    /// One whose positions are scaled by `unit`. With only back faces shown, the surface is lit inside out: its normals
    /// turn, and so do its windings. A matrix that leaves f32 shows nothing.
    #[inline]
    pub fn new(eye_from_model: &Affine3A, normal_matrix: Mat3, faces: Faces, unit: f32) -> Self {
        let m = eye_from_model.matrix3.transpose();
        let t = eye_from_model.translation;
        let row = |row: Vec3A, translation: f32| [row.x, row.y, row.z, translation].map(|x| x * unit);
        let side = if faces == Faces::Back { -1.0 } else { 1.0 };
        let record = Self {
            eye_from_model: [row(m.x_axis, t.x), row(m.y_axis, t.y), row(m.z_axis, t.z)],
            normal: (normal_matrix * side).to_cols_array_2d(),
            surface: 0,
        };
        // All are looked at, many at once: seldom is any not finite.
        let finite = |numbers: &[f32]| numbers.iter().fold(true, |all, number| all & number.is_finite());
        let all = finite(record.eye_from_model.as_flattened()) & finite(record.normal.as_flattened());
        if all { record } else { Self::default() }
    }
}

/// The nearest number of f32, or the largest.
pub(crate) fn number(value: f64) -> f32 {
    finite(value as f32)
}

fn finite(value: f32) -> f32 {
    value.clamp(f32::MIN, f32::MAX)
}

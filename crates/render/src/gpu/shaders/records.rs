//! Records of the GPU beside [lights, materials and instances](halfway_lighting::record): the same bytes as the structs of
//! the WGSL texts, which a test compares.

use bytemuck::{Pod, Zeroable};
use halfway_frame::view::camera::View;
use halfway_lighting::record::{InstanceRecord, SurfaceRecord};
use halfway_lighting::{Lens, LensTerms};
use halfway_texture::SolidTexture;

pub(crate) const INSTANCE_BYTES: u64 = size_of::<InstanceRecord>() as u64;

/// The vertex attributes of an instance, by their locations in the texts.
pub(crate) const INSTANCE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 9 => Uint32];

/// The projection in the layout of the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct ViewRecord {
    pub(crate) scale: [f32; 2],
    /// z of clip space by the depth, and w.
    pub(crate) depth: [f32; 2],
    pub(crate) w: [f32; 2],
    /// Where the axis of the view meets the picture.
    pub(crate) center: [f32; 2],
}

impl From<&View> for ViewRecord {
    fn from(view: &View) -> Self {
        let lens: Lens = view.lens_of_shaders();
        let LensTerms { depth, w } = lens.terms();
        Self { scale: lens.scale, depth, w, center: lens.center }
    }
}

pub(crate) const VIEW_BYTES: u64 = size_of::<ViewRecord>() as u64;

/// The solid that an object is cut from; `SolidData` in surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SolidRecord {
    pub(crate) rows: [[f32; 4]; 3],
    /// The first color, and the number of octaves.
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

pub(crate) const RECORD_BYTES: u64 = size_of::<SurfaceRecord>() as u64;

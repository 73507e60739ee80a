//! Placings: where images lie in the textures that hold them, and where a mesh's coordinates lie on images, as maps.wgsl
//! reads it. The test of the twins of maps.wgsl is a user of this file too, so it needs no other.

use bytemuck::{Pod, Zeroable};
use halfway_texture::{Level, MapKind, Pyramid};

/// Where a mesh's coordinates lie on images; `Placings` in maps.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct PlacingsRecord {
    pub(crate) cutoff: [f32; 4],
    pub(crate) each: [PlacingRecord; MapKind::COUNT],
}

/// Where they lie on one, how much it counts, and where its levels are; `Placing` in maps.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct PlacingRecord {
    pub(crate) row0: [f32; 4],
    pub(crate) row1: [f32; 4],
    pub(crate) levels: [u32; 4],
    pub(crate) level: [[u32; 4]; 14],
}

impl PlacingRecord {
    /// Of an image whose levels lie in rows of `width` texels.
    pub(crate) fn new([[a, b, c], [d, e, f]]: [[f32; 3]; 2], amount: f32, pyramid: &Pyramid, width: u32) -> Self {
        let (row0, row1) = ([a, b, c, amount], [d, e, f, 0.0]);
        let mut level = [[0; 4]; 14];
        for (record, Level { width, height, start }) in level.iter_mut().zip(pyramid.levels()) {
            *record = [*start as u32, *width, *height, 0];
        }
        Self { row0, row1, levels: [pyramid.levels().len() as u32, width, 0, 0], level }
    }
}

/// Columns and rows of the texture that holds all levels, one after the other, in rows of at most `longest` texels.
pub(crate) fn packed_size(texels: &[[f32; 4]], longest: u32) -> [u32; 2] {
    let count = texels.len() as u32;
    let width = count.min(longest);
    [width, count.div_ceil(width)]
}

/// The texture of this size with the texels of all levels, in 32-bit floats.
pub(crate) fn packed(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texels: &[[f32; 4]],
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("a map"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let write = |y: u32, texels: &[[f32; 4]], rows: u32| {
        let to = wgpu::TexelCopyTextureInfo {
            texture: &texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x: 0, y, z: 0 },
            aspect: wgpu::TextureAspect::All,
        };
        let size = wgpu::Extent3d { width: width.min(texels.len() as u32), height: rows, depth_or_array_layers: 1 };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: None };
        queue.write_texture(to, bytemuck::cast_slice(texels), layout, size);
    };
    // The last row may be a part.
    let whole = texels.len() as u32 / width;
    let (rows, rest) = texels.split_at((whole * width) as usize);
    write(0, rows, whole);
    if !rest.is_empty() {
        write(whole, rest, 1);
    }
    texture
}

//! Upload: the images that draws read, on the GPU.

use crate::batch::table::MapUse;
use crate::device::gpu::Gpu;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::pipelines::cache::Pipelines;
use bevy_asset::{AssetId, Assets};
use bevy_platform::collections::HashMap;
use bytemuck::{Pod, Zeroable};
use halfway_texture::{Level, Pyramid, Texture};

/// The images that have been drawn, until they change or go, and the bindings of the frame's uses of them.
#[derive(Default)]
pub(crate) struct Maps {
    textures: HashMap<AssetId<Texture>, MapTexture>,
    groups: Vec<(MapUse, Pyramid, wgpu::BindGroup)>,
}

struct MapTexture {
    pyramid: Pyramid,
    view: wgpu::TextureView,
}

impl Maps {
    /// Sends the images that the frame shows and that are not there. What is too large is not drawn, and its error is in the
    /// report, every frame anew.
    pub(crate) fn send(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        used: &[MapUse],
        textures: &Assets<Texture>,
        report: &mut FrameReport,
    ) {
        self.textures.retain(|&id, _| textures.contains(id) || used.iter().any(|of| of.texture == id));
        for (number, of) in used.iter().enumerate() {
            let pyramid = of.pyramid(textures);
            let is_there = |(known, made, _): &(MapUse, Pyramid, _)| known == of && made.is_same(&pyramid);
            if self.groups.get(number).is_some_and(is_there) {
                continue;
            }
            self.groups.truncate(number);
            match self.bind(gpu, pipelines, of, &pyramid) {
                Ok(Some((group, bytes))) => {
                    report.bytes_uploaded += bytes;
                    self.groups.push((*of, pyramid, group));
                }
                Ok(None) => return,
                Err(error) => {
                    report.errors.push(error);
                    return;
                }
            }
        }
    }

    /// The bindings of a use, by its number from 1 on.
    pub(crate) fn group(&self, number: u32) -> Option<&wgpu::BindGroup> {
        self.groups.get((number as usize).checked_sub(1)?).map(|(.., group)| group)
    }

    /// `None` while no pipeline reads images.
    fn bind(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        of: &MapUse,
        pyramid: &Pyramid,
    ) -> Result<Option<(wgpu::BindGroup, u64)>, RenderError> {
        let Some(layout) = pipelines.map_bindings() else { return Ok(None) };
        let mut bytes = PLACING_BYTES;
        let is_there = self.textures.get(&of.texture).is_some_and(|there| there.pyramid.is_same(pyramid));
        if !is_there {
            bytes += 16 * pyramid.texels().len() as u64;
            let view = sent(gpu, pyramid)?;
            self.textures.insert(of.texture, MapTexture { pyramid: pyramid.clone(), view });
        }
        let Some(MapTexture { view, .. }) = self.textures.get(&of.texture) else { return Ok(None) };
        let descriptor = wgpu::BufferDescriptor {
            label: Some("where a map lies"),
            size: PLACING_BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let rows = gpu.device.create_buffer(&descriptor);
        gpu.queue.write_buffer(
            &rows,
            0,
            bytemuck::bytes_of(&PlacingRecord::new(of, pyramid, packed_size(gpu, pyramid)[0])),
        );
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("a map"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) },
                wgpu::BindGroupEntry { binding: 1, resource: rows.as_entire_binding() },
            ],
        });
        Ok(Some((group, bytes)))
    }
}

/// Where a mesh's coordinates lie on an image, and where its levels are; `Placing` in mapped.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct PlacingRecord {
    pub(crate) row0: [f32; 4],
    pub(crate) row1: [f32; 4],
    pub(crate) levels: [u32; 4],
    pub(crate) level: [[u32; 4]; 14],
}

/// How many bytes it has.
pub(crate) const PLACING_BYTES: u64 = size_of::<PlacingRecord>() as u64;

impl PlacingRecord {
    fn new(of: &MapUse, pyramid: &Pyramid, width: u32) -> Self {
        let [row0, row1] = of.rows().map(|[a, b, c]| [a, b, c, 0.0]);
        let mut level = [[0; 4]; 14];
        for (record, Level { width, height, start }) in level.iter_mut().zip(pyramid.levels()) {
            *record = [*start as u32, *width, *height, 0];
        }
        Self { row0, row1, levels: [pyramid.levels().len() as u32, width, 0, 0], level }
    }
}

/// Columns and rows of the texture that holds all levels, one after the other.
fn packed_size(gpu: &Gpu, pyramid: &Pyramid) -> [u32; 2] {
    let count = pyramid.texels().len() as u32;
    let width = count.min(gpu.device.limits().max_texture_dimension_2d);
    [width, count.div_ceil(width)]
}

/// All levels of a pyramid in a texture of 32-bit floats.
fn sent(gpu: &Gpu, pyramid: &Pyramid) -> Result<wgpu::TextureView, RenderError> {
    let [width, height] = packed_size(gpu, pyramid);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if height > limit {
        let what = "the texels of an image with its pyramid, in rows of the longest side of a texture,".into();
        return Err(RenderError::TooLarge { what, needed: height.into(), limit: limit.into() });
    }
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
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
        gpu.queue.write_texture(to, bytemuck::cast_slice(texels), layout, size);
    };
    // The last row may be a part.
    let whole = pyramid.texels().len() as u32 / width;
    let (rows, rest) = pyramid.texels().split_at((whole * width) as usize);
    write(0, rows, whole);
    if !rest.is_empty() {
        write(whole, rest, 1);
    }
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

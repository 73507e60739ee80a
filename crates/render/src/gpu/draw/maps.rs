//! The set Upload: uploads the images that draws read.

use crate::gpu::device::Gpu;
use crate::gpu::draw::placings::{PlacingRecord, PlacingsRecord, packed, packed_size, stored};
use crate::gpu::pipelines::cache::Pipelines;
use crate::gpu::shaders::records::SolidRecord;
use crate::gpu::shaders::text::SOLID_BINDING;
use bevy_platform::collections::HashMap;
use halfway_asset::{AssetId, Assets};
use halfway_frame::batch::table::{MapUse, MapsUse};
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use halfway_texture::{ImageForm, MapKind, Pyramid, Texture};

/// The drawn images, until they change or are removed, and the bindings of the frame's uses of them.
#[derive(Default)]
pub(crate) struct MapTextures {
    textures: HashMap<(AssetId<Texture>, ImageForm, Part), MapTexture>,
    /// By their numbers.
    groups: Vec<BoundMaps>,
    /// The texture that is bound in place of a missing image.
    none: Option<wgpu::TextureView>,
}

/// The part of an image that is uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Part {
    Texels,
    /// The slopes of normals.
    Slopes,
    /// The products of slopes.
    Products,
}

impl Part {
    fn select(self, pyramid: &Pyramid) -> &Pyramid {
        match self {
            Self::Texels => pyramid,
            Self::Slopes => &pyramid.moments()[0],
            Self::Products => &pyramid.moments()[1],
        }
    }
}

/// The images that a set binds, each with its use. A normal map with moments binds its slopes in its own slot, and
/// their products in the slot of heights, which is free beside normals.
fn bound<'a>(of: &'a MapsUse, pyramids: &'a Pyramids) -> impl Iterator<Item = Option<(&'a MapUse, &'a Pyramid, Part)>> {
    let [normal, height] = [MapKind::Normal as usize, MapKind::Height as usize];
    let moments = of.slots[normal].is_some_and(|of| of.moments);
    (0..MapKind::COUNT).map(move |slot| {
        let (from, part) = match slot {
            _ if !moments => (slot, Part::Texels),
            _ if slot == normal => (normal, Part::Slopes),
            _ if slot == height => (normal, Part::Products),
            _ => (slot, Part::Texels),
        };
        Some((of.slots[from].as_ref()?, pyramids[from].as_ref()?, part))
    })
}

/// The images of a set, as they were when it was bound.
type Pyramids = [Option<Pyramid>; MapKind::COUNT];

/// A set of images, as it was bound.
struct BoundMaps {
    of: MapsUse,
    pyramids: Pyramids,
    /// `None` if binding failed, or if no pipeline reads such a set yet; others are bound all the same.
    group: Option<wgpu::BindGroup>,
}

impl BoundMaps {
    fn is_of(&self, of: &MapsUse, pyramids: &Pyramids) -> bool {
        let mut both = self.pyramids.iter().flatten().zip(pyramids.iter().flatten());
        self.group.is_some() && self.of == *of && both.all(|(a, b)| a.is_same(b))
    }
}

struct MapTexture {
    pyramid: Pyramid,
    view: wgpu::TextureView,
}

impl MapTextures {
    /// Uploads the visible images that are missing on the GPU. An image that is too large is not drawn, and its error
    /// is in the report of every frame.
    pub(crate) fn send(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        used: &[MapsUse],
        textures: &Assets<Texture>,
        report: &mut FrameReport,
    ) {
        self.textures.retain(|&(id, ..), _| {
            textures.contains(id) || used.iter().any(|of| of.slots.iter().flatten().any(|of| of.texture == id))
        });
        for (number, of) in used.iter().enumerate() {
            let pyramids = of.slots.map(|slot| slot.map(|of| of.pyramid(textures)));
            if self.groups.get(number).is_some_and(|bound| bound.is_of(of, &pyramids)) {
                continue;
            }
            let group = match self.bind(gpu, pipelines, of, &pyramids) {
                Ok(bound) => bound.map(|(group, bytes)| {
                    report.bytes_uploaded += bytes;
                    group
                }),
                Err(error) => {
                    report.errors.push(error);
                    None
                }
            };
            let bound = BoundMaps { of: *of, pyramids, group };
            match self.groups.get_mut(number) {
                Some(before) => *before = bound,
                None => self.groups.push(bound),
            }
        }
    }

    /// The bindings of a set, by its number from 1 on.
    pub(crate) fn group(&self, number: u32) -> Option<&wgpu::BindGroup> {
        self.groups.get((number as usize).checked_sub(1)?)?.group.as_ref()
    }

    /// `None` while no pipeline reads images.
    fn bind(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        of: &MapsUse,
        pyramids: &Pyramids,
    ) -> Result<Option<(wgpu::BindGroup, u64)>, RenderError> {
        let Some(layout) = pipelines.map_bindings(of.solid.is_some()) else { return Ok(None) };
        let mut bytes = PLACINGS_BYTES;
        let mut record = PlacingsRecord { cutoff: [of.cutoff, 0.0, 0.0, 0.0], ..PlacingsRecord::default() };
        let mut views = Vec::with_capacity(MapKind::COUNT);
        for (slot, bound) in bound(of, pyramids).enumerate() {
            let Some((of, pyramid, part)) = bound else {
                views.push(self.none(gpu)?);
                continue;
            };
            let (view, sent) = self.view(gpu, of, pyramid, part)?;
            let width = view.texture().width();
            record.each[slot] = PlacingRecord::new(of.rows(), of.amount, (part.select(pyramid), of.form), width);
            bytes += sent;
            views.push(view);
        }
        let placings = uniform(gpu, "where maps lie", bytemuck::bytes_of(&record));
        let solid = of.solid.map(|solid| uniform(gpu, "a solid", bytemuck::bytes_of(&SolidRecord::from(&solid))));
        bytes += solid.as_ref().map_or(0, wgpu::Buffer::size);
        let image = |(slot, view)| wgpu::BindGroupEntry {
            binding: slot as u32 + 1,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let first = wgpu::BindGroupEntry { binding: 0, resource: placings.as_entire_binding() };
        let last = solid
            .as_ref()
            .map(|solid| wgpu::BindGroupEntry { binding: SOLID_BINDING, resource: solid.as_entire_binding() });
        let entries: Vec<_> = std::iter::once(first).chain(views.iter().enumerate().map(image)).chain(last).collect();
        let group =
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("maps"), layout, entries: &entries });
        Ok(Some((group, bytes)))
    }

    /// An image on the GPU, and how many bytes had to be sent.
    fn view(
        &mut self,
        gpu: &Gpu,
        of: &MapUse,
        pyramid: &Pyramid,
        part: Part,
    ) -> Result<(wgpu::TextureView, u64), RenderError> {
        let key = (of.texture, of.form, part);
        if let Some(there) = self.textures.get(&key).filter(|there| there.pyramid.is_same(pyramid)) {
            return Ok((there.view.clone(), 0));
        }
        let texels = stored(part.select(pyramid), of.form);
        let what = match of.form {
            ImageForm::Pyramid => "an image with its pyramid",
            ImageForm::Ripmap => "an image with its ripmap",
            ImageForm::SummedAreas => "an image with its summed areas",
        };
        let view = sent(gpu, &texels, what)?;
        self.textures.insert(key, MapTexture { pyramid: pyramid.clone(), view: view.clone() });
        Ok((view, 16 * texels.len() as u64))
    }

    fn none(&mut self, gpu: &Gpu) -> Result<wgpu::TextureView, RenderError> {
        if let Some(view) = &self.none {
            return Ok(view.clone());
        }
        let view = sent(gpu, Pyramid::missing().texels(), "an image with its pyramid")?;
        Ok(self.none.insert(view).clone())
    }
}

/// The bytes of the record of placements.
const PLACINGS_BYTES: u64 = size_of::<PlacingsRecord>() as u64;

/// A constant buffer with these bytes.
fn uniform(gpu: &Gpu, label: &str, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// Texels of all levels in a texture of 32-bit floats; `of` says what they are of.
pub(crate) fn sent(gpu: &Gpu, texels: &[[f32; 4]], of: &str) -> Result<wgpu::TextureView, RenderError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let size = packed_size(texels, limit);
    if size[1] > limit {
        let what = format!("the texels of {of}, in rows of the longest side of a texture,");
        return Err(RenderError::TooLarge { what, needed: size[1].into(), limit: limit.into() });
    }
    let texture = packed(&gpu.device, &gpu.queue, texels, size);
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

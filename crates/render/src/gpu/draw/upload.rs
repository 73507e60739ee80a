//! The set Upload: uploads only data that changed since the last frame.

use crate::gpu::attachments::Target;
use crate::gpu::device::Gpu;
use crate::gpu::draw::maps::MapTextures;
use crate::gpu::draw::surroundings::SurroundingsOnGpu;
use crate::gpu::pipelines::cache::Pipelines;
use crate::gpu::shaders::records::{RECORD_BYTES, VIEW_BYTES, ViewRecord};
use crate::gpu::shaders::text::{COUNTED_LIGHT_BYTES, LightText, Text};
use bevy_ecs::prelude::*;
use halfway_asset::Assets;
use halfway_frame::batch::batches::Batches;
use halfway_frame::batch::draws::DrawState;
use halfway_frame::batch::lit_patches::LitPatches;
use halfway_frame::error::RenderError;
use halfway_frame::lights::slots::COUNTED_LIGHTS;
use halfway_frame::lights::surroundings::Surroundings;
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::View;
use halfway_lighting::record::LightRecord;
use halfway_texture::Texture;

/// A GPU buffer with a copy of its bytes, so that equal bytes are not uploaded again.
struct Mirrored {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
    bytes: Vec<u8>,
}

impl Mirrored {
    fn new(label: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { label, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None, bytes: Vec::new() }
    }

    /// Makes the buffer hold `bytes`, with at least `room` bytes of space. Returns the number of uploaded bytes and
    /// whether the buffer is new.
    fn set(&mut self, gpu: &Gpu, bytes: &[u8], room: u64) -> Result<(u64, bool), RenderError> {
        let needed = room.max(bytes.len() as u64).max(16).next_multiple_of(16);
        let limit = gpu.device.limits().max_buffer_size;
        if needed > limit {
            return Err(RenderError::TooLarge {
                what: format!("{} of this frame, in bytes,", self.label),
                needed,
                limit,
            });
        }
        let grown = self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed);
        if grown {
            self.bytes.clear();
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.label),
                size: needed.checked_next_power_of_two().unwrap_or(needed).min(limit),
                usage: self.usage,
                mapped_at_creation: false,
            }));
        }
        let Some(buffer) = &self.buffer else { return Ok((0, false)) };
        let changed = changed_range(&self.bytes, bytes);
        if !changed.is_empty() {
            gpu.queue.write_buffer(buffer, changed.start as u64, &bytes[changed.clone()]);
            self.bytes.clear();
            self.bytes.extend_from_slice(bytes);
        }
        Ok((changed.len() as u64, grown))
    }
}

/// The part of `new` that differs from `old`, widened to whole 4-byte words.
fn changed_range(old: &[u8], new: &[u8]) -> std::ops::Range<usize> {
    if old == new {
        return 0..0;
    }
    let same_start = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let start = same_start / 4 * 4;
    if old.len() != new.len() {
        return start..new.len();
    }
    let same_end = old.iter().rev().zip(new.iter().rev()).take_while(|(a, b)| a == b).count();
    start..(new.len() - same_end).next_multiple_of(4).min(new.len())
}

/// The buffers that draws read.
#[derive(Resource)]
pub(crate) struct Buffers {
    view: Mirrored,
    records: Mirrored,
    /// The lights for lists.
    lights: Mirrored,
    /// All lights of a scene with few.
    few_lights: Mirrored,
    lists: Mirrored,
    instances: Mirrored,
    groups: Groups,
    pub(crate) maps: MapTextures,
    pub(crate) surroundings: SurroundingsOnGpu,
}

/// Bindings of the same buffers, for each text that has a pipeline.
#[derive(Default)]
struct Groups {
    few: Option<wgpu::BindGroup>,
    /// With the one record that the offset names.
    one: Option<wgpu::BindGroup>,
    /// With all records.
    all: Option<wgpu::BindGroup>,
}

impl Default for Buffers {
    fn default() -> Self {
        use wgpu::BufferUsages as Usage;
        Self {
            view: Mirrored::new("the view", Usage::UNIFORM),
            records: Mirrored::new("the materials", Usage::UNIFORM | Usage::STORAGE),
            lights: Mirrored::new("the lights", Usage::STORAGE),
            few_lights: Mirrored::new("the few lights", Usage::UNIFORM),
            lists: Mirrored::new("the light lists", Usage::STORAGE),
            instances: Mirrored::new("the instances", Usage::VERTEX),
            groups: Groups::default(),
            maps: MapTextures::default(),
            surroundings: SurroundingsOnGpu::default(),
        }
    }
}

impl Buffers {
    pub(crate) fn instances(&self) -> Option<&wgpu::Buffer> {
        self.instances.buffer.as_ref()
    }

    /// The bindings of a draw, and the offset of its record.
    pub(crate) fn bindings(&self, state: &DrawState) -> Option<(&wgpu::BindGroup, u32)> {
        let record = state.record * RECORD_BYTES as u32;
        let Groups { few, one, all } = &self.groups;
        let (group, offset) = match Text::from_key(&state.key).lights {
            LightText::Few => (few, record),
            LightText::Listed if state.key.per_instance => (all, 0),
            LightText::Listed => (one, record),
        };
        Some((group.as_ref()?, offset))
    }

    fn upload(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        view: &View,
        (lit, batches): (&LitPatches, &Batches),
    ) -> Result<u64, RenderError> {
        let view = ViewRecord::from(view);
        let all_lights = lit.lists.sent.records.as_slice();
        let has_lists =
            batches.draws.groups().iter().any(|group| Text::from_key(&group.state.key).lights == LightText::Listed);
        let listed = if has_lists { all_lights } else { &[] };
        let few = if all_lights.len() <= COUNTED_LIGHTS as usize { all_lights } else { &[] };
        let sent = [
            self.view.set(gpu, bytemuck::bytes_of(&view), 0)?,
            self.records.set(gpu, bytemuck::cast_slice(&lit.records), RECORD_BYTES)?,
            self.lights.set(gpu, bytemuck::cast_slice(listed), size_of::<LightRecord>() as u64)?,
            // The buffer has space for all lights that fit.
            self.few_lights.set(gpu, bytemuck::cast_slice(few), COUNTED_LIGHT_BYTES)?,
            self.lists.set(gpu, bytemuck::cast_slice(&lit.lists.numbers), 0)?,
        ];
        let (instances, _) = self.instances.set(gpu, bytemuck::cast_slice(&batches.instances), 0)?;
        if sent.iter().any(|&(_, new)| new) {
            self.groups = Groups::default();
        }
        self.bind(gpu, pipelines)?;
        Ok(sent.iter().map(|(bytes, _)| bytes).sum::<u64>() + instances)
    }

    /// Creates missing bindings.
    fn bind(&mut self, gpu: &Gpu, pipelines: &Pipelines) -> Result<(), RenderError> {
        let (Some(view), Some(records), Some(lights), Some(few_lights), Some(lists)) =
            (&self.view.buffer, &self.records.buffer, &self.lights.buffer, &self.few_lights.buffer, &self.lists.buffer)
        else {
            return Ok(());
        };
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        for (label, buffer) in [(self.records.label, records), (self.lights.label, lights), (self.lists.label, lists)] {
            if buffer.size() > limit {
                let what = format!("{label} of this frame, in bytes,");
                return Err(RenderError::TooLarge { what, needed: buffer.size(), limit });
            }
        }
        let binding = |binding, buffer, size| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: std::num::NonZeroU64::new(size),
            }),
        };
        let make = |group: &mut Option<_>, text, entries: &[_]| {
            if let (None, Some(layout)) = (&group, pipelines.bindings(text)) {
                let entries = &[&[binding(0, view, VIEW_BYTES)], entries].concat();
                let descriptor = wgpu::BindGroupDescriptor { label: Some("draw"), layout, entries };
                *group = Some(gpu.device.create_bind_group(&descriptor));
            }
        };
        let Groups { few, one, all } = &mut self.groups;
        let fixed = [binding(1, records, RECORD_BYTES), binding(2, few_lights, COUNTED_LIGHT_BYTES)];
        make(few, LightText::Few, &fixed);
        for (group, bytes) in [(one, RECORD_BYTES), (all, records.size())] {
            let [lights, lists] = [binding(2, lights, lights.size()), binding(3, lists, lists.size())];
            make(group, LightText::Listed, &[binding(1, records, bytes), lights, lists]);
        }
        Ok(())
    }
}

/// Builds the missing pipelines of the frame's draws.
pub(crate) fn build_pipelines(
    gpu: Res<Gpu>,
    batches: Res<Batches>,
    mut pipelines: ResMut<Pipelines>,
    mut report: ResMut<FrameReport>,
) {
    for group in batches.draws.groups() {
        if let Err(error) = pipelines.ensure(&gpu, group.state.key)
            && !report.errors.contains(&error)
        {
            report.errors.push(error);
        }
    }
    pipelines.report(&mut report);
}

pub(crate) fn upload(
    gpu: Res<Gpu>,
    pipelines: Res<Pipelines>,
    view: Res<View>,
    lit: Res<LitPatches>,
    mut batches: ResMut<Batches>,
    mut buffers: ResMut<Buffers>,
    mut report: ResMut<FrameReport>,
) {
    if batches.draws.groups().is_empty() {
        return;
    }
    match buffers.upload(&gpu, &pipelines, &view, (&lit, &batches)) {
        Ok(bytes) => report.bytes_uploaded += bytes,
        Err(error) => {
            report.errors.push(error);
            batches.draws.clear();
        }
    }
}

/// Uploads the images that the draws read.
pub(crate) fn upload_maps(
    gpu: Res<Gpu>,
    lit: Res<LitPatches>,
    textures: Res<Assets<Texture>>,
    pipelines: Res<Pipelines>,
    mut buffers: ResMut<Buffers>,
    mut report: ResMut<FrameReport>,
) {
    buffers.maps.send(&gpu, &pipelines, &lit.table.maps, &textures, &mut report);
}

/// Uploads the environment that the draws and the sky read.
pub(crate) fn upload_surroundings(
    gpu: Res<Gpu>,
    surroundings: Res<Surroundings>,
    view: Res<View>,
    target: Res<Target>,
    mut buffers: ResMut<Buffers>,
    mut report: ResMut<FrameReport>,
) {
    let Some(frame) = &target.frame else { return };
    buffers.surroundings.make_ready(&gpu, &surroundings, (&view, frame.output), &mut report);
}

//! Upload: what changed since the last frame goes to the GPU, and nothing else.

use crate::batch::Batches;
use crate::error::RenderError;
use crate::geometry::Geometries;
use crate::gpu::Gpu;
use crate::lights::{LightRecord, Lights};
use crate::pipeline::{Pipelines, UNIFORM_LIGHT_BYTES};
use crate::records::DrawRecord;
use crate::report::FrameReport;
use crate::view::View;
use bevy_ecs::prelude::*;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct ViewRecord {
    scale: [f32; 2],
    near: f32,
    padding: f32,
}

/// A GPU buffer with the bytes it holds, so that equal bytes are not sent again.
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

    /// Makes the buffer hold `bytes`, at least `room` long. Returns the bytes sent and whether the
    /// buffer is a new one.
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
    draws: Mirrored,
    lights: Mirrored,
    instances: Mirrored,
    /// The offset of each pair of light lists in `lights`.
    pub(crate) list_offsets: Vec<u32>,
    uniform: Option<wgpu::BindGroup>,
    storage: Option<(u64, wgpu::BindGroup)>,
}

/// Offsets of uniform records: the largest alignment that WebGPU lets an adapter ask for.
pub(crate) const RECORD_STRIDE: usize = 256;

impl Default for Buffers {
    fn default() -> Self {
        use wgpu::BufferUsages as Usage;
        Self {
            view: Mirrored::new("the view", Usage::UNIFORM),
            draws: Mirrored::new("the materials", Usage::UNIFORM),
            lights: Mirrored::new("the lights", Usage::UNIFORM | Usage::STORAGE),
            instances: Mirrored::new("the instances", Usage::VERTEX),
            list_offsets: Vec::new(),
            uniform: None,
            storage: None,
        }
    }
}

impl Buffers {
    pub(crate) fn instances(&self) -> Option<&wgpu::Buffer> {
        self.instances.buffer.as_ref()
    }

    pub(crate) fn bind_group(&self, storage: bool) -> Option<&wgpu::BindGroup> {
        if storage { self.storage.as_ref().map(|(_, group)| group) } else { self.uniform.as_ref() }
    }

    fn upload(
        &mut self,
        gpu: &Gpu,
        pipelines: &Pipelines,
        view: &View,
        lights: &Lights,
        batches: &Batches,
    ) -> Result<u64, RenderError> {
        let record = ViewRecord { scale: view.projection.scale, near: view.projection.near, padding: 0.0 };
        let (lists, longest) = self.lay_out_lists(lights, batches);
        let room = lists.len() as u64 + longest.max(UNIFORM_LIGHT_BYTES);
        let records = strided(&batches.records);
        let sent = [
            self.view.set(gpu, bytemuck::bytes_of(&record), 0)?,
            self.draws.set(gpu, &records, 0)?,
            self.lights.set(gpu, &lists, room)?,
        ];
        let (instances, _) = self.instances.set(gpu, bytemuck::cast_slice(&batches.instances), 0)?;
        let stale = sent.iter().any(|&(_, new)| new);
        self.bind(gpu, pipelines, stale, longest)?;
        Ok(sent.iter().map(|(bytes, _)| bytes).sum::<u64>() + instances)
    }

    /// Lays the light lists one after the other; returns their bytes and the longest's.
    fn lay_out_lists(&mut self, lights: &Lights, batches: &Batches) -> (Vec<u8>, u64) {
        let mut bytes = Vec::new();
        let mut longest = 0;
        self.list_offsets.clear();
        for &(vertex, fragment) in &batches.lists {
            bytes.resize(bytes.len().next_multiple_of(RECORD_STRIDE), 0);
            self.list_offsets.push(bytes.len() as u32);
            for list in [vertex, fragment] {
                bytes.extend_from_slice(bytemuck::cast_slice(&lights.list(list).records));
            }
            longest = longest.max(bytes.len() as u64 - u64::from(self.list_offsets[self.list_offsets.len() - 1]));
        }
        (bytes, longest)
    }

    fn bind(&mut self, gpu: &Gpu, pipelines: &Pipelines, stale: bool, longest: u64) -> Result<(), RenderError> {
        let (Some(view), Some(draws), Some(lights)) = (&self.view.buffer, &self.draws.buffer, &self.lights.buffer)
        else {
            return Ok(());
        };
        let group = |storage, size| {
            let binding = |buffer, size| {
                wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer,
                    offset: 0,
                    size: std::num::NonZeroU64::new(size),
                })
            };
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("draw"),
                layout: pipelines.bindings(storage),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: binding(view, 16) },
                    wgpu::BindGroupEntry { binding: 1, resource: binding(draws, size_of::<DrawRecord>() as u64) },
                    wgpu::BindGroupEntry { binding: 2, resource: binding(lights, size) },
                ],
            })
        };
        if stale || self.uniform.is_none() {
            self.uniform = Some(group(false, UNIFORM_LIGHT_BYTES));
        }
        let size = longest.max(size_of::<LightRecord>() as u64).next_multiple_of(4);
        if longest > UNIFORM_LIGHT_BYTES && (stale || self.storage.as_ref().is_none_or(|(bound, _)| *bound != size)) {
            let limit = gpu.device.limits().max_storage_buffer_binding_size;
            if size > limit {
                return Err(RenderError::TooLarge {
                    what: "the longest light list, in bytes,".into(),
                    needed: size,
                    limit,
                });
            }
            self.storage = Some((size, group(true, size)));
        } else if stale {
            self.storage = None;
        }
        Ok(())
    }
}

fn strided(records: &[DrawRecord]) -> Vec<u8> {
    let mut bytes = vec![0; records.len() * RECORD_STRIDE];
    for (slot, record) in bytes.chunks_exact_mut(RECORD_STRIDE).zip(records) {
        slot[..size_of::<DrawRecord>()].copy_from_slice(bytemuck::bytes_of(record));
    }
    bytes
}

/// Builds the pipelines of what is about to be drawn, and counts its triangles.
pub(crate) fn build_pipelines(
    gpu: Res<Gpu>,
    geometries: Res<Geometries>,
    batches: Res<Batches>,
    mut pipelines: ResMut<Pipelines>,
    mut report: ResMut<FrameReport>,
) {
    for draw in &batches.draws {
        pipelines.ensure(&gpu, draw.key);
        let triangles = geometries.get(draw.mesh, draw.flat).map_or(0, |geometry| geometry.index_count / 3);
        report.triangles += u64::from(triangles) * draw.instances.len() as u64;
    }
    report.pipelines = pipelines.count();
}

pub(crate) fn upload(
    gpu: Res<Gpu>,
    pipelines: Res<Pipelines>,
    view: Res<View>,
    lights: Res<Lights>,
    mut batches: ResMut<Batches>,
    mut buffers: ResMut<Buffers>,
    mut report: ResMut<FrameReport>,
) {
    if batches.draws.is_empty() {
        return;
    }
    match buffers.upload(&gpu, &pipelines, &view, &lights, &batches) {
        Ok(bytes) => report.bytes_uploaded += bytes,
        Err(error) => {
            report.errors.push(error);
            batches.draws.clear();
        }
    }
}

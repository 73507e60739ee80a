//! Passes over the finished picture, by the camera's intensity policy: from the floating-point scene to the target's
//! values.

use crate::gpu::device::Gpu;
use crate::gpu::shaders::picture::{PICTURE_FILES, PicturePolicyRecord};
use bevy_math::UVec2;

/// Textures, pipelines and bindings of one size, one format and one kind of policy.
pub(crate) struct PicturePasses {
    made_as: MadeAs,
    /// The view that the scene is drawn into.
    drawn: wgpu::TextureView,
    policy: wgpu::Buffer,
    /// Its contents.
    written: PicturePolicyRecord,
    /// The division, if the policy divides.
    division: Option<Division>,
    /// The bindings of the last pass, for either divisor.
    finish: [wgpu::BindGroup; 2],
    finished: wgpu::RenderPipeline,
}

#[derive(Clone, Copy, PartialEq, Eq)]
struct MadeAs {
    size: UVec2,
    drawn: wgpu::TextureFormat,
    output: wgpu::TextureFormat,
    divides: bool,
}

/// The reduction to the divisor of a picture.
struct Division {
    largest: wgpu::RenderPipeline,
    next_divisor: wgpu::RenderPipeline,
    /// The input bindings and the output view of each step: the largest channel of each block, down to a few texels.
    blocks: Vec<(wgpu::BindGroup, wgpu::TextureView)>,
    /// The last step, with the previous divisor: that of the second texture, or of the first.
    last: [wgpu::BindGroup; 2],
    divisors: [wgpu::TextureView; 2],
    /// Which of them this frame writes.
    now: usize,
    /// Whether the other one holds the previous frame's divisor.
    has_before: bool,
}

/// A pass reduces blocks of this many texels a side to one: `BLOCK` of `picture.wgsl`.
const BLOCK: u32 = 8;
const NUMBER: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

impl PicturePasses {
    /// Prepares the frame's passes, reusing those of the previous frame if they fit; returns the number of uploaded
    /// bytes.
    pub(crate) fn prepare(
        before: Option<Self>,
        gpu: &Gpu,
        size: UVec2,
        [drawn, output]: [wgpu::TextureFormat; 2],
        record: PicturePolicyRecord,
    ) -> (Self, u64) {
        let made_as = MadeAs { size, drawn, output, divides: record.divides() };
        let mut passes = before.filter(|it| it.made_as == made_as).unwrap_or_else(|| Self::new(gpu, made_as));
        let mut record = record;
        if let Some(division) = &mut passes.division {
            division.now = 1 - division.now;
            if !std::mem::replace(&mut division.has_before, true) {
                record.smoothing = 0.0;
            }
        }
        if passes.written == record {
            return (passes, 0);
        }
        passes.written = record;
        let bytes = bytemuck::bytes_of(&passes.written);
        gpu.queue.write_buffer(&passes.policy, 0, bytes);
        let sent = bytes.len() as u64;
        (passes, sent)
    }

    /// The view that the scene is to be drawn into.
    pub(crate) fn drawn(&self) -> &wgpu::TextureView {
        &self.drawn
    }

    /// The number of passes.
    pub(crate) fn count(&self) -> u32 {
        1 + self.division.as_ref().map_or(0, |division| division.blocks.len() as u32 + 1)
    }

    /// Encodes them after the scene's pass.
    pub(crate) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let mut now = 0;
        if let Some(division) = &self.division {
            now = division.now;
            for (bindings, written) in &division.blocks {
                pass(encoder, written, &division.largest, bindings, None);
            }
            pass(encoder, &division.divisors[now], &division.next_divisor, &division.last[now], None);
        }
        pass(encoder, target, &self.finished, &self.finish[now], timestamp_writes);
    }

    fn new(gpu: &Gpu, made_as: MadeAs) -> Self {
        let MadeAs { size, drawn, output, divides } = made_as;
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("picture"),
            source: wgpu::ShaderSource::Wgsl(PICTURE_FILES.concat().into()),
        });
        let layout = bindings_layout(device);
        let pipelines = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("picture"),
            bind_group_layouts: &[Some(&layout)],
            ..Default::default()
        });
        let pipeline = |entry, format| pipeline(device, &pipelines, &module, entry, format);
        let policy = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("policy"),
            size: size_of::<PicturePolicyRecord>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let drawn = texture(device, "drawn", size, drawn);
        let divisors = [0, 1].map(|_| texture(device, "divisor", UVec2::ONE, NUMBER));
        let bound = |read: &wgpu::TextureView, divisor: &wgpu::TextureView| {
            let resources = [
                policy.as_entire_binding(),
                wgpu::BindingResource::TextureView(read),
                wgpu::BindingResource::TextureView(divisor),
            ];
            let entries: Vec<_> =
                (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("picture"),
                layout: &layout,
                entries: &entries,
            })
        };
        let finish = [0, 1].map(|now| bound(&drawn, &divisors[now]));
        let division = divides.then(|| {
            let mut blocks = Vec::new();
            let (mut read, mut left) = (drawn.clone(), blocks_of(size));
            while left != UVec2::ONE {
                let written = texture(device, "largest", left, NUMBER);
                blocks.push((bound(&read, &divisors[0]), written.clone()));
                (read, left) = (written, blocks_of(left));
            }
            Division {
                largest: pipeline("largest", NUMBER),
                next_divisor: pipeline("next_divisor", NUMBER),
                blocks,
                last: [1, 0].map(|before: usize| bound(&read, &divisors[before])),
                divisors: divisors.clone(),
                now: 1,
                has_before: false,
            }
        });
        let finished = pipeline("finished", output);
        // The first frame writes it.
        let written = PicturePolicyRecord { curve: u32::MAX, ..PicturePolicyRecord::default() };
        Self { made_as, drawn, policy, written, division, finish, finished }
    }
}

fn blocks_of(size: UVec2) -> UVec2 {
    UVec2::new(size.x.div_ceil(BLOCK), size.y.div_ceil(BLOCK))
}

fn texture(device: &wgpu::Device, label: &str, size: UVec2, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn bindings_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let policy = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: std::num::NonZeroU64::new(size_of::<PicturePolicyRecord>() as u64),
    };
    let texels = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("picture"),
        entries: &[entry(0, policy), entry(1, texels), entry(2, texels)],
    })
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    entry: &str,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("whole"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn pass(
    encoder: &mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    pipeline: &wgpu::RenderPipeline,
    bindings: &wgpu::BindGroup,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            // The whole target is overwritten.
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        timestamp_writes,
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bindings, &[]);
    pass.draw(0..3, 0..1);
}

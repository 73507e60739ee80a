//! The set Upload: uploads the environment, and builds the pipeline of the sky.

use crate::gpu::attachments::ShaderOutput;
use crate::gpu::device::Gpu;
use crate::gpu::draw::maps::sent;
use crate::gpu::draw::placings::packed_size;
use crate::gpu::format::DEPTH_FORMAT;
use crate::gpu::shaders::text::{SKY, surroundings_bindings};
use bytemuck::{Pod, Zeroable};
use halfway_frame::error::RenderError;
use halfway_frame::lights::surroundings::Surroundings;
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::View;
use halfway_texture::environment::SurroundingsData;
use halfway_texture::environment::{EnvironmentLevel, EnvironmentMap};

/// The last drawn environment, and the pipeline of the sky. Empty without an environment.
#[derive(Default)]
pub(crate) struct SurroundingsOnGpu {
    texture: Option<(EnvironmentMap, wgpu::TextureView)>,
    record: Option<(SurroundingsRecord, wgpu::Buffer)>,
    group: Option<wgpu::BindGroup>,
    sky: Option<(ShaderOutput, wgpu::RenderPipeline)>,
    /// Whether the frame shows the sky.
    shows_sky: bool,
}

/// The parameters of an environment; `Surroundings` in surroundings.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SurroundingsRecord {
    pub(crate) row0: [f32; 4],
    pub(crate) row1: [f32; 4],
    pub(crate) row2: [f32; 4],
    /// Three numbers each.
    pub(crate) mean: [[f32; 4]; 9],
    pub(crate) strength: f32,
    pub(crate) first_angle: f32,
    pub(crate) sky_level: f32,
    pub(crate) width: u32,
    pub(crate) way: [f32; 4],
    pub(crate) levels: [u32; 4],
    pub(crate) level: [[u32; 4]; 12],
}

impl SurroundingsRecord {
    fn new(placed: &SurroundingsData, view: &View, width: u32) -> Self {
        let four = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        let [row0, row1, row2] = placed.rows.map(four);
        let mut level = [[0; 4]; 12];
        for (record, EnvironmentLevel { side, start }) in level.iter_mut().zip(placed.map.levels()) {
            *record = [*start as u32, *side, 0, 0];
        }
        let [corner, middle] = [1.0, 0.0].map(|at| view.lens.ray([at; 2]).direction);
        let [x, y] = [0, 1].map(|axis| corner[axis] - middle[axis]);
        Self {
            row0,
            row1,
            row2,
            mean: placed.mean.map(four),
            strength: placed.strength,
            first_angle: -placed.map.level_of(1.0_f64) as f32,
            sky_level: placed.sky.unwrap_or_default(),
            width,
            way: [x, y, middle[0], middle[1]],
            levels: [placed.map.levels().len() as u32, 0, 0, 0],
            level,
        }
    }
}

impl SurroundingsOnGpu {
    /// Uploads changes of the environment, and prepares the pipeline of the sky.
    pub(crate) fn make_ready(
        &mut self,
        gpu: &Gpu,
        surroundings: &Surroundings,
        (view, output): (&View, ShaderOutput),
        report: &mut FrameReport,
    ) {
        self.shows_sky = false;
        let Some(placed) = &surroundings.0 else { return };
        match self.send(gpu, placed, view) {
            Ok(bytes) => report.bytes_uploaded += bytes,
            Err(error) => {
                self.group = None;
                report.errors.push(error);
                return;
            }
        }
        if placed.sky.is_some() {
            self.shows_sky = true;
            if self.sky.as_ref().is_none_or(|(there, _)| *there != output) {
                self.sky = Some((output, sky_pipeline(gpu, output)));
            }
        }
    }

    pub(crate) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.group.as_ref()
    }

    /// The pipeline of the sky, if the sky is drawn.
    pub(crate) fn sky(&self) -> Option<(&wgpu::RenderPipeline, &wgpu::BindGroup)> {
        let (_, pipeline) = self.sky.as_ref().filter(|_| self.shows_sky)?;
        Some((pipeline, self.group.as_ref()?))
    }

    /// Returns the number of uploaded bytes.
    fn send(&mut self, gpu: &Gpu, placed: &SurroundingsData, view: &View) -> Result<u64, RenderError> {
        let mut bytes = 0;
        if self.texture.as_ref().is_none_or(|(map, _)| !map.is_same(&placed.map)) {
            let texels = placed.map.texels();
            self.texture = Some((placed.map.clone(), sent(gpu, texels, "an environment")?));
            self.group = None;
            bytes += 16 * texels.len() as u64;
        }
        let record = SurroundingsRecord::new(
            placed,
            view,
            packed_size(placed.map.texels(), gpu.device.limits().max_texture_dimension_2d)[0],
        );
        if self.record.as_ref().is_none_or(|(there, _)| *there != record) {
            let buffer = match self.record.take() {
                Some((_, buffer)) => buffer,
                None => gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("how the environment is looked up"),
                    size: size_of::<SurroundingsRecord>() as u64,
                    usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                }),
            };
            gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&record));
            bytes += size_of::<SurroundingsRecord>() as u64;
            self.record = Some((record, buffer));
        }
        if let (None, Some((_, view)), Some((_, buffer))) = (&self.group, &self.texture, &self.record) {
            self.group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("surroundings"),
                layout: &surroundings_bindings(gpu),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(view) },
                ],
            }));
        }
        Ok(bytes)
    }
}

/// One triangle over the whole picture, drawn first; it does not write depth.
fn sky_pipeline(gpu: &Gpu, output: ShaderOutput) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("sky"),
        source: wgpu::ShaderSource::Wgsl(SKY.concat().into()),
    });
    let bindings = surroundings_bindings(gpu);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("sky"),
        bind_group_layouts: &[None, None, Some(&bindings)],
        ..Default::default()
    });
    let constants = [("ENCODED", f64::from(u8::from(output.encoded)))];
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sky"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_sky"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: output.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_sky"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[Some(wgpu::ColorTargetState {
                format: output.format,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

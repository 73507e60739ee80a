//! Builds a pipeline from its key.

use crate::gpu::attachments::ShaderOutput;
use crate::gpu::device::Gpu;
use crate::gpu::format::DEPTH_FORMAT;
use crate::gpu::pipelines::key::PipelineKey;
use crate::gpu::shaders::records::{INSTANCE, INSTANCE_BYTES};
use crate::gpu::shaders::template::EntryPoint;
use crate::gpu::shaders::text::{Shader, Text};
use halfway_frame::batch::key::DrawKey;
use halfway_frame::lights::slots::Lists;
use halfway_lighting::Frequency;
use halfway_lighting::lights::Kind;
use halfway_lighting::record::Cull;
use halfway_texture::MapKind;
use wgpu::naga::ShaderStage;

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![6 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![7 => Float32x3];
const COLOR: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![10 => Float32x4];
const UV: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![11 => Float32x4];
const TANGENT: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![12 => Float32x4];
const FACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![7 => Float32x3, 8 => Float32x3];

impl Shader {
    pub(crate) fn build(&self, gpu: &Gpu, pipeline: PipelineKey) -> wgpu::RenderPipeline {
        let PipelineKey { draw: key, output } = pipeline;
        let text = Text::from_key(&key);
        let buffer = |used: bool, attributes, stride| {
            let step_mode = wgpu::VertexStepMode::Vertex;
            used.then_some(wgpu::VertexBufferLayout { array_stride: stride, step_mode, attributes })
        };
        let without_normals = [INSTANCE[0], INSTANCE[1], INSTANCE[2], INSTANCE[6]];
        let instance = wgpu::VertexBufferLayout {
            array_stride: INSTANCE_BYTES,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: if text.reads_normals() { &INSTANCE } else { &without_normals },
        };
        let (normals, normal_bytes) = if text.is_flat() { (&FACE[..], 24) } else { (&NORMAL[..], 12) };
        let buffers = [
            Some(instance),
            buffer(true, &POSITION, 12),
            buffer(text.reads_normals(), normals, normal_bytes),
            buffer(text.painted, &COLOR, 16),
            buffer(text.mapped, &UV, 16),
            buffer(text.relief, &TANGENT, 16),
        ];
        let constants = constants(&key, output);
        let module = |stage, name| self.template.shader(&gpu.device, EntryPoint { stage, name, constants: &constants });
        let vertex = module(ShaderStage::Vertex, "vs_surface");
        let fragment = module(ShaderStage::Fragment, "fs_surface");
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&pipeline.to_string()),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &vertex,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                front_face: if key.clockwise { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                cull_mode: match key.cull {
                    Cull::Back => Some(wgpu::Face::Back),
                    Cull::Front => Some(wgpu::Face::Front),
                    Cull::None => None,
                },
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(!key.blend),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: output.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &fragment,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: output.format,
                    blend: key.blend.then_some(OVER),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// opacity·I + (1 − opacity)·B over the color B behind; the picture stays opaque.
const OVER: wgpu::BlendState = wgpu::BlendState {
    color: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::SrcAlpha,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    },
    alpha: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    },
};

fn constants(key: &DrawKey, output: ShaderOutput) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let constants = [
        ("BLINN_PHONG", flag(key.blinn_phong)),
        ("LOCAL_VIEWER", flag(key.local_viewer)),
        ("ATTENUATED_AMBIENT", flag(key.attenuated_ambient)),
        ("SHARED_COLOR", flag(key.shared_color)),
        ("SPECULAR", flag(key.terms.specular != Frequency::Never)),
        ("RANGED", flag(key.ranged)),
        ("SQUARINGS", key.squarings.map_or(-1.0, f64::from)),
        ("BLEND", flag(key.blend)),
        ("ENCODED", flag(output.encoded)),
        ("GEOMETRIC_FALLBACK", flag(key.geometric_fallback)),
        ("PER_INSTANCE", flag(key.per_instance)),
        ("LISTED", flag(key.lists == Lists::Listed)),
        ("LIGHTS", key.lists.count().into()),
        ("MIXED_LIGHTS", flag(key.lists.kinds().len() > 1)),
    ];
    let kinds = Kind::ALL.iter().map(|&kind| (kind.wgsl_constant(), flag(key.lists.kinds().has(kind))));
    let constants: Vec<_> = constants.into_iter().chain(kinds).collect();
    if key.is_mapped() { constants.into_iter().chain(map_constants(key)).collect() } else { constants }
}

/// The constants of image lookups, by their names in maps.wgsl.
fn map_constants(key: &DrawKey) -> impl Iterator<Item = (&'static str, f64)> {
    const NAMES: [&str; MapKind::COUNT] = [
        "COLOR_MAP",
        "SPECULAR_MAP",
        "EMISSION_MAP",
        "OPACITY_MAP",
        "SHININESS_MAP",
        "OCCLUSION_MAP",
        "NORMAL_MAP",
        "HEIGHT_MAP",
    ];
    let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
    let maps = NAMES.into_iter().zip(key.maps.0).filter_map(|(name, look)| Some((name, f64::from(look?.bits()))));
    let signs = [("TANGENT_SIGN", sign(key.inside_out)), ("BITANGENT_SIGN", sign(key.clockwise))];
    // By its number in solids.wgsl.
    let solid = key.solid.map(|kind| ("SOLID_KIND", f64::from(kind as u32)));
    let flags = [("MASKED", key.masked), ("TOKSVIG", key.maps.take_lengths()), ("LEAN", key.maps.take_moments())];
    maps.chain(signs).chain(flags.map(|(name, on)| (name, f64::from(u8::from(on))))).chain(solid)
}

//! How a pipeline is built from its key.

use crate::batch::key::{Cull, DrawKey};
use crate::device::gpu::Gpu;
use crate::lights::terms::{by_fragment_shader, by_vertex_shader};
use crate::pipelines::key::PipelineKey;
use crate::shaders::light_slots::Lists;
use crate::shaders::records::{INSTANCE, INSTANCE_BYTES};
use crate::shaders::template::EntryPoint;
use crate::shaders::text::Shader;
use crate::target::frame::{DEPTH_FORMAT, ShaderOutput};
use halfway_lighting::Frequency;
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
        let constants = constants(&key, output);
        let buffer = |attributes, stride, step_mode| {
            Some(wgpu::VertexBufferLayout { array_stride: stride, step_mode, attributes })
        };
        // Unlit draws need no normal matrix, and a software adapter pays for every attribute it fetches.
        let unlit = [INSTANCE[0], INSTANCE[1], INSTANCE[2], INSTANCE[6]];
        let has_attributes = key.reads_attributes();
        let instance = if has_attributes { &INSTANCE[..] } else { &unlit[..] };
        let mut buffers = vec![
            buffer(instance, INSTANCE_BYTES, wgpu::VertexStepMode::Instance),
            buffer(&POSITION, 12, wgpu::VertexStepMode::Vertex),
        ];
        if key.terms.has(Frequency::Triangle) {
            buffers.push(buffer(&FACE, 24, wgpu::VertexStepMode::Vertex));
        } else if has_attributes {
            buffers.push(buffer(&NORMAL, 12, wgpu::VertexStepMode::Vertex));
        }
        if key.is_painted() {
            buffers.push(buffer(&COLOR, 16, wgpu::VertexStepMode::Vertex));
        }
        if key.is_mapped() {
            buffers.push(buffer(&UV, 16, wgpu::VertexStepMode::Vertex));
            if !key.terms.has(Frequency::Triangle) {
                buffers.push(buffer(&TANGENT, 16, wgpu::VertexStepMode::Vertex));
            }
        }
        let (vertex, fragment) = entry_points(&key);
        let module = |stage, name| self.template.shader(&gpu.device, EntryPoint { stage, name, constants: &constants });
        let vertex = module(ShaderStage::Vertex, vertex);
        let fragment = module(ShaderStage::Fragment, fragment);
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

/// opacity·I + (1 − opacity)·what is behind; the picture stays opaque.
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

fn entry_points(key: &DrawKey) -> (&'static str, &'static str) {
    if key.solid.is_some() {
        return solid_entry_points(key);
    }
    let is_one_sided = key.cull == Cull::Back;
    if key.terms.has(Frequency::Triangle) {
        return ("vs_flat", "fs_flat");
    }
    let [by_vertices, by_fragments] =
        [by_vertex_shader(key.terms), by_fragment_shader(key.terms)].map(|terms| terms.contains(&true));
    match (by_vertices, by_fragments) {
        (_, false) if key.is_painted() => ("vs_gouraud", "fs_gouraud"),
        (_, true) if key.is_painted() => ("vs_mixed", "fs_mixed"),
        (false, false) if is_one_sided => ("vs_unlit", "fs_unlit"),
        (false, false) => ("vs_unlit_both", "fs_unlit_both"),
        (true, false) if is_one_sided => ("vs_gouraud", "fs_gouraud"),
        (true, false) => ("vs_gouraud_both", "fs_gouraud_both"),
        (false, true) => ("vs_phong", "fs_phong"),
        (true, true) => ("vs_mixed", "fs_mixed"),
    }
}

fn solid_entry_points(key: &DrawKey) -> (&'static str, &'static str) {
    match by_fragment_shader(key.terms).contains(&true) {
        _ if key.terms.has(Frequency::Triangle) => ("vs_solid_flat", "fs_solid_flat"),
        false => ("vs_solid_gouraud", "fs_solid_gouraud"),
        true => ("vs_solid_mixed", "fs_solid_mixed"),
    }
}

fn constants(key: &DrawKey, output: ShaderOutput) -> Vec<(&'static str, f64)> {
    let [directional, points, spots] = key.lists.counts();
    let flag = |on: bool| f64::from(u8::from(on));
    let [vertex_diffuse, vertex_specular] = by_vertex_shader(key.terms).map(flag);
    let [fragment_diffuse, fragment_specular] = by_fragment_shader(key.terms).map(flag);
    let constants = vec![
        ("VERTEX_DIFFUSE", vertex_diffuse),
        ("VERTEX_SPECULAR", vertex_specular),
        ("FRAGMENT_DIFFUSE", fragment_diffuse),
        ("FRAGMENT_SPECULAR", fragment_specular),
        ("BLINN_PHONG", flag(key.blinn_phong)),
        ("LOCAL_VIEWER", flag(key.local_viewer)),
        ("ATTENUATED_AMBIENT", flag(key.attenuated_ambient)),
        ("SHARED_COLOR", flag(key.shared_color)),
        ("SPECULAR", flag(key.terms.specular != Frequency::Never)),
        ("RANGED", flag(key.ranged)),
        ("SQUARINGS", key.squarings.map_or(-1.0, f64::from)),
        ("TWO_SIDED", flag(key.cull != Cull::Back)),
        ("BLEND", flag(key.blend)),
        ("ENCODED", flag(output.encoded)),
        ("GEOMETRIC_FALLBACK", flag(key.geometric_fallback)),
        ("PER_INSTANCE", flag(key.per_instance)),
        ("LISTED", flag(key.lists == Lists::Listed)),
        ("DIRECTIONAL", directional.into()),
        ("POINTS", points.into()),
        ("SPOTS", spots.into()),
    ];
    if key.is_mapped() { constants.into_iter().chain(map_constants(key)).collect() } else { constants }
}

/// How images are looked up, by the names of maps.wgsl.
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

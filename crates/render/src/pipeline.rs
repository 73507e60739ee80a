//! Pipelines: a small key for each, built on first use and counted.

use crate::gpu::Gpu;
use crate::records::INSTANCE_BYTES;
use crate::shader::{COUNTED_LIGHTS, Highlights, Lists, Shader, Text};
use crate::target::DEPTH_FORMAT;
use crate::terms::TermMask;
use bevy_ecs::prelude::Resource;
use std::collections::{HashMap, HashSet};
use std::fmt;

/// Where a draw's terms are shaded; each has its own pair of entry points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Stage {
    Unlit,
    Flat,
    Vertex,
    Fragment,
    Mixed,
}

/// All that a pipeline is specialised for. What a draw does not use is not in its shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent switch of the shader")]
pub(crate) struct PipelineKey {
    pub(crate) blend: bool,
    pub(crate) stage: Stage,
    pub(crate) lists: Lists,
    /// The terms that are shaded at the vertices.
    pub(crate) vertex: TermMask,
    /// The terms that are shaded at the fragments.
    pub(crate) fragment: TermMask,
    /// Each instance names its record.
    pub(crate) per_instance: bool,
    pub(crate) blinn_phong: bool,
    pub(crate) local_viewer: bool,
    pub(crate) attenuated_ambient: bool,
    /// Every light's specular colour is its diffuse colour.
    pub(crate) shared_colour: bool,
    /// Some light has a range.
    pub(crate) ranged: bool,
    /// The exponent is 2 to this power on both sides.
    pub(crate) squarings: Option<u8>,
    pub(crate) geometric_fallback: bool,
    pub(crate) cull: Cull,
    /// Front faces wind clockwise: the transform mirrors, or only back faces are shown.
    pub(crate) clockwise: bool,
    pub(crate) samples: u32,
    pub(crate) format: wgpu::TextureFormat,
}

/// Which faces the rasteriser drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Cull {
    /// The side that is not lit as front.
    Back,
    /// Only the first pass of a blended two-sided object, which draws the far side.
    Front,
    /// None: both sides are lit.
    None,
}

impl fmt::Display for PipelineKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reflectance = if self.blinn_phong { "blinn_phong" } else { "phong" };
        write!(f, "{:?} {:?} {reflectance} {:?}", self.stage, self.lists, self.cull)?;
        for (on, name) in [
            (self.vertex.diffuse, "vertex_diffuse"),
            (self.vertex.specular, "vertex_specular"),
            (self.fragment.diffuse, "fragment_diffuse"),
            (self.fragment.specular, "fragment_specular"),
            (self.per_instance, "per_instance"),
            (self.local_viewer, "local_viewer"),
            (self.attenuated_ambient, "attenuated_ambient"),
            (self.shared_colour, "shared_colour"),
            (self.ranged, "ranged"),
            (self.geometric_fallback, "geometric_fallback"),
            (self.clockwise, "clockwise"),
            (self.blend, "blend"),
        ] {
            if on {
                write!(f, " {name}")?;
            }
        }
        if let Some(squarings) = self.squarings {
            write!(f, " squarings={squarings}")?;
        }
        write!(f, " {:?} x{}", self.format, self.samples)
    }
}

/// The pipelines built so far, with what they share.
#[derive(Resource, Default)]
pub(crate) struct Pipelines {
    shaders: HashMap<Text, Shader>,
    built: HashMap<PipelineKey, wgpu::RenderPipeline>,
    /// The specialised keys that may be built.
    special: HashSet<PipelineKey>,
    /// What was asked last, and the answer.
    last: Option<(PipelineKey, PipelineKey)>,
}

/// So many specialised pipelines live at most; what more a scene asks for is drawn by generic ones, which are slower and
/// few: they differ in the stages of their terms, the reflectance, the viewer, faces, blending and the target alone. A
/// draw that looks up records for its instances has a pipeline beside that of its key.
pub(crate) const MOST_SPECIAL: usize = 128;

impl PipelineKey {
    pub(crate) fn text(&self) -> Text {
        match self.lists {
            _ if self.per_instance => Text::Listed,
            Lists::Listed => Text::Listed,
            Lists::Counted(counts, _) if counts.iter().sum::<u8>() <= COUNTED_LIGHTS as u8 => Text::Few,
            Lists::Counted(..) => Text::Many,
        }
    }

    /// The pipeline that draws the same without knowing the lights, the colours, the exponent and the mesh.
    pub(crate) fn generic(self) -> Self {
        let lit = self.stage != Stage::Unlit;
        Self {
            lists: if lit { Lists::Listed } else { self.lists },
            shared_colour: false,
            attenuated_ambient: self.vertex.diffuse || self.fragment.diffuse,
            ranged: lit,
            squarings: None,
            geometric_fallback: !self.fragment.is_empty(),
            ..self
        }
    }

    /// Whether a highlight takes a logarithm and an exponential, and not a few squarings.
    pub(crate) fn takes_powers(&self) -> bool {
        (self.vertex.specular || self.fragment.specular) && self.squarings.is_none()
    }

    /// Whether records and lights are read from storage, as lists and records of instances are.
    pub(crate) fn reads_storage(&self) -> bool {
        self.text() == Text::Listed
    }
}

impl Pipelines {
    /// The layout of the bindings that such pipelines need; `None` before the first is built.
    pub(crate) fn bindings(&self, text: Text) -> Option<&wgpu::BindGroupLayout> {
        self.shaders.get(&text).map(|shader| &shader.bindings)
    }

    /// The key itself, or the generic one that draws the same.
    pub(crate) fn admit(&mut self, key: PipelineKey) -> PipelineKey {
        if let Some((asked, answer)) = self.last
            && asked == key
        {
            return answer;
        }
        let room = self.special.len() < MOST_SPECIAL;
        let answer = if self.special.contains(&key) || room && self.special.insert(key) { key } else { key.generic() };
        self.last = Some((key, answer));
        answer
    }

    pub(crate) fn get(&self, key: &PipelineKey) -> Option<&wgpu::RenderPipeline> {
        self.built.get(key)
    }

    pub(crate) fn count(&self) -> u32 {
        self.built.len() as u32
    }

    /// Builds the pipeline unless it is there.
    pub(crate) fn ensure(&mut self, gpu: &Gpu, key: PipelineKey) {
        if !self.built.contains_key(&key) {
            log::debug!("building pipeline {key}");
            let shader = self.shaders.entry(key.text()).or_insert_with_key(|&text| Shader::new(gpu, text));
            self.built.insert(key, shader.build(gpu, key));
        }
    }
}

const INSTANCE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 9 => Uint32];
const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![6 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![7 => Float32x3];
const FACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![7 => Float32x3, 8 => Float32x3];

impl Shader {
    fn build(&self, gpu: &Gpu, key: PipelineKey) -> wgpu::RenderPipeline {
        let constants = constants(key);
        let compilation_options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let buffer = |attributes, stride, step_mode| {
            Some(wgpu::VertexBufferLayout { array_stride: stride, step_mode, attributes })
        };
        // Unlit draws need no normal matrix, and a software adapter pays for every attribute it fetches.
        let unlit = [INSTANCE[0], INSTANCE[1], INSTANCE[2], INSTANCE[6]];
        let instance = if key.stage == Stage::Unlit { &unlit[..] } else { &INSTANCE[..] };
        let mut buffers = vec![
            buffer(instance, INSTANCE_BYTES, wgpu::VertexStepMode::Instance),
            buffer(&POSITION, 12, wgpu::VertexStepMode::Vertex),
        ];
        match key.stage {
            Stage::Unlit => {}
            Stage::Flat => buffers.push(buffer(&FACE, 24, wgpu::VertexStepMode::Vertex)),
            _ => buffers.push(buffer(&NORMAL, 12, wgpu::VertexStepMode::Vertex)),
        }
        let (vertex, fragment) = entry_points(key);
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&key.to_string()),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex),
                compilation_options: compilation_options.clone(),
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
            multisample: wgpu::MultisampleState { count: key.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options,
                targets: &[Some(wgpu::ColorTargetState {
                    format: key.format,
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

fn entry_points(key: PipelineKey) -> (&'static str, &'static str) {
    match (key.stage, key.cull) {
        (Stage::Unlit, Cull::Back) => ("vs_unlit", "fs_unlit"),
        (Stage::Unlit, _) => ("vs_unlit", "fs_unlit_both"),
        (Stage::Flat, _) => ("vs_flat", "fs_flat"),
        (Stage::Vertex, Cull::Back) => ("vs_gouraud", "fs_gouraud"),
        (Stage::Vertex, _) => ("vs_gouraud_both", "fs_gouraud_both"),
        (Stage::Fragment, _) => ("vs_phong", "fs_phong"),
        (Stage::Mixed, _) => ("vs_mixed", "fs_mixed"),
    }
}

fn constants(key: PipelineKey) -> Vec<(&'static str, f64)> {
    let ([directional, points, spots], highlights, listed) = match key.lists {
        Lists::Counted(counts, highlights) => (counts, highlights, false),
        Lists::Listed => ([0; 3], Highlights::All, true),
    };
    let flag = |on: bool| f64::from(u8::from(on));
    vec![
        ("VERTEX_DIFFUSE", flag(key.vertex.diffuse)),
        ("VERTEX_SPECULAR", flag(key.vertex.specular)),
        ("FRAGMENT_DIFFUSE", flag(key.fragment.diffuse)),
        ("FRAGMENT_SPECULAR", flag(key.fragment.specular)),
        ("BLINN_PHONG", flag(key.blinn_phong)),
        ("LOCAL_VIEWER", flag(key.local_viewer)),
        ("ATTENUATED_AMBIENT", flag(key.attenuated_ambient)),
        ("SHARED_COLOUR", flag(key.shared_colour)),
        ("RANGED", flag(key.ranged)),
        ("SQUARINGS", key.squarings.map_or(-1.0, f64::from)),
        ("TWO_SIDED", flag(key.cull != Cull::Back)),
        ("BLEND", flag(key.blend)),
        ("GEOMETRIC_FALLBACK", flag(key.geometric_fallback)),
        ("PER_INSTANCE", flag(key.per_instance)),
        ("LISTED", flag(listed)),
        ("DIRECTIONAL", directional.into()),
        ("POINTS", points.into()),
        ("SPOTS", spots.into()),
        ("HIGHLIGHTS", highlights.halves().into()),
    ]
}

//! A pipeline: its small key, and what is built from it.

use crate::batch::terms::TermMask;
use crate::device::gpu::Gpu;
use crate::shaders::light_slots::{COUNTED_LIGHTS, Highlights, Lists};
use crate::shaders::records::INSTANCE_BYTES;
use crate::shaders::text::{Shader, Text};
use crate::target::frame::DEPTH_FORMAT;
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
    /// The shader writes the sRGB curve; see [`Frame::encoded`](crate::target::frame::Frame::encoded).
    pub(crate) encoded: bool,
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
            (self.encoded, "encoded"),
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

    /// Whether it knows anything that its generic one does not.
    pub(crate) fn is_special(self) -> bool {
        self != self.generic()
    }

    /// The generic pipelines that draw the same object under every shading and reflectance, this one's own among them.
    pub(crate) fn relatives(self) -> impl Iterator<Item = Self> {
        let none = TermMask::default();
        let terms = TermMask {
            diffuse: self.vertex.diffuse || self.fragment.diffuse,
            specular: self.vertex.specular || self.fragment.specular,
        };
        let shadings = [(Stage::Flat, terms, none), (Stage::Vertex, terms, none), (Stage::Fragment, none, terms)];
        let lit = shadings.into_iter().filter(move |_| !terms.is_empty()).flat_map(move |(stage, vertex, fragment)| {
            [self.blinn_phong, self.blinn_phong ^ terms.specular].map(|blinn_phong| Self {
                stage,
                vertex,
                fragment,
                blinn_phong,
                ..self
            })
        });
        std::iter::once(self).chain(lit).map(Self::generic)
    }

    /// The one whose instances look up their records.
    pub(crate) fn looking_up(self) -> Self {
        Self { per_instance: true, ..self }
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

pub(crate) const INSTANCE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 9 => Uint32];
const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![6 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![7 => Float32x3];
const FACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![7 => Float32x3, 8 => Float32x3];

impl Shader {
    pub(crate) fn build(&self, gpu: &Gpu, key: PipelineKey) -> wgpu::RenderPipeline {
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
        (Stage::Unlit, _) => ("vs_unlit_both", "fs_unlit_both"),
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
        ("SHARED_COLOR", flag(key.shared_colour)),
        ("SPECULAR", flag(key.vertex.specular || key.fragment.specular)),
        ("RANGED", flag(key.ranged)),
        ("SQUARINGS", key.squarings.map_or(-1.0, f64::from)),
        ("TWO_SIDED", flag(key.cull != Cull::Back)),
        ("BLEND", flag(key.blend)),
        ("ENCODED", flag(key.encoded)),
        ("GEOMETRIC_FALLBACK", flag(key.geometric_fallback)),
        ("PER_INSTANCE", flag(key.per_instance)),
        ("LISTED", flag(listed)),
        ("DIRECTIONAL", directional.into()),
        ("POINTS", points.into()),
        ("SPOTS", spots.into()),
        ("HIGHLIGHTS", highlights.halves().into()),
    ]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A pipeline for one point light, with both terms at the fragments.
    pub(crate) fn key() -> PipelineKey {
        let both = TermMask { diffuse: true, specular: true };
        PipelineKey {
            blend: false,
            stage: Stage::Fragment,
            lists: Lists::Counted([0, 1, 0], Highlights::All),
            vertex: TermMask::default(),
            fragment: both,
            per_instance: false,
            blinn_phong: true,
            local_viewer: true,
            attenuated_ambient: false,
            shared_colour: false,
            ranged: false,
            squarings: None,
            geometric_fallback: false,
            cull: Cull::Back,
            clockwise: false,
            samples: 1,
            format: wgpu::TextureFormat::Rgba8Unorm,
            encoded: false,
        }
    }

    #[test]
    fn relatives_are_generic_and_every_shading_is_among_them() {
        let relatives: std::collections::HashSet<_> = key().relatives().collect();
        assert_eq!(relatives.len(), 6, "three shadings by two reflectances");
        assert!(relatives.contains(&key().generic()) && !relatives.contains(&key()));
        assert!(relatives.iter().all(|relative| !relative.is_special()));
        let diffuse = PipelineKey { fragment: TermMask { diffuse: true, specular: false }, ..key() };
        assert_eq!(diffuse.relatives().collect::<std::collections::HashSet<_>>().len(), 3);
        let unlit = PipelineKey { stage: Stage::Unlit, fragment: TermMask::default(), ..key() };
        assert!(unlit.relatives().eq([unlit.generic()]));
    }
}

//! The lighting text with its bindings, and what goes with them.

use crate::gpu::Gpu;
use crate::lights::LightRecord;
use crate::records::RECORD_BYTES;
use std::sync::OnceLock;

/// Up to this many lights in a scene are all shaded everywhere; of more, each patch has those that it needs.
pub(crate) const COUNTED_LIGHTS: u32 = 8;

/// How the lights reach the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Lists {
    /// So many directional, point and spot lights are bound, in this order, and so many of them have highlights.
    Counted([u8; 3], Highlights),
    /// All are bound, and the record's lists name some.
    Listed,
}

/// How many of the lights that are bound have specular terms: the first of each kind. Few choices, since each makes
/// pipelines of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Highlights {
    None,
    /// Of an odd number the smaller half.
    Half,
    All,
}

impl Lists {
    /// For a scene of so many lights.
    pub(crate) fn new(counts: [u32; 3]) -> Self {
        if counts.iter().sum::<u32>() <= COUNTED_LIGHTS { Self::counted(counts, Highlights::All) } else { Self::Listed }
    }

    pub(crate) fn counted(counts: [u32; 3], highlights: Highlights) -> Self {
        Self::Counted(counts.map(|n| n as u8), highlights)
    }
}

impl Highlights {
    /// The fewest that are at least `needed` of `counts` lights of each kind.
    pub(crate) fn at_least(needed: [u32; 3], counts: [u32; 3]) -> Self {
        let suffice = |share: &Self| needed.into_iter().zip(counts).all(|(needed, count)| needed <= share.of(count));
        [Self::None, Self::Half].into_iter().find(suffice).unwrap_or(Self::All)
    }

    /// How many of `count` lights of one kind.
    pub(crate) fn of(self, count: u32) -> u32 {
        self.halves() * count / 2
    }

    /// How many halves of each kind.
    pub(crate) fn halves(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Half => 1,
            Self::All => 2,
        }
    }
}

/// How the text reads records and lights. Each is a text of its own, since a driver spends time and memory on what a
/// pipeline leaves unused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Text {
    /// From uniform buffers, up to [`COUNTED_LIGHTS`].
    Few,
    /// From uniform buffers, up to [`BOUND_LIGHTS`].
    Many,
    /// From storage, any number.
    Listed,
}

/// The lighting text, and the layout that goes with it.
pub(crate) struct Shader {
    pub(crate) module: wgpu::ShaderModule,
    pub(crate) bindings: wgpu::BindGroupLayout,
    pub(crate) layout: wgpu::PipelineLayout,
}

/// The texts, each made when a pipeline first needs it, on whichever thread that is.
#[derive(Default)]
pub(crate) struct Shaders([OnceLock<Shader>; 3]);

impl Shaders {
    pub(crate) fn get(&self, text: Text) -> Option<&Shader> {
        self.0[text as usize].get()
    }

    pub(crate) fn get_or_make(&self, gpu: &Gpu, text: Text) -> &Shader {
        self.0[text as usize].get_or_init(|| Shader::new(gpu, text))
    }
}

/// The bytes of lights at fixed places.
pub(crate) const BOUND_LIGHT_BYTES: u64 = BOUND_LIGHTS as u64 * size_of::<LightRecord>() as u64;

/// Loops over the lights of one kind from `first` on, `length` at a time.
fn loops(first: &str, count: &str, most: u32, length: u32, cone: bool) -> String {
    let one = |start: u32| {
        let end = start + length;
        format!(
            "    for (var i = {first} + {start}u; i < {first} + min({count}, {end}u); i++) {{\n        \
             sum = add_finite_light(sum, lights[i], {cone}, p, n, v, shininess, of_first(terms, i - ({first}), {count}));\n    }}\n"
        )
    };
    (0..most).step_by(length as usize).map(one).collect()
}

/// The numbers of directional, point and spot lights that have pipelines of their own where patches are lit by few of many lights.
/// A patch with other numbers is filled up with black ones; one with more reads lists.
const STEPS: [&[u32]; 3] = [&[0, 1, 2, 4, 8], &[0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32], &[0, 1, 2, 4, 8, 16]];

/// The numbers of lights of each kind to fill `counts` up to; `None` where they are too many.
pub(crate) fn filled_up(counts: [u32; 3]) -> Option<[u32; 3]> {
    let mut filled = [0; 3];
    for ((filled, steps), count) in filled.iter_mut().zip(STEPS).zip(counts) {
        *filled = *steps.iter().find(|&&step| step >= count)?;
    }
    Some(filled)
}

/// The most lights that are bound at fixed places.
pub(crate) const BOUND_LIGHTS: u32 = 8 + 32 + 16;

impl Text {
    /// The whole of it.
    fn wgsl(self) -> String {
        let text = concat!(include_str!("shader/mesh.wgsl"), include_str!("shader/lighting.wgsl"));
        let at_fixed_places = |points, spots| {
            include_str!("shader/uniform.wgsl")
                .replace("MOST_LIGHTS", &BOUND_LIGHTS.to_string())
                .replace("POINT_LOOPS", &loops("DIRECTIONAL", "POINTS", points, 4, false))
                .replace("SPOT_LOOPS", &loops("DIRECTIONAL + POINTS", "SPOTS", spots, 4, true))
        };
        let bindings = match self {
            Self::Few => at_fixed_places(COUNTED_LIGHTS, COUNTED_LIGHTS),
            Self::Many => at_fixed_places(32, 16),
            Self::Listed => include_str!("shader/storage.wgsl").to_owned(),
        };
        format!("{text}{bindings}")
    }
}

impl Shader {
    fn new(gpu: &Gpu, text: Text) -> Self {
        let storage = text == Text::Listed;
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("lighting"),
            source: wgpu::ShaderSource::Wgsl(text.wgsl().into()),
        });
        let entry = |binding, ty, size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: binding == 1 || binding == 2 && !storage,
                min_binding_size: std::num::NonZeroU64::new(size),
            },
            count: None,
        };
        let uniform = wgpu::BufferBindingType::Uniform;
        let read = wgpu::BufferBindingType::Storage { read_only: true };
        let entries = if storage {
            vec![entry(1, read, RECORD_BYTES), entry(2, read, size_of::<LightRecord>() as u64), entry(3, read, 4)]
        } else {
            vec![entry(1, uniform, RECORD_BYTES), entry(2, uniform, BOUND_LIGHT_BYTES)]
        };
        let bindings = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("draw"),
            entries: &[vec![entry(0, uniform, 16)], entries].concat(),
        });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("draw"),
            bind_group_layouts: &[Some(&bindings)],
            ..Default::default()
        });
        Self { module, bindings, layout }
    }
}

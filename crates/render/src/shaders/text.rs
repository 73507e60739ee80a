//! The lighting text with its bindings, and what goes with them.

use crate::device::gpu::Gpu;
use crate::lights::gather::LightRecord;
use crate::shaders::light_slots::{BOUND_LIGHTS, COUNTED_LIGHTS};
use crate::shaders::records::RECORD_BYTES;
use std::sync::OnceLock;

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

impl Text {
    /// The whole of it.
    fn wgsl(self) -> String {
        let text = concat!(include_str!("mesh.wgsl"), include_str!("lighting.wgsl"));
        let at_fixed_places = |points, spots| {
            include_str!("uniform.wgsl")
                .replace("MOST_LIGHTS", &BOUND_LIGHTS.to_string())
                .replace("POINT_LOOPS", &loops("DIRECTIONAL", "POINTS", points, 4, false))
                .replace("SPOT_LOOPS", &loops("DIRECTIONAL + POINTS", "SPOTS", spots, 4, true))
        };
        let bindings = match self {
            Self::Few => at_fixed_places(COUNTED_LIGHTS, COUNTED_LIGHTS),
            Self::Many => at_fixed_places(32, 16),
            Self::Listed => include_str!("storage.wgsl").to_owned(),
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

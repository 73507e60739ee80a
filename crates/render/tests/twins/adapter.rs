//! Calls of WGSL functions on the adapter: a compute shader over a table of inputs.

use halfway_render::{Gpu, wgpu};

/// Floats of one input, and of one result.
pub(crate) const INPUT: usize = 40;
pub(crate) const RESULT: usize = 9;

/// The functions by which a row's call reads its arguments, and the shader around the call. `i` is the number of the
/// input.
const AROUND: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<array<f32, 40>>;
@group(0) @binding(1) var<storage, read_write> results: array<array<f32, 9>>;

fn s(i: u32, k: u32) -> f32 {
    return inputs[i][k];
}

fn v(i: u32, k: u32) -> vec3f {
    return vec3f(s(i, k), s(i, k + 1), s(i, k + 2));
}

fn light(i: u32, k: u32) -> Light {
    return Light(
        v(i, k), s(i, k + 3), v(i, k + 4), s(i, k + 7), v(i, k + 8), s(i, k + 11), v(i, k + 12), s(i, k + 15),
        v(i, k + 16), s(i, k + 19), s(i, k + 20), s(i, k + 21), s(i, k + 22), 0u,
    );
}

// A material of this shininess.
fn glossy(shininess: f32) -> Material {
    var result = Material();
    result.shininess = shininess;
    return result;
}

// The same light of the kind of this number.
fn of_kind(kind: u32, i: u32, k: u32) -> Light {
    var result = light(i, k);
    result.kind = kind;
    return result;
}

@compute @workgroup_size(64)
fn call(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= arrayLength(&inputs) {
        return;
    }
    let r = CALL;
    results[i] = array<f32, 9>(PARTS);
}
";

/// The type of a function's result.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Scalar,
    Pair,
    Vector,
    Texel,
    /// A vector of three times the same.
    Repeated,
    Incidence,
    Irradiance,
}

impl Kind {
    fn parts(self) -> &'static [&'static str] {
        match self {
            Self::Scalar => &["r"],
            Self::Repeated => &["r.x"],
            Self::Pair => &["r.x", "r.y"],
            Self::Vector => &["r.x", "r.y", "r.z"],
            Self::Texel => &["r.x", "r.y", "r.z", "r.w"],
            Self::Incidence => &["r.l.x", "r.l.y", "r.l.z", "r.grazing", "r.weight"],
            Self::Irradiance => &[
                "r.ambient.x",
                "r.ambient.y",
                "r.ambient.z",
                "r.diffuse.x",
                "r.diffuse.y",
                "r.diffuse.z",
                "r.specular.x",
                "r.specular.y",
                "r.specular.z",
            ],
        }
    }
}

/// The resources of a text's group 1.
pub(crate) struct Bound {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) group: wgpu::BindGroup,
}

/// The results of `call` for each input, with `lighting` as the text and these values of its overrides.
pub(crate) fn results(
    gpu: &Gpu,
    lighting: &str,
    called: (&str, Kind),
    constants: &[(&str, f64)],
    inputs: &[[f32; INPUT]],
) -> Vec<[f32; RESULT]> {
    results_with(gpu, (lighting, None), called, constants, inputs)
}

/// The layout of the inputs and the results.
fn numbers_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, read_only| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries = [entry(0, true), entry(1, false)];
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// The same of a text that may read something in its group 1.
pub(crate) fn results_with(
    gpu: &Gpu,
    (lighting, bound): (&str, Option<&Bound>),
    (call, kind): (&str, Kind),
    constants: &[(&str, f64)],
    inputs: &[[f32; INPUT]],
) -> Vec<[f32; RESULT]> {
    let device = &gpu.device;
    let mut parts = kind.parts().to_vec();
    parts.resize(RESULT, "0.0");
    let text = AROUND.replace("CALL", call).replace("PARTS", &parts.join(", "));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(call),
        source: wgpu::ShaderSource::Wgsl(format!("{lighting}{text}").into()),
    });
    let numbers = numbers_layout(device);
    let both = [Some(&numbers), bound.map(|bound| &bound.layout)];
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(call),
        bind_group_layouts: if bound.is_some() { &both } else { &both[..1] },
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(call),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("call"),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    });
    let buffer = |size: usize, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size as u64,
            usage,
            mapped_at_creation: false,
        })
    };
    let bytes: &[u8] = bytemuck::cast_slice(inputs.as_flattened());
    let size = 4 * RESULT * inputs.len();
    let given = buffer(bytes.len(), wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
    let made = buffer(size, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(size, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    gpu.queue.write_buffer(&given, 0, bytes);
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &numbers,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: given.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: made.as_entire_binding() },
        ],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        if let Some(bound) = bound {
            pass.set_bind_group(1, &bound.group, &[]);
        }
        pass.dispatch_workgroups(inputs.len().div_ceil(64) as u32, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&made, 0, &read, 0, size as u64);
    gpu.queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the results can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter finishes");
    let mapped = read.slice(..).get_mapped_range().expect("the results are mapped");
    let floats: Vec<f32> = bytemuck::cast_slice(&mapped).to_vec();
    floats.as_chunks().0.to_vec()
}

//! `coordinates` of maps.wgsl, which takes derivatives and so is called by fragments alone.
//!
//! The twin is the rule of quotients: with at/w and 1/w planes l and m over the picture, at is l/m, and changes along x
//! by (lₓ − at·mₓ)/m from a pixel to the next.

use halfway_render::{Gpu, wgpu};

use crate::map_rows::ULP;

pub(crate) const FUNCTION: &str = "coordinates";

/// Pixels along each side of the picture.
const SIDE: u32 = 16;

/// Planes over the picture, each as its value in the middle and how it changes along x and along y: 1/w, and of each of
/// four coordinates that over w.
type Planes = ([f32; 3], [[f32; 3]; 4]);

const CASES: [Planes; 4] = [
    // Seen from in front.
    ([0.5, 0.0, 0.0], [[0.3, 0.01, 0.0], [0.2, 0.0, 0.02], [0.3, 0.01, -0.01], [-4.0, 0.5, 0.25]]),
    // Tilted.
    ([0.5, 0.02, -0.015], [[0.3, 0.01, 0.0], [0.2, 0.0, 0.02], [0.3, 0.03, -0.01], [-4.0, 0.5, 0.25]]),
    // The same coordinate everywhere, and one that only the tilt changes.
    ([0.25, 0.01, 0.01], [[0.25, 0.01, 0.01], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.125, 0.0]]),
    // Far away, and far out on the image.
    ([1e-4, 1e-6, 2e-6], [[0.1, 1e-3, 2e-3], [1e-5, 1e-6, 0.0], [1e-3, 0.0, 1e-4], [-0.2, 2e-4, 0.0]]),
];

/// The shader around the call. The coordinates at the centroid differ from those at the center.
const AROUND: &str = "
@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4f {
    return vec4f(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

fn plane(p: vec2f, abc: vec3f) -> f32 {
    return abc.x + abc.y * p.x + abc.z * p.y;
}

@fragment
fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let p = position.xy - MIDDLE;
    let w = 1.0 / plane(p, OVER_W);
    let at = vec4f(PLANES) * w;
    return coordinates(vec4f(p, 5.0, 6.0), at, w).PART;
}
";

fn text((over_w, planes): &Planes, part: &str) -> String {
    let vector = |[a, b, c]: [f32; 3]| format!("vec3f({a:?}, {b:?}, {c:?})");
    let planes = planes.map(|plane| format!("plane(p, {})", vector(plane))).join(", ");
    let middle = format!("{:?}", SIDE as f32 / 2.0);
    let around = AROUND.replace("MIDDLE", &middle).replace("OVER_W", &vector(*over_w));
    around.replace("PLANES", &planes).replace("PART", part)
}

/// A part of `Coordinates` at each pixel, row by row.
fn drawn(gpu: &Gpu, text: &str) -> Vec<[f32; 4]> {
    let device = &gpu.device;
    let format = wgpu::TextureFormat::Rgba32Float;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(FUNCTION),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(FUNCTION),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let size = wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 };
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(FUNCTION),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let read = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(FUNCTION),
        size: u64::from(16 * SIDE * SIDE),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(FUNCTION),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
    }
    // A row has 256 bytes, as copies ask for.
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * SIDE), rows_per_image: None };
    encoder.copy_texture_to_buffer(target.as_image_copy(), wgpu::TexelCopyBufferInfo { buffer: &read, layout }, size);
    gpu.queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the picture can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter finishes");
    let mapped = read.slice(..).get_mapped_range().expect("the picture is mapped");
    bytemuck::cast_slice(&mapped).to_vec()
}

fn at(plane: [f32; 3], p: [f64; 2]) -> f64 {
    let [a, b, c] = plane.map(f64::from);
    a + b * p[0] + c * p[1]
}

/// The largest that the parts of a plane sum up to in the picture.
fn gross(plane: [f32; 3]) -> f64 {
    let [a, b, c] = plane.map(|x| f64::from(x).abs());
    a + f64::from(SIDE / 2) * (b + c)
}

/// The expected value of coordinate k along an axis at a pixel, and the allowed distance from it.
///
/// The planes are sums of three, off by 3 ULP; at/w and 1/w by 8, with both divisions and the product; the difference
/// of two pixels by 16, and with the product and the difference by 24. That counts over 1/w, which itself is known to 6
/// ULP of its parts.
fn expected((over_w, planes): &Planes, k: usize, axis: usize, p: [f64; 2]) -> (f64, f64) {
    let (m, l) = (at(*over_w, p), at(planes[k], p));
    let value = (f64::from(planes[k][axis + 1]) - l / m * f64::from(over_w[axis + 1])) / m;
    let sums = gross(planes[k]) + (l / m).abs() * gross(*over_w);
    (value, 32.0 * ULP * sums / m * (gross(*over_w) / m))
}

/// A description of the first number that is too far from its twin.
pub(crate) fn too_far(gpu: &Gpu, maps: &str) -> Option<String> {
    CASES.iter().find_map(|planes| ["uv", "dx", "dy"].into_iter().find_map(|part| of_part(gpu, maps, planes, part)))
}

fn of_part(gpu: &Gpu, maps: &str, planes: &Planes, part: &str) -> Option<String> {
    let drawn = drawn(gpu, &format!("{maps}{}", text(planes, part)));
    drawn.iter().enumerate().find_map(|(number, found)| {
        let [column, row] = [number as u32 % SIDE, number as u32 / SIDE];
        let p = [column, row].map(|x| f64::from(x) + 0.5 - f64::from(SIDE / 2));
        (0..4).find_map(|k| {
            let (expected, allowed) = match part {
                "uv" => ([p[0], p[1], 5.0, 6.0][k], 0.0),
                "dx" => expected(planes, k, 0, p),
                _ => expected(planes, k, 1, p),
            };
            let found = f64::from(found[k]);
            // A result that is not a number is too far.
            let near = (found - expected).abs() <= allowed;
            (!near).then(|| {
                format!(
                    "{part} of coordinate {k} at {p:?}: {found:e}, twin {expected:e} ± {allowed:.1e}, of {planes:?}"
                )
            })
        })
    })
}

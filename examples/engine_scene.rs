//! A lit teapot in a scene that another engine draws: on its device, into its texture, among its depth.
//!
//! The engine draws a ring of pillars by a shader of its own. halfway draws over it with `Load::Keep` and the engine's
//! depth, so that the pillars before the teapot hide it, and it hides those behind.
//!
//! ```text
//! cargo run --release --example engine_scene
//! cargo run --release --example engine_scene -- --headless engine_scene.png --size 640x360
//! ```

use std::error::Error;

use halfway::prelude::*;
use halfway::record::parse_size;
use halfway::render::{AdapterChoice, Gpu, Load, TextureTarget, encode_frame, wgpu};

const FIELD_OF_VIEW: f32 = 0.7;
const NEAR: f32 = 0.1;
const EYE: Vec3 = Vec3::new(0.0, 4.5, 7.5);
const AT: Vec3 = Vec3::new(0.0, 0.8, 0.0);
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

fn main() -> Result<(), Box<dyn Error>> {
    let argument = |name: &str| std::env::args().skip_while(|argument| argument != name).nth(1);
    let file = argument("--headless").unwrap_or("engine_scene.png".into());
    let size = argument("--size").map_or(Ok(UVec2::new(640, 360)), |size| parse_size(&size))?;
    // It stands for the device that an engine has opened.
    let Gpu { device, queue, .. } = AdapterChoice::default().open_gpu()?;
    let engine = Engine::new(device, queue, size);

    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size)).add_systems(Startup, scene);
    app.insert_resource(Gpu::from_device(engine.device.clone(), engine.queue.clone()));
    app.insert_resource(TextureTarget {
        load: Load::Keep,
        depth: Some(view(&engine.depth)),
        ..TextureTarget::new(view(&engine.color), FORMAT, size)
    });

    app.update();
    let mut encoder = engine.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    engine.draw(&mut encoder);
    encode_frame(app.world(), &mut encoder)?;
    engine.read(encoder)?.save(&file)?;
    println!("{file}");
    Ok(())
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let projection = Projection::perspective(FIELD_OF_VIEW).with_near(NEAR);
    let camera = Camera { projection, ..Camera::default() };
    commands.spawn((camera, Transform::from_translation(EYE).looking_at(AT, Vec3::Y)));
    commands.spawn((Mesh3d(meshes.add(Teapot::new(16))), Material::BRASS, Shading::Phong));
    commands.spawn((PointLight::white(), Transform::from_xyz(2.0, 5.0, 3.0)));
}

/// An engine with a device, the textures of its picture, and one draw.
struct Engine {
    device: wgpu::Device,
    queue: wgpu::Queue,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    pillars: wgpu::RenderPipeline,
    clip_from_world: wgpu::BindGroup,
}

/// Twelve pillars of two triangles a side.
const SHADER: &str = "
    struct Pillar { @builtin(position) position: vec4f, @location(0) color: vec3f }

    @group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

    @vertex fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> Pillar {
        let corner = array(vec2u(0, 0), vec2u(1, 0), vec2u(1, 1), vec2u(0, 0), vec2u(1, 1), vec2u(0, 1))[i % 6u];
        let side = f32(i / 6u + corner.x) * 1.5707964 + 0.7853982;
        let around = f32(number) * 0.5235988;
        let foot = 2.6 * vec2f(cos(around), sin(around)) + 0.25 * vec2f(cos(side), sin(side));
        let shade = 0.25 + 0.15 * f32(i / 6u);
        return Pillar(
            clip_from_world * vec4f(foot.x, 1.9 * f32(corner.y) - 0.4, foot.y, 1.0),
            shade * vec3f(0.5, 0.7, 1.0),
        );
    }

    @fragment fn fragment(pillar: Pillar) -> @location(0) vec4f {
        return vec4f(pillar.color, 1.0);
    }
";

impl Engine {
    fn new(device: wgpu::Device, queue: wgpu::Queue, size: UVec2) -> Self {
        let texture = |label, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let color = texture("color", FORMAT, attachment | wgpu::TextureUsages::COPY_SRC);
        let depth = texture("depth", wgpu::TextureFormat::Depth32Float, attachment);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("pillars"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pillars = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("pillars"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: depth.format(),
                depth_write_enabled: Some(true),
                // Reversed depth, as halfway has it: nearer is greater.
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        // The same camera as halfway's, with the same near plane: depth is near over distance.
        let lens = Projection::perspective(FIELD_OF_VIEW).with_near(NEAR).lens(size.to_array());
        let clip_from_eye = Mat4::from_cols_array_2d(&lens.matrix());
        let world_from_eye = Transform::from_translation(EYE).looking_at(AT, Vec3::Y).to_matrix();
        let matrix = clip_from_eye * world_from_eye.inverse();
        let bytes: Vec<u8> = matrix.to_cols_array().into_iter().flat_map(f32::to_ne_bytes).collect();
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("clip from world"),
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&uniform, 0, &bytes);
        let clip_from_world = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("clip from world"),
            layout: &pillars.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        Self { device, queue, color, depth, pillars, clip_from_world }
    }

    /// Its own part of the frame.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        let (color, depth) = (view(&self.color), view(&self.depth));
        let sky = wgpu::Color { r: 0.05, g: 0.07, b: 0.1, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("engine"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(sky), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pillars);
        pass.set_bind_group(0, &self.clip_from_world, &[]);
        pass.draw(0..24, 0..12);
    }

    /// Submits the frame, and waits for its picture.
    fn read(&self, mut encoder: wgpu::CommandEncoder) -> Result<Picture, Box<dyn Error>> {
        let (width, height) = (self.color.width(), self.color.height());
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.color.as_image_copy(), to, self.color.size());
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let mapped = buffer.get_mapped_range(..)?;
        let bytes = mapped.chunks_exact(row as usize).flat_map(|row| &row[..4 * width as usize]).copied().collect();
        let image = image::RgbaImage::from_raw(width, height, bytes).ok_or("the picture has too few bytes")?;
        Ok(Picture::Byte(image))
    }
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

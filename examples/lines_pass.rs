//! A custom pass: draws the axes as lines through the scene, which hides the parts behind it.
//!
//! ```text
//! cargo run --release --example lines_pass
//! cargo run --release --example lines_pass -- --headless lines_pass.png --size 640x360
//! ```

use halfway::prelude::*;
use halfway::render::{AddOverPass, OverPass, OverTarget, OverView, PassCounts, wgpu};
use std::error::Error;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_over_pass(Axes::default()).add_systems(Startup, scene).run()
}

/// X in red, Y in green, Z in blue, three units to either side of the origin.
#[derive(Default)]
struct Axes(Option<Made>);

/// The pipeline of the lines, and the attachments that it fits.
struct Made {
    target: OverTarget,
    pipeline: wgpu::RenderPipeline,
    clip_from_world: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

const SHADER: &str = "
    struct Line { @builtin(position) position: vec4f, @location(0) color: vec3f }

    @group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

    @vertex fn vertex(@builtin(vertex_index) i: u32) -> Line {
        var axis = vec3f(0.0);
        axis[i / 2u] = 1.0;
        let end = select(3.0, -3.0, i % 2u == 0u);
        return Line(clip_from_world * vec4f(end * axis, 1.0), axis);
    }

    // Channels of 0 and 1 are the same in sRGB and linear.
    @fragment fn fragment(line: Line) -> @location(0) vec4f {
        return vec4f(line.color, 1.0);
    }
";

impl OverPass for Axes {
    fn name(&self) -> &'static str {
        "axes"
    }

    fn prepare(&mut self, view: &OverView<'_>, _: &World) -> Result<PassCounts, Box<dyn Error>> {
        let made = match self.0.take() {
            Some(made) if made.target == view.target => made,
            _ => Made::new(view),
        };
        let matrix: Vec<u8> = view.clip_from_world.to_cols_array().into_iter().flat_map(f32::to_ne_bytes).collect();
        view.queue.write_buffer(&made.clip_from_world, 0, &matrix);
        self.0 = Some(made);
        Ok(PassCounts { draws: 1, triangles: 0 })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(made) = &self.0 else { return };
        pass.set_pipeline(&made.pipeline);
        pass.set_bind_group(0, &made.bindings, &[]);
        pass.draw(0..6, 0..1);
    }
}

impl Made {
    fn new(view: &OverView<'_>) -> Self {
        let (device, target) = (view.device, view.target);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("axes"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("axes"),
            // Derived from the shader's bindings.
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::LineList,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: target.depth_format,
                depth_write_enabled: Some(true),
                // Depth is reversed: nearer is greater.
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: target.samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(target.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let clip_from_world = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("axes"),
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("axes"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: clip_from_world.as_entire_binding() }],
        });
        Self { target, pipeline, clip_from_world, bindings }
    }
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    commands.spawn((Mesh3d(meshes.add(Teapot::new(12))), Material::BRASS, Transform::from_xyz(0.0, -0.7, 0.0)));
    commands.spawn((PointLight::white(), Transform::from_xyz(2.0, 3.0, 4.0)));
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::default() },
        Transform::from_xyz(3.0, 2.2, 5.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

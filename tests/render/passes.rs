//! The list of passes: the report's row for each, and custom passes of an App.

use crate::render::conformance::environment::around;
use crate::render::scene::{Around, Scene, Thing, glowing, material};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::render::{AddOverPass, OverPass, OverTarget, OverView, Pass, PassCounts, Phase, RenderError, wgpu};
use std::error::Error;

fn passes(stage: &Stage) -> Vec<(Phase, u32, u64)> {
    let of = |pass: &Pass| (pass.phase, pass.counts.draws, pass.counts.triangles);
    stage.report().passes.iter().map(of).collect()
}

/// A square three units away that fills the middle of the picture.
fn square() -> Scene {
    Scene::in_eye_space().with(Thing::square(Vec3::Z * -3.0, Vec3::Z, 1.0).with_material(glowing(1.0, 0.5, 0.25)))
}

#[test]
fn the_report_has_a_row_for_each_pass_that_draws() {
    let mut stage = Stage::new(24, 16);
    let mut scene = Scene::in_eye_space();
    stage.draw_bytes(&scene);
    assert_eq!(passes(&stage), []);
    scene =
        scene.with(Thing::new(Cuboid::default()).at(Transform::from_xyz(-1.0, 0.0, -5.0)).with_material(material()));
    stage.draw_bytes(&scene);
    assert_eq!(passes(&stage), [(Phase::Opaque, 1, 12)]);
    scene = scene.with(Thing::new(UvSphere::new(0.5, 8, 4)).at(Transform::from_xyz(1.0, 0.0, -5.0)).blended(0.5));
    scene.environment = Some(Around { sky: true, ..around(1.0) });
    scene.camera.intensity = Intensity::Aces;
    stage.draw_bytes(&scene);
    let [sky, opaque, blended, policy] = passes(&stage)[..] else { panic!("{:?}", passes(&stage)) };
    assert_eq!([sky, opaque, policy], [(Phase::Sky, 1, 0), (Phase::Opaque, 1, 12), (Phase::Policy, 1, 0)]);
    let report = stage.report();
    assert_eq!(blended, (Phase::Blended, report.draws - 1, report.triangles - 12));
    assert!(blended.1 > 0);
}

/// Fills the picture by green in the plane z = `VeilAt`, where nothing is before it.
#[derive(Default)]
struct Veil(Option<Made>);

#[derive(Resource)]
struct VeilAt(f32);

struct Made {
    target: OverTarget,
    pipeline: wgpu::RenderPipeline,
    place: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

const SHADER: &str = "
    struct Place { clip_from_world: mat4x4f, z: vec4f }
    @group(0) @binding(0) var<uniform> place: Place;

    @vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
        let corner = vec2f(f32(i % 2u), f32(i / 2u)) * 400.0 - 100.0;
        return place.clip_from_world * vec4f(corner, place.z.x, 1.0);
    }

    @fragment fn fragment() -> @location(0) vec4f {
        return vec4f(0.0, 1.0, 0.0, 1.0);
    }
";

impl OverPass for Veil {
    fn name(&self) -> &'static str {
        "veil"
    }

    fn prepare(&mut self, view: &OverView<'_>, world: &World) -> Result<PassCounts, Box<dyn Error>> {
        let VeilAt(z) = *world.get_resource().ok_or("there is no VeilAt")?;
        if z > 0.0 {
            return Ok(PassCounts::default());
        }
        let made = match self.0.take() {
            Some(made) if made.target == view.target => made,
            _ => Made::new(view),
        };
        let matrix = view.clip_from_world.to_cols_array();
        let place: Vec<u8> = matrix.into_iter().chain([z; 4]).flat_map(f32::to_ne_bytes).collect();
        view.queue.write_buffer(&made.place, 0, &place);
        self.0 = Some(made);
        Ok(PassCounts { draws: 1, triangles: 1 })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let made = self.0.as_ref().expect("it draws nothing before it is made ready");
        pass.set_pipeline(&made.pipeline);
        pass.set_bind_group(0, &made.bindings, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Made {
    fn new(view: &OverView<'_>) -> Self {
        let (device, target) = (view.device, view.target);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("veil"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("veil"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: target.depth_format,
                depth_write_enabled: Some(true),
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
        let place = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("veil"),
            size: 80,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("veil"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: place.as_entire_binding() }],
        });
        Self { target, pipeline, place, bindings }
    }
}

/// A stage with the scene and its veil, to be put somewhere; `None` where the CPU draws.
fn veiled(scene: &Scene) -> Option<Stage> {
    let mut stage = Stage::new(24, 16);
    stage.set(scene);
    stage.frame();
    stage.app.add_over_pass(Veil::default());
    (!stage.is_on_cpu()).then_some(stage)
}

/// The pixels in the middle and at a corner.
fn pixels(stage: &mut Stage) -> [[f32; 3]; 2] {
    let picture = stage.float();
    [(12, 8), (0, 0)].map(|(x, y)| {
        let [r, g, b, _] = picture.get_pixel(x, y).0;
        [r, g, b]
    })
}

const SQUARE: [f32; 3] = [1.0, 0.5, 0.25];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];

#[test]
fn an_app_s_pass_draws_over_the_scene_by_its_depth() {
    let Some(mut stage) = veiled(&square()) else { return };
    // Behind the square, before it, and not there.
    for (z, expected) in [(-5.0, [SQUARE, GREEN]), (-1.0, [GREEN, GREEN]), (1.0, [SQUARE, [0.0; 3]])] {
        stage.world().insert_resource(VeilAt(z));
        assert_eq!(pixels(&mut stage), expected, "at {z}");
        let own = passes(&stage).into_iter().find(|(phase, ..)| *phase == Phase::Over);
        assert_eq!(own, (z < 0.0).then_some((Phase::Over, 1, 1)), "at {z}");
    }
    // With another number of samples, and another format.
    stage.world().insert_resource(VeilAt(-5.0));
    let mut scene = square();
    scene.camera.samples = Samples::Four;
    let picture = stage.draw_bytes(&scene);
    assert_eq!((picture.get_pixel(0, 0).0, stage.report().errors.len()), ([0, 255, 0, 255], 0));
}

#[test]
fn a_policy_acts_on_an_app_s_pass() {
    let mut scene =
        Scene::in_eye_space().with(Thing::square(Vec3::Z * -3.0, Vec3::Z, 1.0).with_material(glowing(4.0, 2.0, 1.0)));
    scene.camera.intensity = Intensity::Renormalize { smoothing: 0.0 };
    let Some(mut stage) = veiled(&scene) else { return };
    stage.world().insert_resource(VeilAt(-5.0));
    assert_eq!(pixels(&mut stage), [SQUARE, [0.0, 0.25, 0.0]]);
    let phases: Vec<_> = passes(&stage).into_iter().map(|(phase, ..)| phase).collect();
    assert_eq!(phases, [Phase::Opaque, Phase::Over, Phase::Policy]);
}

#[test]
fn an_app_s_pass_that_fails_is_an_error() {
    let Some(mut stage) = veiled(&square()) else { return };
    let expected = RenderError::Pass { pass: "veil".into(), reason: "there is no VeilAt".into() };
    assert_eq!(stage.frame().errors, std::slice::from_ref(&expected));
    assert_eq!(expected.to_string(), "the pass veil is not drawn: there is no VeilAt");
    stage.world().insert_resource(VeilAt(-5.0));
    assert_eq!(pixels(&mut stage), [SQUARE, GREEN]);
}

#[test]
fn the_cpu_draws_the_scene_without_an_app_s_pass() {
    let mut stage = Stage::on_the_cpu(24, 16);
    stage.app.add_over_pass(Veil::default());
    stage.world().insert_resource(VeilAt(-5.0));
    stage.set(&square());
    assert_eq!(pixels(&mut stage), [SQUARE, [0.0; 3]]);
    assert_eq!((passes(&stage), stage.report().passes_refused), (vec![(Phase::Opaque, 1, 2)], 1));
}

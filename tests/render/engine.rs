//! Frames on an engine's device, with its encoder, into its texture.

use crate::render::compare::assert_identical;
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use bevy_math::URect;
use futures_lite::future::block_on;
use halfway::lighting::CameraTurn;
use halfway::prelude::*;
use halfway::render::{Gpu, GpuTimer, Load, Pixels, RenderError, TextureTarget, encode_frame, wgpu};
#[cfg(target_os = "linux")]
use std::process::Command;
use std::sync::{Arc, Mutex};

const SIZE: UVec2 = UVec2::new(24, 16);

fn scene(lights: u8) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 3.0, 6.0), Vec3::ZERO).ambient(0.1);
    scene.camera.encoding = Encoding::Raw;
    scene = scene
        .with(Thing::new(Plane { size: 9.0, divisions: 64 }).with_material(other_material()))
        .with(Thing::new(UvSphere::new(0.8, 24, 12)).with_material(material()))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(1.5, 0.5, 0.0)).shaded(Shading::Flat))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)));
    for i in 0..lights {
        let at = Vec3::new(2.0 * f32::from(i % 5) - 4.0, 1.0, 2.0 * f32::from(i / 5) - 4.0);
        scene = scene.lit(Lamp::point(PointLight { range: Some(3.0), ..point_light() }, at));
    }
    scene
}

fn with_blended(scene: Scene) -> Scene {
    scene.with(Thing::new(Cuboid::default()).at(Transform::from_xyz(-1.5, 0.5, 1.0)).blended(0.5))
}

/// A device with no optional feature and the smallest limits, as an engine may open it. Errors outside of a call panic.
fn plain_device() -> Gpu {
    let adapter = Gpu::open_headless().expect("an adapter").adapter.expect("a device of its own has one");
    let request = adapter
        .request_device(&wgpu::DeviceDescriptor { required_limits: wgpu::Limits::default(), ..Default::default() });
    let (device, queue) = block_on(request).expect("every adapter has the defaults");
    Gpu::from_device(device, queue)
}

/// A texture of the engine's, in two levels, and the second of these as the target.
fn texture(gpu: &Gpu, format: wgpu::TextureFormat) -> (wgpu::Texture, TextureTarget) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the engine's"),
        size: wgpu::Extent3d { width: 2 * SIZE.x, height: 2 * SIZE.y, depth_or_array_layers: 1 },
        mip_level_count: 2,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        base_mip_level: 1,
        mip_level_count: Some(1),
        ..Default::default()
    });
    (texture, TextureTarget::new(view, format, SIZE))
}

/// The texels of the second level.
fn read(gpu: &Gpu, texture: &wgpu::Texture, mut encoder: wgpu::CommandEncoder) -> Vec<u8> {
    let row = SIZE.x * texture.format().block_copy_size(None).expect("a color");
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(padded * SIZE.y),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { mip_level: 1, ..texture.as_image_copy() },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
        },
        wgpu::Extent3d { width: SIZE.x, height: SIZE.y, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("the buffer can be mapped"));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
    let mapped = buffer.get_mapped_range(..).expect("it is mapped");
    mapped.chunks_exact(padded as usize).flat_map(|bytes| &bytes[..row as usize]).copied().collect()
}

fn encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
}

#[test]
fn a_frame_in_an_engine_s_texture_is_that_of_a_picture() {
    let gpu = plain_device();
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    // Without the clock it has nothing to do.
    stage.world().init_resource::<GpuTimer>();
    let formats =
        [(wgpu::TextureFormat::Rgba8Unorm, Encoding::Raw), (wgpu::TextureFormat::Rgba8UnormSrgb, Encoding::Srgb)];
    for (format, encoding) in formats {
        for (lights, samples) in [(2, Samples::One), (20, Samples::One), (2, Samples::Four)] {
            let mut scene = with_blended(scene(lights));
            (scene.camera.encoding, scene.camera.samples) = (encoding, samples);
            stage.world().remove_resource::<TextureTarget>();
            let picture = stage.draw_bytes(&scene);
            let (texture, target) = texture(&gpu, format);
            stage.world().insert_resource(target);
            assert_eq!(stage.frame().errors, [], "{format:?}");
            let mut encoder = encoder(&gpu);
            encode_frame(stage.app.world(), &mut encoder).expect("a frame");
            let row = format!("{format:?}, {lights} lights, {samples:?}");
            assert!(picture.into_raw() == read(&gpu, &texture, encoder), "{row}: other bytes");
        }
    }
}

#[test]
fn a_plain_device_uses_fallbacks() {
    let gpu = plain_device();
    assert!(gpu.device.features().is_empty() || !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE));
    let mut own = Stage::new(SIZE.x, SIZE.y);
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    // Blending floats of 32 bits takes a feature that the device lacks.
    stage.set(&with_blended(scene(2)));
    let errors = &stage.frame().errors;
    assert!(matches!(errors.as_slice(), [RenderError::FloatTarget { .. }]), "{errors:?}");
    // Without it, and with one sample, they are drawn to the bit.
    assert_identical("opaque", &own.draw(&scene(2)), &stage.draw(&scene(2)));
    // Opaque objects need no blending, so 32 bits suffice for the engine's texture.
    let (texture, target) = texture(&gpu, wgpu::TextureFormat::Rgba32Float);
    stage.world().insert_resource(target);
    stage.set(&scene(2));
    assert_eq!(stage.frame().errors, []);
    let mut encoder = encoder(&gpu);
    encode_frame(stage.app.world(), &mut encoder).expect("a frame");
    let bytes = read(&gpu, &texture, encoder);
    let floats = bytes.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four"))).collect();
    let picture = image::Rgba32FImage::from_raw(SIZE.x, SIZE.y, floats).expect("all texels");
    assert_identical("32 bits", &own.draw(&scene(2)), &picture);
}

#[test]
fn an_unsuitable_texture_is_an_error() {
    use wgpu::TextureFormat::{Depth32Float, Rgba8Unorm, Rgba8UnormSrgb, Rgba16Float, Rgba32Float};
    let gpu = plain_device();
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    let mut encoder = encoder(&gpu);
    stage.set(&scene(1));
    stage.frame();
    assert_eq!(encode_frame(stage.app.world(), &mut encoder), Err(RenderError::NoFrame), "a headless frame");
    let rows = [
        (Rgba8Unorm, Encoding::Raw, Samples::Four, true, None),
        (Rgba8UnormSrgb, Encoding::Raw, Samples::One, false, Some("raw")),
        (Rgba8Unorm, Encoding::Srgb, Samples::One, false, None),
        (Rgba8Unorm, Encoding::Srgb, Samples::One, true, Some("blended, which takes an sRGB format")),
        (Rgba8Unorm, Encoding::Srgb, Samples::Four, false, Some("averaged, which takes an sRGB format")),
        (Rgba8UnormSrgb, Encoding::Srgb, Samples::Four, true, None),
        (Rgba16Float, Encoding::Srgb, Samples::Four, true, None),
        (Rgba32Float, Encoding::Raw, Samples::One, true, Some("blended, which the device cannot")),
        (Rgba32Float, Encoding::Raw, Samples::Four, false, Some("four samples a pixel, which the device cannot")),
        (Depth32Float, Encoding::Raw, Samples::One, false, Some("expected Rgba8Unorm")),
    ];
    for (format, encoding, samples, blends, problem) in rows {
        let row = format!("{format:?}, {encoding:?}, {samples:?}, blended: {blends}");
        let mut scene = if blends { with_blended(scene(1)) } else { scene(1) };
        (scene.camera.encoding, scene.camera.samples) = (encoding, samples);
        stage.set(&scene);
        stage.world().insert_resource(texture(&gpu, format).1);
        let errors = stage.frame().errors.clone();
        let encoded = encode_frame(stage.app.world(), &mut encoder);
        match problem {
            None => assert_eq!((&errors[..], encoded), (&[][..], Ok(())), "{row}"),
            Some(problem) => {
                let [error @ RenderError::BadTarget { reason, .. }] = &errors[..] else { panic!("{row}: {errors:?}") };
                assert!(reason.contains(problem), "{row}: {reason}");
                assert_eq!(encoded, Err(error.clone()), "{row}");
            }
        }
    }
    let (_, target) = texture(&gpu, Rgba8Unorm);
    stage.world().insert_resource(TextureTarget { size: SIZE + 1, ..target });
    assert!(matches!(&stage.frame().errors[..], [RenderError::BadTarget { reason, .. }] if reason.contains("size")));
}

/// A depth texture of the target's size.
fn depth_texture(gpu: &Gpu, format: wgpu::TextureFormat, samples: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the engine's depth"),
        size: wgpu::Extent3d { width: SIZE.x, height: SIZE.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Draws a red triangle over all of a texture, at one depth, where nothing nearer is; on blue where the engine begins.
fn draw_triangle(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    (color, depth): (&wgpu::TextureView, &wgpu::TextureView),
    (at, begins): (f32, bool),
) {
    let text = format!(
        "@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
            return vec4f(4.0 * f32(i & 1u) - 1.0, 4.0 * f32(i >> 1u) - 1.0, {at:?}, 1.0);
        }}
        @fragment fn fragment() -> @location(0) vec4f {{ return vec4f(1.0, 0.0, 0.0, 1.0); }}"
    );
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let color_load = if begins { wgpu::LoadOp::Clear(wgpu::Color::BLUE) } else { wgpu::LoadOp::Load };
    let depth_load = if begins { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: color_load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: depth_load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..3, 0..1);
}

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// A sphere 4 units before the eye.
fn sphere() -> Scene {
    let mut scene = Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO).ambient(0.1);
    scene.camera.encoding = Encoding::Raw;
    scene
        .with(Thing::new(UvSphere::new(1.0, 24, 12)).with_material(material()))
        .lit(Lamp::point(point_light(), Vec3::splat(3.0)))
}

#[test]
fn an_engine_s_triangle_hides_what_is_behind_it_and_is_hidden() {
    let gpu = plain_device();
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    let alone = stage.draw_bytes(&sphere());
    let shows = |pixel: &image::Rgba<u8>| pixel.0 != [0, 0, 0, 255];
    assert!(alone.pixels().filter(|pixel| shows(pixel)).count() > 30);
    let (color, target) = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm);
    let depth = depth_texture(&gpu, wgpu::TextureFormat::Depth32Float, 1);
    let target = TextureTarget { load: Load::Keep, depth: Some(depth.clone()), ..target };
    stage.world().insert_resource(target.clone());
    let near = sphere().camera.projection.near();
    // The distance of the triangle from the eye, whether it is drawn before the frame, and whether it hides the sphere.
    for (distance, before, hides) in [(2.0, true, true), (6.0, true, false), (2.0, false, true), (6.0, false, false)] {
        assert_eq!(stage.frame().errors, []);
        let mut encoder = encoder(&gpu);
        // At depth 0 it is nowhere nearer than what is cleared: the texture becomes blue.
        draw_triangle(&gpu, &mut encoder, (&target.view, &depth), (0.0, true));
        if before {
            draw_triangle(&gpu, &mut encoder, (&target.view, &depth), (near / distance, false));
        }
        encode_frame(stage.app.world(), &mut encoder).expect("a frame");
        if !before {
            draw_triangle(&gpu, &mut encoder, (&target.view, &depth), (near / distance, false));
        }
        let bytes = read(&gpu, &color, encoder);
        for (drawn, alone) in bytes.chunks_exact(4).zip(alone.pixels()) {
            let expected = if hides || !shows(alone) { RED } else { alone.0 };
            assert_eq!(drawn, expected, "{distance} units away, before the frame: {before}");
        }
    }
}

#[test]
fn a_viewport_holds_the_frame_and_leaves_the_rest() {
    let gpu = plain_device();
    let viewport = URect::new(9, 2, 21, 10);
    let mut stage = Stage::new(viewport.width(), viewport.height());
    stage.world().insert_resource(gpu.clone());
    let alone = stage.draw_bytes(&sphere());
    let (color, target) = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm);
    let depth = depth_texture(&gpu, wgpu::TextureFormat::Depth32Float, 1);
    for (load, own_depth) in [(Load::Keep, true), (Load::Keep, false), (Load::Clear, true), (Load::Clear, false)] {
        let own = (!own_depth).then(|| depth.clone());
        stage.world().insert_resource(TextureTarget { load, viewport: Some(viewport), depth: own, ..target.clone() });
        assert_eq!(stage.frame().errors, []);
        let mut encoder = encoder(&gpu);
        // At depth 0 it is nowhere nearer than what is cleared: the texture becomes blue.
        draw_triangle(&gpu, &mut encoder, (&target.view, &depth), (0.0, true));
        encode_frame(stage.app.world(), &mut encoder).expect("a frame");
        let bytes = read(&gpu, &color, encoder);
        for (at, drawn) in bytes.chunks_exact(4).enumerate() {
            let at = UVec2::new(at as u32 % SIZE.x, at as u32 / SIZE.x);
            let is_in = at.cmpge(viewport.min).all() && at.cmplt(viewport.max).all();
            let inside = is_in.then(|| (at - viewport.min).to_array()).map(|[x, y]| alone.get_pixel(x, y).0);
            let around = if load == Load::Keep { BLUE } else { [0, 0, 0, 255] };
            let expected = inside.filter(|pixel| *pixel != [0, 0, 0, 255]).unwrap_or(around);
            assert_eq!(drawn, expected, "{at}, {load:?}, a depth of its own: {own_depth}");
        }
    }
}

#[test]
fn cameras_draw_into_a_texture_in_turn() {
    let gpu = plain_device();
    let eyes = [Vec3::new(0.0, 3.0, 6.0), Vec3::new(4.0, 2.0, -3.0)];
    let place = |eye: Vec3| Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Y);
    let mut half = Stage::new(SIZE.x / 2, SIZE.y);
    half.world().insert_resource(gpu.clone());
    let alone = eyes.map(|eye| half.draw_bytes(&Scene { eye: place(eye), ..scene(2) }));
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    let scene = Scene { eye: place(eyes[0]), ..scene(2) };
    stage.set(&scene);
    let world = stage.world();
    let first = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    let second = stage.spawn((scene.camera, place(eyes[1])));
    let (color, target) = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm);
    let parts = [URect::new(0, 0, 12, 16), URect::new(12, 0, 24, 16)];
    for (camera, part, load) in [(first, parts[0], Load::Clear), (second, parts[1], Load::Keep)] {
        stage.world().insert_resource(CameraTurn(Some(camera)));
        stage.world().insert_resource(TextureTarget { viewport: Some(part), load, ..target.clone() });
        assert_eq!(stage.frame().errors, []);
        let mut encoder = encoder(&gpu);
        encode_frame(stage.app.world(), &mut encoder).expect("a frame");
        gpu.queue.submit([encoder.finish()]);
    }
    let bytes = read(&gpu, &color, encoder(&gpu));
    for (at, drawn) in bytes.chunks_exact(4).enumerate() {
        let [x, y] = [at as u32 % SIZE.x, at as u32 / SIZE.x];
        let expected = alone[x as usize / 12].get_pixel(x % 12, y).0;
        assert_eq!(drawn, expected, "({x}, {y})");
    }
    // Without a turn, and with parts of their own, they are refused, and the remedy is said.
    stage.world().insert_resource(CameraTurn(None));
    assert_eq!(stage.frame().errors, [RenderError::ManyCameras(2)]);
    for camera in [first, second] {
        stage.world().entity_mut(camera).insert(Viewport::default());
    }
    let errors = stage.frame().errors.clone();
    let says = |error: &RenderError| error.to_string().contains("draw in turn, by `CameraTurn`");
    assert!(!errors.is_empty() && errors.iter().all(says), "{errors:?}");
}

#[test]
fn what_does_not_go_together_in_a_target_is_said() {
    let gpu = plain_device();
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(gpu.clone());
    let (_, whole) = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm);
    let keeps = TextureTarget { load: Load::Keep, ..whole.clone() };
    let part = TextureTarget { viewport: Some(URect::new(0, 0, 8, 8)), ..whole.clone() };
    let beyond = TextureTarget { viewport: Some(URect::new(20, 0, 28, 8)), ..whole.clone() };
    let with_depth = |format, samples| {
        let depth = Some(depth_texture(&gpu, format, samples));
        TextureTarget { depth, ..whole.clone() }
    };
    let depth = |samples| with_depth(wgpu::TextureFormat::Depth32Float, samples);
    let (one, four) = (Samples::One, Samples::Four);
    let (clamp, reinhard) = (Intensity::Clamp, Intensity::Reinhard { white: 1.0 });
    let rows = [
        (keeps.clone(), four, clamp, Some("expected `Samples::One` or `Load::Clear`")),
        (keeps.clone(), one, reinhard, Some("expected `Intensity::Clamp`")),
        (keeps, one, clamp, None),
        (part.clone(), one, reinhard, Some("expected `Intensity::Clamp`")),
        (part, four, clamp, None),
        (beyond, one, clamp, Some("beyond its size")),
        (depth(1), four, clamp, Some("expected `Samples::One`")),
        (depth(4), one, clamp, Some("expected `Samples::Four`")),
        (depth(4), four, clamp, None),
        (depth(1), one, reinhard, None),
        (with_depth(wgpu::TextureFormat::Depth24Plus, 1), one, clamp, Some("Depth32Float")),
    ];
    for (number, (target, samples, intensity, problem)) in rows.into_iter().enumerate() {
        let mut scene = sphere();
        (scene.camera.samples, scene.camera.intensity) = (samples, intensity);
        stage.set(&scene);
        stage.world().insert_resource(target);
        let errors = stage.frame().errors.clone();
        match (problem, &errors[..]) {
            (None, []) => {}
            (Some(problem), [RenderError::BadTarget { reason, .. }]) if reason.contains(problem) => {}
            _ => panic!("row {number}: {errors:?}, expected {problem:?}"),
        }
    }
}

/// The device's callbacks are the engine's, so that it hears of the loss by them; the frame says what it cannot do.
#[test]
fn a_destroyed_engine_device_is_an_error_until_replaced() {
    for (lights, samples) in [(2, Samples::One), (20, Samples::Four)] {
        let row = format!("{lights} lights, {samples:?}");
        let gpu = plain_device();
        let heard = Arc::new(Mutex::new(Vec::new()));
        let (errors, losses) = (Arc::clone(&heard), Arc::clone(&heard));
        gpu.device.on_uncaptured_error(Arc::new(move |error| errors.lock().expect("no panic").push(error.to_string())));
        gpu.device.set_device_lost_callback(move |reason, _| {
            losses.lock().expect("no panic").push(format!("{reason:?}"));
        });
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        stage.world().insert_resource(gpu.clone());
        let mut scene = with_blended(scene(lights));
        scene.camera.samples = samples;
        let before = stage.draw_bytes(&scene);
        gpu.device.destroy();
        for _ in 0..2 {
            let result = stage.try_draw();
            assert!(matches!(result, Err(RenderError::Device(_))), "{row}: {result:?}");
        }
        let heard = heard.lock().expect("no panic").clone();
        assert!(heard.contains(&"Destroyed".to_owned()), "{row}: the engine hears {heard:?}");
        stage.world().insert_resource(plain_device());
        assert!(before == stage.bytes(), "{row}: another picture");
        assert_eq!(stage.report().errors, [], "{row}");
    }
}

/// Runs in a process of its own, where Mesa's OpenGL reports version 3.3, as NVIDIA's does.
#[cfg(target_os = "linux")]
#[test]
fn an_engine_s_device_of_too_old_opengl_says_so_in_each_frame() {
    const NAME: &str = "render::engine::an_engine_s_device_of_too_old_opengl_says_so_in_each_frame";
    const OLD: [(&str, &str); 3] =
        [("MESA_GL_VERSION_OVERRIDE", "3.3"), ("MESA_GLSL_VERSION_OVERRIDE", "330"), ("EGL_PLATFORM", "surfaceless")];
    if OLD.iter().all(|(name, value)| std::env::var(name).is_ok_and(|said| said == *value)) {
        return is_told_of_old_opengl();
    }
    let mut itself = Command::new(std::env::current_exe().expect("a running test has a path"));
    let output = itself.args([NAME, "--exact", "--nocapture"]).envs(OLD).env("LIBGL_ALWAYS_SOFTWARE", "true").output();
    let output = output.expect("a test starts");
    let said = [output.stdout, output.stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
    assert!(output.status.success() && said[0].contains("1 passed"), "{}{}", said[0], said[1]);
}

#[cfg(target_os = "linux")]
fn is_told_of_old_opengl() {
    let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
    wanted.backends = wgpu::Backends::GL;
    // With wgpu's default validation the device is lost when it is opened.
    wanted.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(wanted);
    let found = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let adapter = found.expect("llvmpipe through OpenGL");
    let opened = block_on(
        adapter.request_device(&wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() }),
    );
    let (device, queue) = opened.expect("a device that draws by the wrong buffers");
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.world().insert_resource(Gpu::from_existing(instance, adapter, device, queue));
    stage.pixels(Pixels::Byte);
    stage.set(&scene(2));
    for frame in 0..2 {
        let errors = stage.frame().errors.clone();
        let is_told = |error: &RenderError| matches!(error, RenderError::Device(why) if why.contains("OpenGL is 3.3"));
        assert!(errors.iter().any(is_told), "frame {frame}: {errors:?}");
    }
}

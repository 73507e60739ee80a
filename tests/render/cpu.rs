//! The CPU renderer, under every adapter of the other tests; `cargo xtask adapters` also runs those on the CPU.

use crate::render::compare::{FLOAT, Failures, SRGB, assert_identical};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::render::{
    Adapter, AdapterChoice, Canvas, CanvasTarget, Gpu, PendingPicture, RenderError, TextureTarget, wgpu,
};

fn stage_on(adapter: &str) -> Stage {
    let mut stage = Stage::new(60, 40);
    stage.world().insert_resource(AdapterChoice::named(adapter));
    stage
}

/// Balls in every shading on a floor in patches, one of glass, under more lights than are counted or under few.
fn scene(lights: u8) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 3.0, 6.0), Vec3::ZERO).ambient(0.1);
    scene = scene.with(Thing::new(Plane { size: 9.0, divisions: 64 }).with_material(other_material()));
    for (i, shading) in (0u8..).zip([Shading::Flat, Shading::Gouraud, Shading::Phong]) {
        let at = Vec3::new(1.7 * f32::from(i) - 2.2, 0.5, 0.3 * f32::from(i));
        let thing = Thing::new(UvSphere::new(0.5, 16, 8)).at(Transform::from_translation(at));
        scene = scene.with(thing.with_material([material(), Material::BRASS][usize::from(i % 2)]).shaded(shading));
    }
    let glass = Thing::new(Cuboid::new(1.0, 1.0, 1.0)).faces(Faces::Both).blended(0.4);
    scene = scene.with(glass.at(Transform::from_xyz(0.4, 0.6, 1.6).with_rotation(Quat::from_rotation_y(0.4))));
    for i in 0..lights {
        let at = Vec3::new(2.0 * f32::from(i % 5) - 4.0, 1.0, 2.0 * f32::from(i / 5) - 4.0);
        let light = PointLight { range: Some(2.0), ..PointLight::new(LinearRgba::rgb(0.3, 0.2, 0.25)) };
        scene = scene.lit(Lamp::point(light, at));
    }
    scene
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 3.0, 4.0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)))
}

#[test]
fn the_cpu_matches_the_oracle() {
    let mut stage = stage_on("cpu");
    let mut failures = Failures::default();
    for lights in [0, 20] {
        let row = format!("{lights} more lights");
        failures.draw(&row, &mut stage, &scene(lights), FLOAT);
        // Few lights do not cut the floor for the first picture.
        assert_eq!(stage.report().patches > 0, lights > 0, "{row}");
        stage.encode(Encoding::Srgb);
        let picture = stage.bytes();
        // Each layer is rounded to bytes, and lists may leave out half a step.
        failures.compare_bytes(&row, &mut stage, &picture, SRGB);
        assert!(stage.is_on_cpu() && !stage.app.world().contains_resource::<Gpu>(), "no device was opened");
        let report = stage.report();
        assert!(report.draws > 0 && report.triangles > 0 && report.patches > 0, "{report:?}");
        assert_eq!((report.lights_assigned > 0, report.pipelines), (lights > 0, 0));
    }
    failures.finish();
}

#[test]
fn large_meshes_are_cut_when_they_are_drawn_again() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let ball = Thing::new(UvSphere::new(1.0, 128, 64)).shaded(shading);
        let scene = |things: &[Thing]| {
            let scene = Scene::seen_from(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO);
            let scene = scene.lit(Lamp::point(point_light(), Vec3::new(1.0, 3.0, 4.0)));
            things.iter().cloned().fold(scene, Scene::with)
        };
        let mut stage = stage_on("cpu");
        let first = stage.draw(&scene(std::slice::from_ref(&ball)));
        let FrameReport { patches, triangles, .. } = *stage.report();
        assert_eq!((patches, triangles), (0, 16_128), "{shading:?}: it is whole");
        let second = stage.float();
        assert!(stage.report().patches > 200 && stage.report().patches_culled > 80, "{shading:?}");
        assert_identical(&format!("{shading:?}"), &first, &second);
        stage.float();
        assert_eq!(stage.report().bytes_uploaded, 0, "{shading:?}: it is laid out once more");
        // Two objects of one mesh.
        let mut stage = stage_on("cpu");
        stage.draw(&scene(&[ball.clone(), ball.clone().at(Transform::from_xyz(0.5, 0.0, 0.0))]));
        assert!(stage.report().patches > 400, "{shading:?}");
    }
}

#[test]
fn all_vectors_give_the_same_bits() {
    let widest = stage_on("cpu").draw(&scene(20));
    let mut tried = 0;
    for vectors in ["avx512", "avx2", "neon", "plain"] {
        let choice = AdapterChoice::named(format!("cpu:{vectors}"));
        // This CPU has only some of the SIMD levels.
        let Ok(adapter) = choice.open() else { continue };
        assert_eq!(adapter.describe(), format!("{vectors} (cpu, software)"));
        assert_identical(vectors, &widest, &stage_on(&format!("CPU:{vectors}")).draw(&scene(20)));
        tried += 1;
    }
    assert!(tried > 0, "none of the names is one");
}

#[test]
fn the_adapter_may_change_between_frames() {
    let mut stage = stage_on("cpu");
    let own = stage.draw(&scene(0));
    let gpu = Gpu::open_headless().expect("an adapter");
    stage.world().insert_resource(gpu);
    let mut failures = Failures::default();
    if stage.blends_floats() {
        let other = stage.float();
        failures.compare("by the GPU", &mut stage, &other, FLOAT);
    }
    stage.world().remove_resource::<Gpu>();
    assert_identical("by the CPU again", &own, &stage.float());
    failures.finish();
}

#[test]
fn an_undrawable_frame_is_an_error_and_the_next_is_right() {
    let mut stage = stage_on("cpu");
    let own = stage.draw(&scene(0));
    stage.target_size(20_000, 1);
    let what = "the picture's longer side, in pixels,".to_owned();
    assert_eq!(stage.try_draw(), Err(RenderError::TooLarge { what, needed: 20_000, limit: 16_384 }));
    stage.target_size(0, 40);
    assert_eq!(stage.try_draw(), Err(RenderError::EmptyPicture { width: 0, height: 40 }));
    stage.target_size(60, 40);
    assert_identical("again", &own, &stage.float());
}

#[test]
fn a_matrix_that_leaves_f32_shows_nothing_and_spoils_nothing() {
    let mut stage = stage_on("cpu");
    let own = stage.draw(&scene(0));
    let mut with = scene(0);
    let huge = Transform::from_scale(Vec3::new(1e38, 1e-30, 1e38)).with_translation(Vec3::new(3e38, 0.0, -3e38));
    with.things.insert(0, Thing::new(Cuboid::default()).at(huge));
    let picture = stage.draw(&with);
    assert!(picture.pixels().all(|pixel| pixel.0.iter().all(|value| value.is_finite())));
    stage.set(&scene(0));
    assert_identical("without it again", &own, &stage.float());
}

#[test]
fn a_device_s_texture_is_not_the_cpu_s_to_draw_into() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let mut stage = stage_on("cpu");
    stage.draw(&scene(0));
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    stage.world().insert_resource(TextureTarget::new(view, texture.format(), UVec2::splat(8)));
    let error = stage.frame().errors.first().expect("it is said").to_string();
    assert!(error.contains("Rgba8UnormSrgb") && error.contains("expected a `Gpu`"), "{error}");
}

/// The address and the size of the newest frame's bytes.
fn shown(stage: &Stage) -> Option<(UVec2, *const u8)> {
    stage.app.world().resource::<Canvas>().bytes().map(|(size, bytes)| (size, bytes.as_ptr()))
}

#[test]
fn a_window_s_canvas_follows_its_size_and_keeps_its_memory() {
    let mut stage = stage_on("cpu");
    stage.set(&scene(0));
    stage.pixels(Pixels::Byte);
    let headless = stage.bytes();
    stage.world().insert_resource(CanvasTarget { size: UVec2::new(60, 40) });
    stage.frame();
    let (size, memory) = shown(&stage).expect("a frame");
    assert_eq!(size, UVec2::new(60, 40));
    let bytes = stage.app.world().resource::<Canvas>().bytes().expect("a frame").1.to_vec();
    assert!(bytes == headless.into_raw(), "the window shows another picture");
    assert!(matches!(PendingPicture::request(stage.app.world()), Err(RenderError::NoPicture)));
    for _ in 0..3 {
        stage.frame();
        assert_eq!(shown(&stage), Some((size, memory)), "drawn into other memory");
    }
    stage.world().insert_resource(CanvasTarget { size: UVec2::new(31, 57) });
    stage.frame();
    assert_eq!(shown(&stage).map(|(size, _)| size), Some(UVec2::new(31, 57)));
    // Minimised.
    stage.world().insert_resource(CanvasTarget { size: UVec2::new(0, 57) });
    stage.frame();
    assert_eq!(shown(&stage), None);
}

#[test]
fn clones_draw_in_several_apps() {
    let adapter = AdapterChoice::cpu().open().unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(adapter, Adapter::Cpu(_)) && adapter.is_software());
    assert_eq!(adapter.sub_pixel_bits(), Ok(8));
    let expected = stage_on("cpu").draw(&scene(0));
    for _ in 0..2 {
        let mut stage = Stage::new(60, 40);
        adapter.clone().insert_into(stage.world());
        assert_identical("by a clone", &expected, &stage.draw(&scene(0)));
    }
}

//! The device is lost or replaced.

use crate::render::scene::{Lamp, Map, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use bevy_app::PostUpdate;
use futures_lite::future::block_on;
use halfway::prelude::*;
use halfway::render::{Compile, Gpu, GpuTimer, PendingPicture, RenderError, RenderSet, wgpu};
use halfway::texture::TexelImage;

/// A scene with every kind of resource of a device: flat, smooth and blended meshes, patches, few lights and many.
fn scene(lights: u8) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 3.0, 6.0), Vec3::ZERO).ambient(0.1);
    scene = scene
        .with(Thing::new(Plane { size: 9.0, divisions: 64 }).with_material(other_material()))
        .with(Thing::new(UvSphere::new(0.8, 24, 12)).with_material(material()).shaded(Shading::Gouraud))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(1.5, 0.5, 0.0)).shaded(Shading::Flat))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(-1.5, 0.5, 1.0)).blended(0.5))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)));
    for i in 0..lights {
        let at = Vec3::new(2.0 * f32::from(i % 5) - 4.0, 1.0, 2.0 * f32::from(i / 5) - 4.0);
        scene = scene.lit(Lamp::point(PointLight { range: Some(3.0), ..point_light() }, at));
    }
    scene
}

fn lose(world: &World) {
    world.resource::<Gpu>().device.destroy();
}

fn is_loss<T>(result: &Result<T, RenderError>) -> bool {
    matches!(result, Err(RenderError::DeviceLost(reason)) if reason == "it was destroyed")
}

/// An image that is too large for the device is an error, and objects after it have their own images.
#[test]
fn objects_after_an_oversized_image_are_drawn() {
    let mut gpu = Gpu::open_headless().expect("an adapter");
    let adapter = gpu.adapter.clone().expect("a device of its own has one");
    let limits = wgpu::Limits { max_texture_dimension_2d: 64, ..adapter.limits() };
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: limits,
        required_features: gpu.device.features(),
        ..Default::default()
    };
    (gpu.device, gpu.queue) = block_on(adapter.request_device(&descriptor)).expect("a small device");
    let mut stage = Stage::new(32, 24);
    stage.app.insert_resource(gpu);
    let square = |x: f32, side: u32, image: [f32; 4]| {
        let image = TexelImage::from_fn(side, side, |_, _| image).expect("an image");
        let maps = vec![(MapKind::Color, Map::new(image))];
        Thing { maps, ..Thing::square(Vec3::new(x, 0.0, -2.0), Vec3::Z, 0.9) }
    };
    let grey = [0.5, 0.5, 0.5, 1.0];
    let mut scene = Scene::in_eye_space().ambient(1.0);
    scene.things = vec![square(-0.5, 128, grey), square(0.5, 4, grey)];
    stage.set(&scene);
    let errors = stage.frame().errors.clone();
    assert!(matches!(errors[..], [RenderError::TooLarge { .. }]), "{errors:?}");
    let picture = PendingPicture::request(stage.app.world()).and_then(PendingPicture::wait);
    let Ok(Picture::Float(picture)) = picture else { panic!("a picture in floating point") };
    let [left, right] = [12, 20].map(|x| picture.get_pixel(x, 12).0[0]);
    assert!(left == 0.0 && right > 0.01, "{left}, {right}");
}

/// Stages of all kinds, each with what it draws.
fn stages() -> Vec<(String, Stage)> {
    let mut stages = Vec::new();
    for (lights, samples, compile) in
        [(2, Samples::One, Compile::Now), (20, Samples::Four, Compile::Now), (20, Samples::One, Compile::Beside)]
    {
        let mut stage = Stage::new(24, 16);
        stage.world().insert_resource(compile);
        stage.world().insert_resource(ViewTolerance::default());
        stage.world().init_resource::<GpuTimer>();
        let mut scene = scene(lights);
        scene.camera.samples = samples;
        stage.set(&scene);
        stages.push((format!("{lights} lights, {samples:?}, {compile:?}"), stage));
    }
    stages
}

/// The picture once everything has settled.
fn settled(stage: &mut Stage) -> image::RgbaImage {
    stage.compile();
    stage.bytes()
}

#[test]
fn a_lost_device_is_an_error_once_and_the_next_picture_is_right() {
    for (row, mut stage) in stages() {
        let before = settled(&mut stage);
        for loss in 1..=3 {
            lose(stage.app.world());
            let result = stage.try_draw();
            assert!(is_loss(&result), "{row}, loss {loss}: {result:?}");
            stage.frame();
            assert_eq!(stage.report().errors, [], "{row}, loss {loss}: said once");
            assert!(before == settled(&mut stage), "{row}, loss {loss}: another picture");
        }
    }
}

#[test]
fn a_device_may_be_lost_at_any_moment_of_a_frame() {
    #[derive(Resource)]
    struct LoseAt(Option<RenderSet>);
    for (row, mut stage) in stages() {
        stage.world().insert_resource(LoseAt(None));
        for set in RenderSet::ALL {
            let lose = move |mut at: ResMut<LoseAt>, gpu: Option<Res<Gpu>>| {
                if let (Some(gpu), true) = (gpu, at.0 == Some(set)) {
                    at.0 = None;
                    gpu.device.destroy();
                }
            };
            // Before all systems of the set, and among them.
            stage.app.add_systems(PostUpdate, lose.before(set).after(bevy_transform::TransformSystems::Propagate));
        }
        let before = settled(&mut stage);
        for set in RenderSet::ALL {
            stage.world().resource_mut::<LoseAt>().0 = Some(set);
            // Unfinished work may keep the driver from saying so at once; no picture is wrong meanwhile.
            let result = stage.try_draw();
            assert!(is_loss(&result), "{row}, before {set:?}: {result:?}");
            assert!(before == settled(&mut stage), "{row}, before {set:?}: another picture");
        }
    }
}

#[test]
fn nothing_of_one_device_is_used_with_another() {
    let devices = [Gpu::open_headless().expect("an adapter"), Gpu::open_headless().expect("an adapter")];
    for (row, mut stage) in stages() {
        let expected = settled(&mut stage);
        for round in 0..4 {
            stage.world().insert_resource(devices[round % 2].clone());
            assert!(stage.frame().bytes_uploaded > 0, "{row}, round {round}");
            assert_eq!(stage.report().errors, [], "{row}, round {round}");
            assert!(expected == settled(&mut stage), "{row}, round {round}: another picture");
            assert_eq!(stage.frame().bytes_uploaded, 0, "{row}, round {round}: the same device, and all is there");
            // A clone is the same device.
            stage.world().insert_resource(devices[round % 2].clone());
            assert_eq!(stage.frame().bytes_uploaded, 0, "{row}, round {round}");
        }
    }
}

#[test]
fn a_picture_on_its_way_comes_from_its_own_device() {
    let mut stage = Stage::new(8, 8);
    let expected = stage.draw(&scene(1));
    let request = |stage: &mut Stage| PendingPicture::request(stage.app.world()).expect("a frame has been drawn");

    // Another device replaces the one that holds the pending picture.
    let pending = request(&mut stage);
    stage.world().insert_resource(Gpu::open_headless().expect("an adapter"));
    stage.frame();
    assert_eq!(pending.wait(), Ok(Picture::Float(expected.clone())));

    // The picture was pending before the device was lost: it arrives, or there is an error; nothing waits for ever.
    let (pending, mut polled) = (request(&mut stage), request(&mut stage));
    lose(stage.app.world());
    let arrived = pending.wait();
    assert!(is_loss(&arrived) || arrived == Ok(Picture::Float(expected.clone())), "{arrived:?}");
    let arrived = polled.try_take();
    assert!(is_loss(&arrived) || arrived.is_ok(), "{arrived:?}");

    // The picture is requested after the loss.
    lose(stage.app.world());
    let late = request(&mut stage).wait();
    assert!(is_loss(&late), "{late:?}");
    stage.try_draw().ok();
    assert_eq!(stage.float(), expected);
}

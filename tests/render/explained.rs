//! Lines that explain a scene: axes, normals, lights and the ground.

use crate::render::scene::{Lamp, Scene, Thing, glowing};
use crate::render::stage::Stage;
use halfway::lighting::{Show, Upright};
use halfway::prelude::*;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use halfway::render::take_picture;
use image::Rgba32FImage;
use std::ops::ControlFlow;

const SIZE: UVec2 = UVec2::new(160, 120);

/// A dark box of 2 × 2 × 2 about the origin, with a red light before it and a blue one inside.
fn scene() -> Scene {
    let cube = Thing::new(Cuboid { size: Vec3::splat(2.0) }).with_material(glowing(0.01, 0.01, 0.01));
    Scene::seen_from(Vec3::new(2.0, 3.0, 7.0), Vec3::ZERO)
        .lit(Lamp::point(PointLight::new(LinearRgba::rgb(0.0, 0.0, 0.2)), Vec3::ZERO))
        .lit(Lamp::directional(DirectionalLight::new(LinearRgba::rgb(5.0, 0.0, 0.0)), Vec3::NEG_Y))
        .with(cube)
}

fn drawn(stage: &mut Stage, show: Show) -> Rgba32FImage {
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    world.entity_mut(camera).insert(show);
    match take_picture(stage.world()).unwrap_or_else(|error| panic!("{error}")) {
        Picture::Float(picture) => picture,
        Picture::Byte(_) => panic!("bytes"),
    }
}

/// The same with another direction up.
fn under(stage: &mut Stage, upright: Upright, show: Show) -> Rgba32FImage {
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    world.entity_mut(camera).insert(upright);
    drawn(stage, show)
}

/// How many pixels have more of this channel than of both others.
fn count(picture: &Rgba32FImage, channel: usize) -> usize {
    let is = |pixel: &[f32; 4]| (0..3).all(|other| other == channel || pixel[channel] > 1.5 * pixel[other] + 0.1);
    picture.pixels().filter(|pixel| is(&pixel.0)).count()
}

#[test]
fn each_shows_its_own() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let nothing = drawn(&mut stage, Show::default());
    assert!((0..3).all(|channel| count(&nothing, channel) == 0));

    // Three colours: dashed in the box, drawn through outside of it.
    let axes = drawn(&mut stage, Show { axes: true, ..Show::default() });
    for channel in 0..3 {
        assert!(count(&axes, channel) > 20, "axis {channel}: {}", count(&axes, channel));
    }
    // Light blue, on the corners that are seen.
    let normals = drawn(&mut stage, Show { normals: true, ..Show::default() });
    assert!(count(&normals, 2) > 20 && count(&normals, 0) == 0, "{}", count(&normals, 2));
    let face_normals = drawn(&mut stage, Show { face_normals: true, ..Show::default() });
    assert!(count(&face_normals, 0) > 8 && count(&face_normals, 2) == 0, "{}", count(&face_normals, 0));
    // As bright as can be, over the box that hides one of them.
    let lights = drawn(&mut stage, Show { lights: true, ..Show::default() });
    assert_eq!(lights.get_pixel(80, 60).0, [0.0, 0.0, 1.0, 1.0]);
    assert!(count(&lights, 0) > 15, "{}", count(&lights, 0));
    // Grey, around the box and not over it.
    let grid = drawn(&mut stage, Show { grid: true, ..Show::default() });
    assert_eq!(grid.get_pixel(80, 60), nothing.get_pixel(80, 60));
    let grey = grid.pixels().zip(nothing.pixels()).filter(|(a, b)| a != b).count();
    assert!(grey > 200, "{grey}");
    // On the other side of the box.
    let ceiling = under(&mut stage, Upright(Vec3::NEG_Y), Show { grid: true, ..Show::default() });
    assert!(ceiling.pixels().zip(grid.pixels()).filter(|(a, b)| a != b).count() > 200);
}

#[test]
fn the_reference_shows_the_same() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let show = Show { axes: true, normals: true, face_normals: true, lights: true, grid: true };
    let picture = drawn(&mut stage, show);
    let frame = FrameToDraw { number: 0, size: SIZE, pixels: Pixels::Float };
    let reference = ReferenceDrawing::default().picture(&mut stage.app, frame, &|_, _| ControlFlow::Continue(()));
    let Ok(Picture::Float(reference)) = reference else { panic!("a picture in floating point") };
    let differ = |picture: &Rgba32FImage| {
        let pairs = picture.pixels().zip(reference.pixels());
        pairs.filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| (a - b).abs() > 0.02)).count()
    };
    let wrong = differ(&picture);
    assert!(wrong <= 20, "{wrong} pixels differ");
    // A planted fault: another upright direction.
    let other = under(&mut stage, Upright(Vec3::X), show);
    assert!(differ(&other) > 200, "{} pixels differ", differ(&other));
}

#[test]
fn a_direction_without_length_is_refused() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    world.entity_mut(camera).insert((Show { grid: true, ..Show::default() }, Upright(Vec3::ZERO)));
    let error = take_picture(stage.world()).expect_err("no direction").to_string();
    assert!(error.contains("Upright"), "{error}");
}

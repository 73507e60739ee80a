//! Backgrounds that are more than one opaque colour.

use crate::render::compare::Failures;
use crate::render::scene::{Scene, Thing, glowing, rotated};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use image::Rgba32FImage;
use std::ops::ControlFlow;

const SIZE: UVec2 = UVec2::new(60, 40);

/// A turned cube, and a pane half before it.
fn scene(camera: Camera, blends: bool) -> Scene {
    let cube = Thing::new(Cuboid::default()).at(rotated(0.4, 0.6, 0.2)).with_material(glowing(0.9, 0.4, 0.1));
    let pane = Thing::square(Vec3::new(0.6, 0.3, 1.0), Vec3::Z, 0.8).with_material(glowing(0.1, 0.2, 0.8)).blended(0.3);
    let scene = Scene::seen_from(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO).with(cube);
    Scene { camera, ..if blends { scene.with(pane) } else { scene } }
}

fn over(picture: &Rgba32FImage, behind: impl Fn(u32) -> LinearRgba) -> Rgba32FImage {
    Rgba32FImage::from_fn(SIZE.x, SIZE.y, |x, y| {
        let [r, g, b, alpha] = picture.get_pixel(x, y).0;
        let LinearRgba { red, green, blue, .. } = behind(y);
        let mix = |above: f32, below: f32| alpha * above + (1.0 - alpha) * below;
        image::Rgba([mix(r, red), mix(g, green), mix(b, blue), 1.0])
    })
}

#[test]
fn a_transparent_picture_over_any_colour_is_the_picture_drawn_over_it() {
    let mut failures = Failures::default();
    for samples in [Samples::One, Samples::Four] {
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        stage.set(&Scene::in_eye_space());
        stage.frame();
        let blends = stage.blends_floats();
        let mut draw = |background: Option<LinearRgba>, background_below| {
            let background_opacity = if background.is_some() { 1.0 } else { 0.0 };
            let background = background.unwrap_or(LinearRgba::BLACK);
            let camera = Camera { background, background_below, background_opacity, samples, ..Camera::default() };
            stage.draw(&scene(camera, blends))
        };
        let clear = draw(None, None);
        assert_eq!(clear.get_pixel(0, 0).0, [0.0; 4]);
        assert_eq!(clear.get_pixel(28, 20).0[3], 1.0);
        let partly = clear.pixels().filter(|pixel| pixel.0[3] > 0.0 && pixel.0[3] < 1.0).count();
        assert_eq!(partly > 0, blends || samples == Samples::Four, "{partly} pixels are seen through in part");
        let [above, below] = [LinearRgba::rgb(0.2, 0.9, 0.4), LinearRgba::rgb(0.8, 0.1, 0.0)];
        let at = |row: u32| {
            let share = (row as f32 + 0.5) / SIZE.y as f32;
            let mix = |above: f32, below: f32| above + share * (below - above);
            LinearRgba::rgb(mix(above.red, below.red), mix(above.green, below.green), mix(above.blue, below.blue))
        };
        for (name, opaque, expected) in [
            ("one colour", draw(Some(above), None), over(&clear, |_| above)),
            ("two colours", draw(Some(above), Some(below)), over(&clear, at)),
        ] {
            for ((x, y, found), expected) in opaque.enumerate_pixels().zip(expected.pixels()) {
                // Two roundings of numbers up to 1, and a division by an opacity of a quarter or more.
                let same = found.0.iter().zip(expected.0).all(|(a, b)| (a - b).abs() < 3e-6);
                failures.unless(same, || format!("{name}, {samples:?}, ({x}, {y}): {found:?} instead of {expected:?}"));
            }
        }
    }
    failures.finish();
}

#[test]
fn the_reference_has_the_same_backgrounds() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let camera = Camera {
        background: LinearRgba::rgb(0.2, 0.9, 0.4),
        background_below: Some(LinearRgba::rgb(0.8, 0.1, 0.0)),
        background_opacity: 0.25,
        encoding: Encoding::Raw,
        ..Camera::default()
    };
    let drawn = stage.draw(&scene(camera, false));
    let frame = FrameToDraw { number: 0, size: SIZE, pixels: Pixels::Float };
    let reference = ReferenceDrawing::default().picture(&mut stage.app, frame, &|_, _| ControlFlow::Continue(()));
    let Ok(Picture::Float(reference)) = reference else { panic!("a picture in floating point") };
    let differ = |drawn: &Rgba32FImage| {
        let differ = drawn.pixels().zip(reference.pixels()).filter(|(found, expected)| {
            found.0.iter().zip(expected.0).any(|(found, expected)| (found - expected).abs() > 1e-5)
        });
        differ.count()
    };
    // Pixels on the cube's edges may show another side.
    assert!(differ(&drawn) <= 6, "{} pixels differ", differ(&drawn));
    // A planted fault: another opacity by a thousandth.
    let other = stage.draw(&scene(Camera { background_opacity: 0.251, ..camera }, false));
    assert!(differ(&other) > 6, "{} pixels differ", differ(&other));
}

#[test]
fn bytes_are_encoded_after_what_is_behind_is_known() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let background = LinearRgba::rgb(0.5, 0.0, 1.0);
    stage.set(&scene(Camera { background, background_opacity: 0.5, ..Camera::default() }, false));
    stage.pixels(Pixels::Byte);
    let picture = stage.bytes();
    assert_eq!(picture.get_pixel(0, 0).0, [188, 0, 255, 128]);
    assert_eq!(picture.get_pixel(28, 20).0[3], 255);
}

#[test]
fn an_opacity_above_1_is_refused() {
    let mut stage = Stage::new(8, 6);
    stage.set(&Scene { camera: Camera { background_opacity: 1.5, ..Camera::default() }, ..Scene::in_eye_space() });
    let error = stage.try_draw().expect_err("no opacity").to_string();
    assert!(error.contains("background_opacity") && error.contains("0 to 1"), "{error}");
}

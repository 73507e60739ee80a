//! The picture itself: encodings, background, clamping, samples, sizes, depth, projection.

use crate::render::compare::{FLOAT, Failures, SRGB, assert_as_expected, assert_identical, difference, judge};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, point_light};
use crate::render::stage::{Stage, of_hardware};
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::Bars;
use halfway::render::PendingPicture;

/// A square that fills the picture with one grey.
fn grey(value: f32) -> Scene {
    Scene::in_eye_space()
        .with(Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 9.0).with_material(glowing(value, value, value)))
}

#[test]
fn encodings_write_the_values_that_they_define() {
    // I, as it is, and by IEC 61966-2-1.
    let rows = [
        (0.0, 0, 0),
        (0.001, 0, 3),
        (0.01, 3, 25),
        (0.1, 26, 89),
        (0.2, 51, 124),
        (0.5, 128, 188),
        (0.75, 191, 225),
        (1.0, 255, 255),
    ];
    let mut stage = Stage::new(3, 3);
    for (intensity, raw, srgb) in rows {
        for (encoding, expected) in [(Encoding::Raw, raw), (Encoding::Srgb, srgb)] {
            let mut drawn = grey(intensity);
            drawn.camera.encoding = encoding;
            let mut background = Scene::in_eye_space();
            background.camera.encoding = encoding;
            background.camera.background = LinearRgba::rgb(intensity, intensity, intensity);
            for (what, scene) in [("a surface", drawn), ("the background", background)] {
                let [red, green, blue, alpha] = stage.draw_bytes(&scene).get_pixel(1, 1).0;
                // Vulkan lets the sRGB curve be 0.6 of a step off; as it is, 0.1 and 0.5 lie between two steps.
                let is_tie = raw_is_tie(intensity, if stage.is_hardware() { 0.1 } else { 1e-5 });
                let exact = encoding == Encoding::Raw && !is_tie;
                let step = u8::from(!exact && (0.001..1.0).contains(&intensity));
                assert!(red.abs_diff(expected) <= step, "{what} of {intensity}, {encoding:?}: {red}, not {expected}");
                assert_eq!((red, red, 255), (green, blue, alpha), "{what} of {intensity}, {encoding:?}");
            }
        }
    }
}

#[test]
fn srgb_bytes_turn_over_where_the_curve_says() {
    // The CPU encodes to a 600th of a step; Vulkan lets a driver be 0.6 off.
    let mut stage = Stage::new(3, 3);
    let mut scene = grey(0.0);
    let mut red = |intensity: f64| {
        scene.things[0].material = glowing(intensity as f32, 0.0, 0.0);
        stage.draw_bytes(&scene).get_pixel(1, 1).0[0]
    };
    let bytes: Vec<[u8; 2]> =
        (0..255).map(|k| [0.49, 0.51].map(|step| red(Encoding::Srgb.decode((f64::from(k) + step) / 255.0)))).collect();
    let may_be_off = u8::from(!stage.is_on_cpu());
    for (k, [below, above]) in (0..255).zip(bytes) {
        assert!(below.abs_diff(k) <= may_be_off, "{below}, not {k}");
        assert!(above.abs_diff(k + 1) <= may_be_off, "{above}, not {}", k + 1);
    }
}

/// A planted fault: bytes that are all one step too dark are found, also by the bars of hardware.
#[test]
fn bytes_that_are_all_one_step_off_are_found() {
    let mut stage = Stage::new(24, 16);
    let mut scene = grey(0.4);
    scene.camera.encoding = Encoding::Raw;
    let mut picture = stage.draw_bytes(&scene);
    let bars = of_hardware(Bars::bytes(Encoding::Raw));
    for is_right in [true, false] {
        let (verdict, _) = judge(&mut stage, &Image::from_bytes(&picture, Encoding::Raw), bars);
        assert_eq!(verdict.is_within(), is_right, "{verdict}");
        picture.pixels_mut().for_each(|pixel| pixel.0[..3].iter_mut().for_each(|byte| *byte -= 1));
    }
}

/// Whether it lies in the middle between two bytes, within `give` of a step.
fn raw_is_tie(intensity: f32, give: f32) -> bool {
    ((intensity * 255.0).fract() - 0.5).abs() < give
}

#[test]
fn floating_point_is_the_same_under_both_encodings() {
    let mut stage = Stage::new(5, 5);
    for intensity in [0.0, 1e-6, 0.18, 0.5, 1.0, 7.5, 1e6] {
        for encoding in [Encoding::Raw, Encoding::Srgb] {
            let mut scene = grey(intensity);
            scene.camera.encoding = encoding;
            assert_eq!(stage.draw(&scene).get_pixel(2, 2).0, [intensity, intensity, intensity, 1.0], "{encoding:?}");
        }
    }
}

#[test]
fn intensities_above_one_are_clamped_in_bytes_alone() {
    let mut stage = Stage::new(3, 3);
    for intensity in [1.0001, 2.0, 1e3, 1e12] {
        assert_eq!(stage.draw_bytes(&grey(intensity)).get_pixel(1, 1).0, [255; 4], "{intensity}");
        assert_eq!(stage.draw(&grey(intensity)).get_pixel(1, 1).0[0].to_bits(), intensity.to_bits());
    }
    // Channel by channel, which turns the hue; that is what clamping means.
    let mut scene = grey(0.0);
    scene.things[0].material = glowing(4.0, 0.5, 0.0);
    let [red, green, blue, alpha] = stage.draw_bytes(&scene).get_pixel(1, 1).0;
    assert_eq!((red, blue, alpha), (255, 0, 255));
    assert!(green.abs_diff(188) <= 1, "{green}");
}

#[test]
fn the_background_is_where_nothing_is_drawn() {
    let mut stage = Stage::new(16, 16);
    let mut scene = Scene::seen_from(Vec3::Z * 5.0, Vec3::ZERO).with(Thing::square(Vec3::ZERO, Vec3::Z, 1.0));
    // Its alpha is ignored.
    scene.camera.background = LinearRgba::new(0.25, 3.0, 0.0, 0.1);
    assert_eq!(stage.draw(&scene).get_pixel(0, 0).0, [0.25, 3.0, 0.0, 1.0]);
    assert_eq!(stage.bytes().get_pixel(15, 15).0, [137, 255, 0, 255]);
    assert_ne!(stage.bytes().get_pixel(8, 8).0, [137, 255, 0, 255]);
}

#[test]
fn four_samples_smooth_edges_and_leave_the_inside_as_it_is() {
    let mut stage = Stage::new(48, 48);
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let mut scene = Scene::seen_from(Vec3::new(0.0, 0.3, 3.0), Vec3::ZERO)
            .with(Thing::square(Vec3::ZERO, Vec3::new(0.3, 0.2, 1.0), 1.4).shaded(shading))
            .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.0, 2.0)));
        scene.things[0].frames[0].rotation *= Quat::from_rotation_y(0.3);
        scene.camera.background = LinearRgba::rgb(0.0, 0.0, 1.0);
        let one = stage.draw(&scene);
        scene.camera.samples = Samples::Four;
        let four = stage.draw(&scene);
        let oracle = stage.oracle();
        let (mut inside, mut between) = (0, 0);
        for (x, y, pixel) in four.enumerate_pixels() {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let hit = corners
                .map(|(dx, dy)| oracle.probe(f64::from(x + dx), f64::from(y + dy)).nearest.map(|hit| hit.triangle));
            let single = one.get_pixel(x, y).0;
            if hit.iter().all(|triangle| *triangle == hit[0]) {
                inside += usize::from(hit[0].is_some());
                // The same up to rounding: what is interpolated is found in another way.
                let close = (0..3).all(|k| (pixel.0[k] - single[k]).abs() <= 1e-5 * single[k].max(1e-3));
                assert!(close, "{shading:?}: pixel ({x}, {y}) is {:?}, with one sample {single:?}", pixel.0);
            } else if pixel.0[2] > 0.75 && pixel.0[2] < 0.95 {
                // Blue is 1 outside and below 0.7 inside.
                between += 1;
            }
        }
        assert!(inside > 300 && between > 30, "{shading:?}: {inside} pixels inside, {between} between");
        assert_eq!(stage.bytes().get_pixel(24, 24).0[3], 255);
    }
}

#[test]
fn pictures_of_every_size_are_read_back_whole() {
    // Rows are padded to 256 bytes on the way: 64 pixels of bytes, 16 of floats.
    let mut stage = Stage::new(1, 1);
    let sizes = [
        (1, 1),
        (1, 7),
        (7, 1),
        (2, 3),
        (15, 4),
        (16, 4),
        (17, 4),
        (63, 5),
        (64, 5),
        (65, 5),
        (1, 1),
        (96, 33),
        (33, 96),
    ];
    let mut failures = Failures::default();
    for (width, height) in sizes {
        for samples in [Samples::One, Samples::Four] {
            let mut scene = Scene::seen_from(Vec3::new(0.5, 1.0, 2.0), Vec3::ZERO)
                .ambient(0.2)
                .with(Thing::new(UvSphere::new(0.9, 12, 6)))
                .with(Thing::square(Vec3::new(0.0, -1.0, 0.0), Vec3::Y, 20.0))
                .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.5, 1.5)));
            scene.camera.samples = samples;
            stage.target_size(width, height);
            let float = stage.draw(&scene);
            assert_eq!(float.dimensions(), (width, height));
            let bytes = stage.bytes();
            assert_eq!(bytes.dimensions(), (width, height));
            if samples == Samples::One {
                let row = format!("{width} × {height}");
                failures.compare(&row, &mut stage, &float, FLOAT);
                failures.compare_bytes(&format!("{row}, bytes"), &mut stage, &bytes, SRGB);
            }
        }
    }
    failures.finish();
}

#[test]
fn right_is_right_and_up_is_the_first_row() {
    let mut stage = Stage::new(32, 24);
    let scene = Scene::in_eye_space()
        .with(Thing::square(Vec3::new(0.5, 0.3, -2.0), Vec3::Z, 0.2).with_material(glowing(1.0, 0.0, 0.0)))
        .with(Thing::square(Vec3::new(-0.5, 0.3, -2.0), Vec3::Z, 0.2).with_material(glowing(0.0, 1.0, 0.0)))
        .with(Thing::square(Vec3::new(0.5, -0.3, -2.0), Vec3::Z, 0.2).with_material(glowing(0.0, 0.0, 1.0)));
    let picture = stage.draw(&scene);
    let oracle = stage.oracle();
    for (at, expected) in [
        (Vec3::new(0.5, 0.3, -2.0), [1.0, 0.0, 0.0, 1.0]),
        (Vec3::new(-0.5, 0.3, -2.0), [0.0, 1.0, 0.0, 1.0]),
        (Vec3::new(0.5, -0.3, -2.0), [0.0, 0.0, 1.0, 1.0]),
        (Vec3::new(-0.5, -0.3, -2.0), [0.0, 0.0, 0.0, 1.0]),
    ] {
        let (x, y) = oracle.project(at.as_dvec3()).expect("before the camera");
        assert_eq!(x > 16.0, at.x > 0.0);
        assert_eq!(y < 12.0, at.y > 0.0);
        assert_eq!(picture.get_pixel(x as u32, y as u32).0, expected, "{at}");
    }
}

#[test]
fn every_field_of_view_and_roll_is_projected_right() {
    let mut stage = Stage::new(40, 30);
    for fov_y in [0.05f32, 0.5, std::f32::consts::FRAC_PI_2, 2.5, 3.1] {
        for roll in [0.0f32, 0.4, std::f32::consts::PI] {
            let distance = 1.2 / (0.5 * fov_y.min(1.5)).tan();
            let mut scene = Scene::seen_from(Vec3::new(0.2, 0.1, 1.0) * distance, Vec3::ZERO)
                .with(Thing::new(UvSphere::new(1.0, 16, 8)))
                .with(Thing::square(Vec3::NEG_Z, Vec3::Z, 50.0))
                .lit(Lamp::directional(directional_light(), Vec3::new(-0.3, -0.5, -1.0)));
            scene.eye.rotation *= Quat::from_rotation_z(roll);
            scene.camera.projection = Projection::perspective(fov_y).with_near(1e-2);
            assert_as_expected(&format!("fov {fov_y}, roll {roll}"), &mut stage, &scene);
        }
    }
}

#[test]
fn the_cameras_scale_does_nothing() {
    let mut stage = Stage::new(24, 24);
    let mut scene = Scene::seen_from(Vec3::new(0.5, 1.0, 3.0), Vec3::ZERO)
        .with(Thing::new(UvSphere::new(1.0, 16, 8)))
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.5, 1.5)));
    let plain = stage.draw(&scene);
    for scale in [Vec3::splat(3.0), Vec3::splat(1e-3), Vec3::new(2.0, 0.5, 1.0)] {
        scene.eye.scale = scale;
        let scaled = stage.draw(&scene);
        // A rotation read back from a scaled matrix is off by some 10⁻⁷ rad; a pixel of an edge may change sides.
        let changed = plain.pixels().zip(scaled.pixels()).filter(|(a, b)| (a.0[0] - b.0[0]).abs() > 1e-4).count();
        assert!(changed <= 2, "a camera of scale {scale}: {changed} pixels changed");
    }
}

#[test]
fn a_millimetre_at_a_kilometre_is_in_the_right_order() {
    let mut stage = Stage::new(8, 8);
    let plane = |distance: f32, red: f32, blue: f32| {
        Thing::square(Vec3::NEG_Z * distance, Vec3::Z, 2000.0).with_material(glowing(red, 0.0, blue))
    };
    for distance in [10.0, 100.0, 1000.0] {
        let near = plane(distance, 1.0, 0.0);
        let far = plane(distance + 0.001, 0.0, 1.0);
        for (order, things) in [("near first", [&near, &far]), ("far first", [&far, &near])] {
            let mut scene = Scene::in_eye_space();
            scene.things = things.map(Thing::clone).to_vec();
            for pixel in stage.draw(&scene).pixels() {
                assert_eq!(pixel.0, [1.0, 0.0, 0.0, 1.0], "1 mm at {distance} m, {order} spawned");
            }
        }
    }
}

#[test]
fn the_near_plane_cuts_and_there_is_no_far_one() {
    let mut stage = Stage::new(8, 8);
    for near in [1e-3, 0.1, 5.0] {
        for (factor, shown) in [(0.5, false), (0.999, false), (1.001, true), (1e3, true), (1e9, true), (1e15, true)] {
            let distance = near * factor;
            let mut scene = Scene::in_eye_space().with(
                Thing::square(Vec3::NEG_Z * distance, Vec3::Z, 9.0 * distance).with_material(glowing(1.0, 1.0, 1.0)),
            );
            scene.camera.projection = scene.camera.projection.with_near(near);
            let seen = stage.draw(&scene).get_pixel(4, 4).0[0] > 0.5;
            assert_eq!(seen, shown, "near {near}, at {distance:e}");
        }
    }
}

#[test]
fn intersecting_objects_hide_each_other_pixel_by_pixel() {
    let mut stage = Stage::new(48, 48);
    let scene = Scene::seen_from(Vec3::new(0.5, 0.8, 3.0), Vec3::ZERO)
        .with(
            Thing::square(Vec3::ZERO, Vec3::new(0.5, 0.0, 1.0), 2.5)
                .with_material(glowing(0.9, 0.1, 0.0))
                .faces(Faces::Both),
        )
        .with(
            Thing::square(Vec3::ZERO, Vec3::new(-0.6, 0.3, 1.0), 2.5)
                .with_material(glowing(0.1, 0.9, 0.0))
                .faces(Faces::Both),
        )
        .with(Thing::new(UvSphere::new(0.7, 16, 8)).with_material(glowing(0.2, 0.3, 0.9)));
    assert_as_expected("two squares through a sphere", &mut stage, &scene);
}

#[test]
fn pictures_do_not_depend_on_those_before_them() {
    // Sizes, pixels, samples and scenes change between frames of one App; each frame is what a fresh App draws.
    let mut stage = Stage::new(16, 16);
    let scenes = [
        Scene::in_eye_space().with(Thing::new(UvSphere::default()).at(Transform::from_xyz(0.0, 0.0, -3.0))),
        Scene::in_eye_space(),
        grey(0.5),
    ];
    for (row, scene) in scenes.into_iter().enumerate() {
        let mut scene = scene.lit(Lamp::point(point_light(), Vec3::X));
        for samples in [Samples::Four, Samples::One] {
            for (width, height) in [(16, 16), (31, 9)] {
                scene.camera.samples = samples;
                stage.target_size(width, height);
                let float = stage.draw(&scene);
                let bytes = stage.bytes();
                let mut fresh = Stage::new(width, height);
                let row = format!("scene {row}, {samples:?}, {width} × {height}");
                assert_identical(&row, &float, &fresh.draw(&scene));
                assert_eq!(bytes, fresh.bytes(), "{row}");
            }
        }
    }
}

#[test]
fn a_picture_on_its_way_is_not_changed_by_later_frames() {
    let mut stage = Stage::new(8, 8);
    stage.set(&grey(0.25));
    stage.frame();
    let pending = PendingPicture::request(stage.app.world()).expect("a headless frame has been drawn");
    stage.set(&grey(0.75));
    stage.frame();
    let mut later = PendingPicture::request(stage.app.world()).expect("a headless frame has been drawn");
    let red = |picture: Picture| match picture {
        Picture::Float(image) => image.get_pixel(4, 4).0[0],
        Picture::Byte(_) => panic!("bytes"),
    };
    assert!((red(pending.wait().expect("the first picture")) - 0.25).abs() < 1e-7);
    let picture = loop {
        if let Some(picture) = later.try_take().expect("the second picture") {
            break picture;
        }
        std::thread::yield_now();
    };
    assert!((red(picture) - 0.75).abs() < 1e-7);
    assert_eq!(later.try_take(), Ok(None), "a picture is taken once");
}

#[test]
fn the_same_scene_gives_the_same_picture() {
    let scene = Scene::seen_from(Vec3::new(0.5, 0.8, 3.0), Vec3::ZERO)
        .ambient(0.1)
        .with(Thing::new(Teapot::new(4)).at(Transform::from_scale(Vec3::splat(0.4))))
        .with(Thing::square(Vec3::NEG_Y * 0.5, Vec3::Y, 9.0))
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.5, 1.5)));
    let first = Stage::new(48, 48).draw(&scene);
    let mut stage = Stage::new(48, 48);
    assert_identical("in another App", &first, &stage.draw(&scene));
    assert_identical("in another frame", &first, &stage.float());
    assert!(difference(&first, &stage.draw(&grey(0.0))) > 0.1);
}

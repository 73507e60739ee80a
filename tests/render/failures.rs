//! The message and the files of a failing comparison.

use crate::render::compare::{FLOAT, Failures};
use crate::render::scene::{Scene, Thing, glowing};
use crate::render::stage::Stage;
use halfway::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

#[test]
fn a_failure_says_where_and_how_far_off_and_leaves_pictures() {
    let pane = |x: f32, grey: f32| {
        Scene::in_eye_space()
            .with(Thing::square(Vec3::new(0.0, 0.0, -4.0), Vec3::Z, 9.0).with_material(glowing(0.5, 0.5, 0.5)))
            .with(Thing::square(Vec3::new(x, 0.0, -3.0), Vec3::Z, 0.3).with_material(glowing(0.5, grey, 0.5)))
    };
    let mut stage = Stage::new(16, 16);
    let wrong = stage.draw(&pane(0.2, 0.25));
    stage.draw(&pane(0.2, 0.75));
    let failed = catch_unwind(AssertUnwindSafe(|| {
        let mut failures = Failures::default();
        failures.compare("on purpose", &mut stage, &wrong, FLOAT);
        failures.finish();
    }));
    let message = *failed.expect_err("a quarter is no rounding").downcast::<String>().expect("a message");
    let lines: Vec<&str> = message.lines().collect();
    assert_eq!(lines.len(), 2, "a headline and a line for the row: {message}");
    for part in ["on purpose", "(8, 7)", "green", "0.25", "0.75", "on_purpose"] {
        assert!(lines[1].contains(part), "{part} is missing: {message}");
    }
    for kind in ["actual", "expected", "difference"] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("on_purpose.{kind}.png"));
        let picture = image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!(picture.width() >= 16 && picture.height() >= 16, "{kind}: {} × {}", picture.width(), picture.height());
    }
    let actual =
        image::open(Path::new(env!("CARGO_TARGET_TMPDIR")).join("on_purpose.actual.png")).expect("the picture");
    // 0.25 and 0.5 by the sRGB curve.
    assert_eq!(actual.to_rgb8().get_pixel(8, 7).0, [188, 137, 188]);
}

#[test]
fn nan_and_transparent_pixels_fail() {
    let mut stage = Stage::new(8, 8);
    let good = stage.draw(
        &Scene::in_eye_space().with(Thing::square(Vec3::NEG_Z, Vec3::Z, 9.0).with_material(glowing(0.5, 0.5, 0.5))),
    );
    let rows: [(&str, [f32; 4]); 5] = [
        ("NaN", [f32::NAN, 0.5, 0.5, 1.0]),
        ("infinite", [0.5, f32::INFINITY, 0.5, 1.0]),
        ("negative", [0.5, 0.5, -1e-20, 1.0]),
        ("transparent", [0.5, 0.5, 0.5, 0.5]),
        ("black", [0.0, 0.0, 0.0, 1.0]),
    ];
    for (row, pixel) in rows {
        let mut bad = good.clone();
        bad.put_pixel(3, 2, image::Rgba(pixel));
        let mut failures = Failures::default();
        failures.compare(&format!("on purpose, {row}"), &mut stage, &bad, FLOAT);
        let failed = catch_unwind(AssertUnwindSafe(|| failures.finish()));
        assert!(failed.is_err(), "{row} passed");
    }
}

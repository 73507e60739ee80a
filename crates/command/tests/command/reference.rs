//! The reference renderer, and its judgement of pictures.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;
use std::process::Command;

/// A backend that no system of this kind has, so that no adapter answers.
const NO_BACKEND: &str = if cfg!(target_vendor = "apple") { "dx12" } else { "metal" };

#[test]
fn the_reference_renderer_draws_only_where_it_is_asked_to() {
    let folder = folder("no_adapter");
    let teapot = asset("assets/teapot.obj");
    let without_adapter = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_halfway"))
            .args(arguments)
            .current_dir(&folder)
            .env_remove("HALFWAY_ADAPTER")
            .env("WGPU_BACKEND", NO_BACKEND)
            .output()
            .expect("the command was built with this test")
    };
    // The adapter asked for does not exist.
    for arguments in [&["render", &teapot, "-o", "a.png"][..], &["adapters"], &["verify", &teapot]] {
        let output = without_adapter(arguments);
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(!folder.join("a.png").exists());
    for name in ["--reference", "--adapter=cpu"] {
        let output = without_adapter(&["render", &teapot, "--size", "64x48", "-o", &format!("a{name}.png"), name]);
        assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(folder.join(format!("a{name}.png")).exists(), "{name}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_driver_the_cpu_draws() {
    let folder = folder("no_driver");
    let teapot = asset("assets/teapot.obj");
    let without_driver = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
        for variable in ["HALFWAY_ADAPTER", "WGPU_BACKEND", "WGPU_ADAPTER_NAME", "HALFWAY_SIMD"] {
            command.env_remove(variable);
        }
        // Neither Vulkan nor OpenGL finds any.
        for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS"] {
            command.env(variable, "/dev/null");
        }
        let output = command.args(arguments).current_dir(&folder).output().expect("the command was built");
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let listed = without_driver(&["adapters"]);
    assert!(listed.trim().ends_with("(cpu, software)") && listed.lines().count() == 1, "{listed}");
    let verdict = without_driver(&["verify", &teapot, "--size", "64x48", "--json"]);
    let verdict: serde_json::Value = serde_json::from_str(&verdict).expect("JSON");
    assert_eq!(verdict["device"], listed.trim());
    without_driver(&["render", &teapot, "--size", "64x48", "-o", "a.png"]);
    without_driver(&["render", &teapot, "--size", "64x48", "-o", "b.png", "--adapter", "cpu:plain"]);
    let [a, b] = ["a.png", "b.png"].map(|name| fs::read(folder.join(name)).expect("it was drawn"));
    assert_eq!(a, b, "the same bits with all vectors");
}

#[test]
fn vectors_that_this_cpu_lacks_are_refused() {
    let folder = folder("no_vectors");
    let teapot = asset("assets/teapot.obj");
    let refused = |variable: &str, adapter: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_halfway"))
            .args(["render", &teapot, "-o", "a.png", "--adapter", adapter])
            .current_dir(&folder)
            .env("HALFWAY_SIMD", variable)
            .output()
            .expect("the command was built with this test");
        assert_eq!(output.status.code(), Some(3), "{variable} {adapter}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    for (variable, adapter, says) in [("wide", "cpu", "HALFWAY_SIMD: "), ("", "cpu:wide", "the adapter cpu:wide: ")] {
        let error = refused(variable, adapter);
        assert!(error.contains(says) && error.contains("\"wide\"") && error.contains("plain"), "{error}");
    }
}

#[test]
fn the_reference_renderer_writes_every_format() {
    let folder = folder("reference");
    let teapot = asset("assets/teapot.obj");
    let draw = |more: &[&str]| {
        succeeds(&folder, &[&["render", &teapot, "--size", "64x48", "--reference"], more].concat());
    };
    let draw_one_sample = |more: &[&str]| draw(&[&["--samples", "1"], more].concat());
    draw_one_sample(&["-o", "a.png"]);
    draw_one_sample(&["-o", "b.png", "--bits", "16"]);
    draw_one_sample(&["-o", "c.exr"]);
    draw_one_sample(&["-o", "turn.png", "--turntable", "120", "--frames", "0..3"]);
    draw_one_sample(&["-o", "frame-{}.png", "--turntable", "120", "--frames", "1..2"]);
    // The same picture, rounded to 8 bits, 16 bits and single precision.
    for (a, b) in [("b.png", "a.png"), ("c.exr", "a.png"), ("turn.png", "a.png")] {
        succeeds(&folder, &["compare", a, b, "--max", "0"]);
    }
    let turned = halfway(&folder, &["compare", "frame-0001.png", "a.png", "--max", "0"]);
    assert_eq!(turned.status.code(), Some(4), "the camera turns");
    // A model has four samples unless told otherwise.
    draw(&["-o", "four.png"]);
    draw_one_sample(&["-o", "square.png", "--supersample", "2"]);
    succeeds(&folder, &["compare", "four.png", "square.png", "--max", "0"]);
    assert_eq!(halfway(&folder, &["compare", "four.png", "a.png", "--max", "0"]).status.code(), Some(4));
}

#[test]
fn every_example_scene_is_what_the_reference_renderer_draws() {
    let folder = folder("verify");
    for scene in fs::read_dir(asset("examples/scenes")).expect("the example scenes are there") {
        let path = scene.expect("the folder can be read").path();
        let text = fs::read_to_string(&path).expect("the scene can be read");
        let path = path.to_string_lossy();
        // Cameras that share the picture are judged one by one.
        let cameras = if text.contains("viewport") { &["0", "1", "2", "3"][..] } else { &["0"] };
        for &camera in cameras {
            let own = if cameras.len() > 1 { &["--camera", camera][..] } else { &[] };
            let common = ["verify", &path, "--size", "160x90", "--json", "-o", "difference.png"];
            let json = succeeds(&folder, &[&common[..], own].concat());
            let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
            assert_eq!(json["float"]["within"], true, "{path}, camera {camera}: {json}");
            assert!(json["bytes"]["counted"].as_f64().is_some_and(|share| share > 0.02), "{path}: {json}");
            assert!(json["bytes"]["edges"].as_f64().is_some_and(|share| share < 0.02), "{path}: {json}");
            let difference = image::open(folder.join("difference.png")).expect("the difference was drawn");
            assert_eq!(difference.width(), 320, "160 pixels, each shown as 2 × 2");
        }
    }
}

#[test]
fn a_given_picture_is_judged_without_an_adapter() {
    let folder = folder("given");
    let scene = asset("examples/scenes/transforms.json");
    for name in ["given.png", "given.exr"] {
        let look = [scene.as_str(), "--samples", "1", "--size", "96x54"];
        succeeds(&folder, &[&["render"], &look[..], &["--reference", "-o", name]].concat());
        let json = succeeds(&folder, &[&["verify"], &look[..3], &["--picture", name, "--json"]].concat());
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!((&json["verdict"]["within"], &json["size"][0]), (&true.into(), &96.into()), "{json}");
    }
    // One pixel of the brightest object turns black.
    let mut picture = image::open(folder.join("given.png")).expect("it was drawn").into_rgb8();
    let brightest = picture.enumerate_pixels().max_by_key(|(_, _, p)| p.0.iter().map(|c| u32::from(*c)).sum::<u32>());
    let (x, y, _) = brightest.expect("there are pixels");
    picture.put_pixel(x, y, image::Rgb([0; 3]));
    picture.save(folder.join("wrong.png")).expect("the folder can be written");
    let wrong = halfway(&folder, &["verify", &scene, "--samples", "1", "--picture", "wrong.png"]);
    assert_eq!(wrong.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains(&format!("({x}, {y})")), "{wrong:?}");
    let size = halfway(&folder, &["verify", &scene, "--picture", "wrong.png", "--size", "64x48"]);
    assert_eq!(size.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&size.stderr).contains("96 × 54 pixels; expected 64 × 48"), "{size:?}");
}

#[test]
fn comparisons_are_printed_and_drawn() {
    let folder = folder("compare");
    let grey = |name: &str, changed: [u8; 3]| {
        let mut picture = image::RgbImage::from_pixel(8, 6, image::Rgb([16; 3]));
        for x in 2..6 {
            picture.put_pixel(x, 3, image::Rgb([120; 3]));
        }
        picture.put_pixel(4, 3, image::Rgb(changed));
        picture.save(folder.join(name)).expect("the folder can be written");
    };
    grey("expected.png", [120; 3]);
    grey("off.png", [120, 127, 120]);
    grey("hole.png", [16; 3]);

    let table = succeeds(&folder, &["compare", "off.png", "expected.png", "-o", "difference.png", "--max", "7"]);
    for part in ["8 × 6 pixels", "4 pixels that both cover", "(4, 3) green: 127 instead of 120", "75.000 %", "ꟻLIP"]
    {
        assert!(table.contains(part), "{part} is missing in:\n{table}");
    }
    let difference = image::open(folder.join("difference.png")).expect("the difference was drawn").into_rgb8();
    assert_eq!(difference.width(), 320, "8 pixels, each shown as 40 × 40");
    assert_ne!(difference.get_pixel(4 * 40, 3 * 40), difference.get_pixel(3 * 40, 3 * 40));

    let over = halfway(&folder, &["compare", "off.png", "expected.png", "--max", "6"]);
    assert_eq!(over.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&over.stderr).contains("(4, 3) green"), "{over:?}");

    let json = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_str(&succeeds(&folder, &[&["compare"], arguments, &["--json"]].concat())).expect("JSON")
    };
    let hole = json(&["hole.png", "expected.png"]);
    assert_eq!((&hole["coverage"]["only_expected"], &hole["counted"]), (&1.into(), &3.into()), "{hole}");
    assert_eq!((&hole["steps"]["all"]["max"], &hole["anywhere"]["steps"]), (&0.0.into(), &104.into()), "{hole}");
    // Where another colour is the background, the hole is a wrong pixel like any other.
    let hole = json(&["hole.png", "expected.png", "--background", "1,1,1"]);
    assert_eq!((&hole["counted"], &hole["steps"]["all"]["max"]), (&48.into(), &104.0.into()), "{hole}");
    // 120 of 255 is 0.1878 by the curve of sRGB (by hand) and 0.4706 as it is.
    for (raw, expected) in [(&[][..], 0.1878), (&["--raw"][..], 120.0 / 255.0)] {
        let json = json(&[&["off.png", "expected.png"], raw].concat());
        let worst = json["linear"]["green"]["worst"]["expected"].as_f64().expect("a number");
        assert!((worst - expected).abs() < 1e-4, "{worst}");
    }
}

#[test]
fn the_reference_has_quantities_too() {
    let folder = folder("reference_quantities");
    let cube = asset("assets/cube.smf");
    let common = ["render", &cube, "--size", "48x32", "-o"];
    succeeds(
        &folder,
        &[
            &common[..],
            &["a.png", "--adapter", "cpu", "--samples", "1", "--also", "id=a_id.png,eye-normal=a_n.png,albedo=a_a.png"],
        ]
        .concat(),
    );
    let also = "id=b_id.png,eye-normal=b_n.png,albedo=b_a.png";
    succeeds(&folder, &[&common[..], &["b.png", "--samples", "1", "--reference", "--also", also]].concat());
    for (of_adapter, of_reference) in [("a_id.png", "b_id.png"), ("a_n.png", "b_n.png"), ("a_a.png", "b_a.png")] {
        let [a, b] = [of_adapter, of_reference].map(|name| image::open(folder.join(name)).expect("it was written"));
        let [a, b] = [a, b].map(image::DynamicImage::into_rgb8);
        let apart = a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
        assert!(apart <= 4, "{of_reference}: {apart} pixels differ");
    }
}

#[test]
fn a_term_beside_the_picture_is_that_term_alone() {
    let folder = folder("a_term_beside");
    let cube = asset("assets/cube.smf");
    for drawer in [&["--adapter", "cpu"][..], &["--reference"]] {
        let render = |arguments: &[&str]| {
            succeeds(&folder, &[&["render", &cube, "--size", "48x32"], drawer, arguments].concat());
        };
        render(&["-o", "whole.png", "--also", "diffuse=beside.exr,id=id.png,specular=highlights.png"]);
        render(&["-o", "alone.exr", "--only", "diffuse"]);
        render(&["-o", "plain.png"]);
        let bytes = |name: &str| std::fs::read(folder.join(name)).expect("it was written");
        assert!(bytes("beside.exr") == bytes("alone.exr"), "{drawer:?}");
        assert!(bytes("whole.png") == bytes("plain.png"), "{drawer:?}");
        assert!(bytes("highlights.png") != bytes("plain.png"), "{drawer:?}");
    }
    for (arguments, expected) in [
        (&["--also", "diffuse=d.png", "--only", "specular"][..], "one term only"),
        (&["--also", "diffuse=d.exr,depth=d.exr"], "a file of its own"),
        (&["--also", "diffuse=d.png", "--turntable", "4"], "--only diffuse"),
    ] {
        let output = halfway(&folder, &[&["render", &cube, "--size", "8x8", "-o", "x.png"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(expected), "{said}");
    }
}

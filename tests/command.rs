//! The `halfway` command from outside: what it writes, and how it refuses what it cannot use.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for each test, empty at the start.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

fn halfway(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfway"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the command was built with this test")
}

fn asset(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name).to_string_lossy().into_owned()
}

#[track_caller]
fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = halfway(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {:?}: {error}", output.status);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn pictures_in_every_format_show_the_same_teapot() {
    let folder = folder("formats");
    let teapot = asset("assets/teapot.obj");
    let common = ["render", &teapot, "--size", "64x48", "-o"];
    for rest in [["a.png", "--bits", "8"], ["b.png", "--bits", "16"], ["c.exr", "--bits", "32"]] {
        succeeds(&folder, &[&common[..], &rest].concat());
    }
    let open = |name: &str| image::open(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (a, b, c) = (open("a.png").into_rgb8(), open("b.png").into_rgb16(), open("c.exr").into_rgb32f());
    assert_eq!([a.dimensions(), b.dimensions(), c.dimensions()], [(64, 48); 3]);
    let encode = |linear: f32| {
        let clamped = linear.clamp(0.0, 1.0);
        if clamped <= 0.003_130_8 { clamped * 12.92 } else { 1.055 * clamped.powf(1.0 / 2.4) - 0.055 }
    };
    for ((a, b), c) in a.pixels().zip(b.pixels()).zip(c.pixels()) {
        for k in 0..3 {
            let [eight, sixteen, float] = [f32::from(a[k]) / 255.0, f32::from(b[k]) / 65535.0, encode(c[k])];
            // An adapter may round a step of 8 bits to either side (Vulkan: within 0.6 of a step for sRGB).
            assert!((eight - float).abs() <= 1.1 / 255.0, "8 bits {eight}, float {float}");
            assert!((sixteen - float).abs() <= 1.0 / 65535.0, "16 bits {sixteen}, float {float}");
        }
    }
    assert!(a.pixels().any(|pixel| pixel.0.iter().any(|&value| value > 100)), "there is something to see");
}

#[test]
fn shadings_differ_and_samples_smooth_edges() {
    let folder = folder("look");
    let teapot = asset("assets/teapot.obj");
    let draw = |name: &str, more: &[&str]| {
        let common = ["render", &teapot, "--size", "96x64", "-o", name];
        succeeds(&folder, &[&common[..], more].concat());
        image::open(folder.join(name)).expect("the picture was written").into_rgb8()
    };
    let pictures = [
        draw("flat.png", &["--shading", "flat"]),
        draw("gouraud.png", &["--shading", "gouraud"]),
        draw("phong.png", &["--shading", "phong"]),
        draw("reflectance.png", &["--reflectance", "phong"]),
        draw("samples.png", &["--samples", "4"]),
    ];
    for (i, a) in pictures.iter().enumerate() {
        for b in &pictures[i + 1..] {
            assert_ne!(a, b);
        }
    }
}

#[test]
fn frames_become_an_animation_or_a_file_each() {
    let folder = folder("frames");
    let cube = asset("assets/cube.smf");
    let common = ["render", &cube, "--size", "32x32", "--frames"];
    succeeds(&folder, &[&common[..], &["0..3", "-o", "turn.png", "--contact-sheet", "sheet.png"]].concat());
    let animation = fs::read(folder.join("turn.png")).expect("the animation was written");
    let chunks = |name: &[u8]| animation.windows(4).filter(|bytes| *bytes == name).count();
    assert_eq!((chunks(b"acTL"), chunks(b"fcTL")), (1, 3), "an animated PNG of three frames");
    assert!(image::open(folder.join("sheet.png")).is_ok());
    succeeds(&folder, &[&common[..], &["10..12", "-o", "frame-{}.png"]].concat());
    let frames = ["frame-0010.png", "frame-0011.png"].map(|name| fs::read(folder.join(name)).expect("a file each"));
    assert_ne!(frames[0], frames[1], "the camera turns");
    assert!(!folder.join("frame-0009.png").exists() && !folder.join("frame-0012.png").exists());
}

#[test]
fn every_example_scene_renders() {
    let folder = folder("scenes");
    let scenes = fs::read_dir(asset("examples/scenes")).expect("the example scenes are there");
    let mut count = 0;
    for scene in scenes {
        let path = scene.expect("the folder can be read").path();
        succeeds(&folder, &["render", &path.to_string_lossy(), "--size", "64x36", "-o", "scene.png"]);
        let picture = image::open(folder.join("scene.png")).expect("the picture was written").into_rgb8();
        let first = picture.get_pixel(0, 0);
        assert!(picture.pixels().any(|pixel| pixel != first), "{}: one flat colour", path.display());
        count += 1;
    }
    assert!(count >= 5, "{count} scenes");
}

#[test]
fn info_schema_and_adapters_say_what_they_promise() {
    let folder = folder("info");
    let info = succeeds(&folder, &["info", &asset("assets/lantern.glb")]);
    for expected in ["triangles  1896", "bounds", "metallic-roughness", "light", "problems"] {
        assert!(info.contains(expected), "{expected} is missing in:\n{info}");
    }
    let schema = succeeds(&folder, &["schema"]);
    let committed = fs::read_to_string(asset("docs/scene.schema.json")).expect("the schema is committed");
    assert_eq!(schema.trim(), committed.trim());
    assert!(!succeeds(&folder, &["adapters"]).trim().is_empty());
}

#[test]
fn a_benchmark_prints_a_row_for_each_shading() {
    let folder = folder("bench");
    let json = succeeds(&folder, &["bench", "s4", "--rounds", "1", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let rows = value["rows"].as_array().expect("rows");
    let shadings: Vec<_> = rows.iter().map(|row| row["shading"].as_str().unwrap_or("")).collect();
    assert_eq!(shadings, ["constant", "flat", "gouraud", "phong"]);
    for row in rows {
        for figure in ["frame_ms", "ratio_to_constant", "first_frame_ms"] {
            assert!(row[figure].as_f64().is_some_and(|value| value > 0.0), "{figure} in {row}");
        }
    }
}

/// A backend that no system of this kind has, so that no adapter answers.
const NO_BACKEND: &str = if cfg!(target_vendor = "apple") { "dx12" } else { "metal" };

#[test]
fn without_an_adapter_the_reference_renderer_draws_and_says_so() {
    let folder = folder("no_adapter");
    let teapot = asset("assets/teapot.obj");
    let without_adapter = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_halfway"))
            .args(arguments)
            .current_dir(&folder)
            .env("WGPU_BACKEND", NO_BACKEND)
            .output()
            .expect("the command was built with this test")
    };
    let output = without_adapter(&["render", &teapot, "--size", "64x48", "-o", "fallback.png"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    assert!(error.contains("no graphics adapter: drawn by the reference renderer on the CPU"), "{error}");
    let output = without_adapter(&["render", &teapot, "--size", "64x48", "-o", "reference.png", "--reference"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let [a, b] = ["fallback.png", "reference.png"].map(|name| fs::read(folder.join(name)).expect("it was drawn"));
    assert_eq!(a, b);
    for arguments in [&["adapters"][..], &["verify", &teapot]] {
        assert_eq!(without_adapter(arguments).status.code(), Some(3), "{arguments:?}");
    }
}

#[test]
fn the_reference_renderer_writes_every_format() {
    let folder = folder("reference");
    let teapot = asset("assets/teapot.obj");
    let draw = |more: &[&str]| {
        succeeds(&folder, &[&["render", &teapot, "--size", "64x48", "--reference"], more].concat());
    };
    draw(&["-o", "a.png"]);
    draw(&["-o", "b.png", "--bits", "16"]);
    draw(&["-o", "c.exr"]);
    draw(&["-o", "turn.png", "--frames", "0..3"]);
    draw(&["-o", "frame-{}.png", "--frames", "1..2"]);
    // The same picture, rounded to 8 bits, 16 bits and single precision.
    for (a, b) in [("b.png", "a.png"), ("c.exr", "a.png"), ("turn.png", "a.png")] {
        succeeds(&folder, &["compare", a, b, "--max", "0"]);
    }
    let turned = halfway(&folder, &["compare", "frame-0001.png", "a.png", "--max", "0"]);
    assert_eq!(turned.status.code(), Some(4), "the camera turns");
    draw(&["-o", "four.png", "--samples", "4"]);
    draw(&["-o", "square.png", "--supersample", "2"]);
    succeeds(&folder, &["compare", "four.png", "square.png", "--max", "0"]);
    assert_eq!(halfway(&folder, &["compare", "four.png", "a.png", "--max", "0"]).status.code(), Some(4));
}

#[test]
fn every_example_scene_is_what_the_reference_renderer_draws() {
    let folder = folder("verify");
    for scene in fs::read_dir(asset("examples/scenes")).expect("the example scenes are there") {
        let path = scene.expect("the folder can be read").path();
        let path = path.to_string_lossy();
        // An 8-bit target rounds after each blended layer, and there are two of them on the table.
        let max = if path.ends_with("moonlit_table.json") { "2" } else { "1" };
        let common = ["verify", &path, "--size", "160x90", "--json", "-o", "difference.png", "--max", max];
        let json: serde_json::Value = serde_json::from_str(&succeeds(&folder, &common)).expect("JSON");
        assert_eq!(json["float"]["within"], true, "{path}: {json}");
        assert!(json["bytes"]["counted"].as_f64().is_some_and(|share| share > 0.02), "{path}: {json}");
        assert!(json["bytes"]["edges"].as_f64().is_some_and(|share| share < 0.02), "{path}: {json}");
        let difference = image::open(folder.join("difference.png")).expect("the difference was drawn");
        assert_eq!(difference.width(), 320, "160 pixels, each shown as 2 × 2");
    }
}

#[test]
fn what_is_compared_is_said_and_shown() {
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
    for part in ["8 × 6 pixels", "4 pixels that both cover", "(4, 3) green: 127 instead of 120", "75.000 %", "ꟻLIP"] {
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

/// What a user may hand to the command, and what has to be in the answer.
#[test]
fn bad_input_is_named_and_ends_with_exit_code_2() {
    let folder = folder("bad");
    let glb = fs::read(asset("assets/lantern.glb")).expect("the asset is there");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).expect("the folder can be written");
    write("truncated.glb", &glb[..glb.len() / 2]);
    write("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    write("index.smf", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n");
    write("nan.smf", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    write("empty.obj", b"");
    write("text.png", b"no picture");
    for (name, side) in [("2.png", 2), ("3.png", 3)] {
        image::RgbImage::new(side, 3).save(folder.join(name)).expect("the folder can be written");
    }
    write("absurd.gltf", ABSURD_COUNT.as_bytes());
    for (name, text) in SCENES {
        write(name, text.as_bytes());
    }
    let cases: &[(&[&str], &[&str])] = &[
        (&["render", "missing.obj", "-o", "a.png"], &["missing.obj"]),
        (&["info", "missing.obj"], &["missing.obj"]),
        (&["render", "missing.json", "-o", "a.png"], &["missing.json"]),
        (&["render", "truncated.glb", "-o", "a.png"], &["truncated.glb"]),
        (&["render", "index.obj", "-o", "a.png"], &["index.obj:4"]),
        (&["render", "index.smf", "-o", "a.png"], &["index.smf:4"]),
        (&["render", "nan.smf", "-o", "a.png"], &["nan.smf:2"]),
        (&["render", "empty.obj", "-o", "a.png"], &["empty.obj"]),
        (&["info", "absurd.gltf"], &["absurd.gltf"]),
        (&["render", "light.json", "-o", "a.png"], &["light.json:2:", "lights[0].attenuation"]),
        (&["render", "size.json", "-o", "a.png"], &["size.json:2:", "size[0]"]),
        (&["render", "sphere.json", "-o", "a.png"], &["sphere.json:2:", "segments"]),
        (&["render", "unknown.json", "-o", "a.png"], &["unknown.json:3:", "shadig"]),
        (&["render", "auto.json", "-o", "a.png"], &["shading.auto", "not yet"]),
        (&["render", "tone.json", "-o", "a.png"], &["intensity", "not yet"]),
        (&["render", "model.json", "-o", "a.png"], &["model.json", "objects[0].mesh.path", "nowhere.obj"]),
        (&["render", "fine.json", "-o", "a.bmp"], &["a.bmp", ".png or .exr"]),
        (&["render", "fine.json", "-o", "a.png", "--bits", "12"], &["a.png", "8 or 16"]),
        (&["render", "fine.json", "-o", "a.png", "--size", "0x9"], &["0x9"]),
        (&["render", "fine.json", "-o", "a.png", "--size", "99999x9"], &["99999x9"]),
        (&["render", "fine.json", "-o", "a.png", "--frames", "3..3"], &["A below B"]),
        (&["render", "fine.json", "-o", "a.png", "--shading", "cel"], &["cel", "gouraud"]),
        (&["render", "fine.json", "-o", "fine.json/a.png"], &["fine.json/a.png"]),
        (&["render", "fine.json", "-o", "a.png", "--surface"], &["--reference"]),
        (&["render", "fine.json", "-o", "a.png", "--reference", "--supersample", "0"], &["--supersample", "1..=16"]),
        (&["render", "missing.obj", "-o", "a.png", "--reference"], &["missing.obj"]),
        (&["compare", "missing.png", "2.png"], &["missing.png"]),
        (&["compare", "text.png", "2.png"], &["text.png", "expected a PNG or EXR"]),
        (&["compare", "2.png", "3.png"], &["2.png and 3.png", "2 × 3", "3 × 3"]),
        (&["compare", "2.png", "2.png", "--background", "1,2"], &["1,2", "three linear intensities"]),
        (&["compare", "2.png", "2.png", "-o", "a.bmp"], &["a.bmp", ".png or .exr"]),
        (&["verify", "missing.json"], &["missing.json"]),
        (&["paint"], &["paint"]),
    ];
    for (arguments, expected) in cases {
        let output = halfway(&folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        for part in *expected {
            assert!(error.contains(part), "{arguments:?}: {part} is missing in: {error}");
        }
        assert!(!error.contains("panicked"), "{arguments:?}: {error}");
        assert!(!folder.join("a.png").exists(), "{arguments:?} left a picture");
    }
}

const SCENES: &[(&str, &str)] = &[
    ("fine.json", r#"{"objects": [{"mesh": {"teapot": {"divisions": 2}}}]}"#),
    ("light.json", "{\n\"lights\": [{\"kind\": \"point\", \"attenuation\": [0, 0, -1]}]}"),
    ("size.json", "{\n\"size\": [0, 4]}"),
    ("sphere.json", "{\n\"objects\": [{\"mesh\": {\"uv_sphere\": {\"segments\": 4000000000}}}]}"),
    ("unknown.json", "{\n\"objects\": [],\n\"shadig\": \"flat\"}"),
    ("auto.json", r#"{"shading": {"auto": {"tolerance": 1.0}}}"#),
    ("tone.json", r#"{"intensity": "aces"}"#),
    ("model.json", r#"{"objects": [{"mesh": {"path": "nowhere.obj"}}]}"#),
];

/// Four thousand million vertices in twelve bytes.
const ABSURD_COUNT: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4000000000, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 1]}],
    "bufferViews": [{"buffer": 0, "byteLength": 12}],
    "buffers": [{"byteLength": 12, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]}"#;

#[test]
fn convert_changes_formats_and_says_what_is_lost() {
    let folder = folder("convert");
    let said = succeeds(&folder, &["convert", &asset("assets/teapot.obj"), "teapot.smf"]);
    assert!(said.contains("teapot.smf: 5 parts") && said.contains("lost       1 materials"), "{said}");
    let said = succeeds(&folder, &["convert", "teapot.smf", "teapot.glb"]);
    assert!(said.contains("teapot.glb: 1 parts") && !said.contains("lost"), "{said}");
    for (arguments, expected) in [
        (["convert", "teapot.smf", "teapot.stl"], "names no format that is written; smf, obj or glb is expected"),
        (["convert", "gone.smf", "teapot.obj"], "gone.smf: cannot be read"),
    ] {
        let output = halfway(&folder, &arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(expected), "{arguments:?}: {error}");
    }
    assert!(!folder.join("teapot.obj").exists() && !folder.join("teapot.stl").exists());
}

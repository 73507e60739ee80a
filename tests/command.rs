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

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

/// What `halfway` prints as JSON.
fn json_of(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let value: serde_json::Value = serde_json::from_str(&succeeds(folder, arguments)).expect("JSON");
    for name in ["adapter", "backend", "driver", "driver_version", "halfway", "cpu"] {
        assert!(value["machine"][name].as_str().is_some_and(|text| !text.is_empty()), "{name} in {value}");
    }
    value
}

/// The figures are positive, and the times lie in order.
fn is_timed(row: &serde_json::Value) {
    let spread = &row["frame_ms_spread"];
    let times: Vec<_> = ["min", "lower_quartile", "median", "upper_quartile", "max"]
        .into_iter()
        .map(|name| spread[name].as_f64().unwrap_or(f64::NAN))
        .collect();
    assert!(times[0] > 0.0 && times.is_sorted(), "{row}");
    assert_eq!(row["frame_ms"], spread["median"]);
    // Two frames a round.
    assert_eq!(spread["frames"], 2);
}

#[test]
fn a_benchmark_prints_a_row_for_each_shading() {
    let folder = folder("bench");
    let value = json_of(&folder, &["bench", "s4", "--rounds", "1", "--cold", "--json"]);
    assert_eq!(value["size"], serde_json::json!([256, 256]));
    let rows = value["rows"].as_array().expect("rows");
    let shadings: Vec<_> = rows.iter().map(|row| row["shading"].as_str().unwrap_or("")).collect();
    assert_eq!(shadings, ["constant", "flat", "gouraud", "phong"]);
    for row in rows {
        is_timed(row);
        for figure in ["ratio_to_constant", "first_frame_ms", "first_frame_cold_ms"] {
            assert!(row[figure].as_f64().is_some_and(|value| value > 0.0), "{figure} in {row}");
        }
        // One sphere of 64 × 32 cells, and nothing moves; its levels are made, and it is drawn in patches.
        let counts = [("triangles_in", 3968), ("bytes_uploaded", 0), ("pipelines", 1), ("levels_pending", 0)];
        for (count, expected) in counts {
            assert_eq!(row["report"][count], expected, "{count} in {row}");
        }
        assert_eq!((&row["report"]["lights_assigned"], &row["report"]["left_out"]), (&0.into(), &0.0.into()), "{row}");
        let sets = row["cpu_ms"].as_object().expect("the time of each set");
        assert!(sets.len() == 10 && sets.values().all(|ms| ms.as_f64().is_some_and(|ms| ms >= 0.0)), "{row}");
        assert!(row["cpu_ms"]["total"].as_f64() <= row["frame_ms_spread"]["max"].as_f64(), "{row}");
    }
    let table = succeeds(&folder, &["bench", "s4", "--rounds", "1"]);
    for text in
        ["256 × 256 pixels", "detail: within 0.5 pixels", "driver: ", "App::update", "own CPU, ms", "| phong | "]
    {
        assert!(table.contains(text), "{text} is missing in:\n{table}");
    }
}

#[test]
fn levels_of_detail_are_for_whoever_asks() {
    let folder = folder("levels");
    let bench = |levels: &[&str]| {
        json_of(&folder, &[&["bench", "s4", "--size", "16x16", "--rounds", "1", "--json"], levels].concat())
    };
    let drawn = |value: &serde_json::Value| -> Vec<u64> {
        let rows = value["rows"].as_array().expect("rows");
        rows.iter().map(|row| row["report"]["triangles"].as_u64().expect("a count")).collect()
    };
    let [off, default, coarse] = [&["--levels", "off"][..], &[], &["--levels", "4"]].map(bench);
    assert_eq!((&off["levels"]["pixels"], &coarse["levels"]["pixels"]), (&0.0.into(), &4.0.into()));
    let [off, default, coarse] = [off, default, coarse].map(|value| drawn(&value));
    assert!(coarse.iter().zip(&default).all(|(coarse, default)| coarse <= default), "{default:?}, {coarse:?}");
    assert!(default.iter().zip(&off).all(|(default, off)| default <= off), "{off:?}, {default:?}");
    // In a constant colour only the outline counts, and on 16 pixels that is soon fine enough.
    assert!(default[0] < off[0] / 2, "{off:?}, {default:?}");

    let render = ["render", &asset("assets/teapot.obj"), "--size", "32x32", "-o", "turn.png"];
    succeeds(&folder, &[&render[..], &["--frames", "0..3", "--levels", "2.5"]].concat());
    succeeds(&folder, &[&render[..], &["--levels", "off"]].concat());
    for bad in ["on", "-1", "inf", ""] {
        let levels = format!("--levels={bad}");
        let output = halfway(&folder, &[&render[..], &[&levels]].concat());
        assert_eq!(output.status.code(), Some(2), "{bad}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("--levels <PIXELS|off>"), "{output:?}");
    }
}

#[test]
fn features_are_timed_beside_a_baseline() {
    let folder = folder("bench_features");
    let value = json_of(&folder, &["bench", "features", "--rounds", "1", "--json"]);
    let rows = value["rows"].as_array().expect("rows");
    let row = |name: &str| rows.iter().find(|row| row["feature"] == name).unwrap_or_else(|| panic!("no row {name}"));
    let baseline = row("one directional light (the baseline)");
    for stage in ["vertex", "fragment"] {
        for row in rows {
            is_timed(&row[stage]);
        }
        assert_eq!(baseline[stage]["ratio_to_baseline"], 1.0);
        // As many as were asked for shine, and only what is compared by lights has a cost by lights.
        for (name, lights) in [("no lights", 0), ("five point lights", 5), ("sixteen directional lights", 16)] {
            assert_eq!(row(name)[stage]["report"]["lights"], lights, "{name}");
        }
        assert!(row("five spot lights")[stage]["light_ns"].is_f64());
        assert!(row("no lights")[stage]["light_ns"].is_null() && row("four samples")[stage]["light_ns"].is_null());
    }
    // A plane of 360 × 360 cells that faces the camera: nothing is left out of it.
    assert_eq!(baseline["vertex"]["report"]["triangles"], 360 * 360 * 2);
    assert_eq!(baseline["vertex"]["report"]["patches_culled"], 0);
    let output = halfway(&folder, &["bench", "features", "--size", "64x64"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no option but --rounds and --json"));
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

/// What a user may hand to the command, and what has to be in the answer.
#[test]
fn quantised_models_are_smaller_and_say_how_far_off() {
    let folder = folder("quantise");
    let teapot = asset("assets/teapot.obj");
    succeeds(&folder, &["convert", &teapot, "floats.glb"]);
    let said = succeeds(&folder, &["convert", &teapot, "shorts.glb", "--quantise"]);
    assert!(said.contains("quantise   positions moved by at most 4."), "{said}");
    let bytes = |name: &str| fs::metadata(folder.join(name)).expect("it was written").len();
    assert!(bytes("shorts.glb") * 10 < bytes("floats.glb") * 7);
    let refused = halfway(&folder, &["convert", &teapot, "no.obj", "--quantise"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(!folder.join("no.obj").exists());
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_is_no_panic() {
    let (reader, writer) = std::io::pipe().expect("a pipe can be made");
    drop(reader);
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
    let child = command.arg("schema").stdout(writer).stderr(std::process::Stdio::piped()).spawn();
    let output = child.and_then(std::process::Child::wait_with_output).expect("the command was built with this test");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(std::os::unix::process::ExitStatusExt::signal(&output.status), Some(libc::SIGPIPE));
}

#[test]
fn bad_input_is_named_and_ends_with_exit_code_2() {
    let folder = folder("bad");
    let glb = fs::read(asset("assets/lantern.glb")).expect("the asset is there");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).expect("the folder can be written");
    write("truncated.glb", &glb[..glb.len() / 2]);
    write("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    write("index.smf", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n");
    write("fine.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
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
        (&["convert", "index.obj", "b.glb"], &["index.obj:4"]),
        (&["convert", "fine.obj", "b.glb", "--weld=-1"], &["--weld", "a finite length, not below 0"]),
        (&["convert", "fine.obj", "b.glb", "--max-error", "inf"], &["--max-error", "a finite length"]),
        (&["convert", "fine.obj", "b.glb", "--simplify", "few"], &["--simplify", "few"]),
        (&["convert", "fine.obj", "b.glb", "--subdivide", "4"], &["--subdivide", "midpoint=N or loop=N"]),
        (&["convert", "fine.obj", "b.glb", "--subdivide", "loop=40"], &["fine.obj", "after 40 subdivisions"]),
        (&["convert", "fine.obj", "b.glb", "--normals", "creased=181"], &["--normals", "from 0 to 180"]),
        (&["convert", "fine.obj", "b.glb", "--weld=9"], &["fine.obj", "no triangle is left"]),
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
        assert!(!folder.join("b.glb").exists(), "{arguments:?} left a model");
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

/// What a line of what was said begins with, and the numbers in it.
#[track_caller]
fn numbers(said: &str, step: &str) -> Vec<f64> {
    let line = said.lines().find(|line| line.starts_with(step)).unwrap_or_else(|| panic!("no {step} in:\n{said}"));
    line.split([' ', ',', ';']).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn convert_takes_the_steps_that_are_asked_for() {
    let folder = folder("convert_steps");
    // A cube whose squares share no vertices, one of them wound inside out, with a triangle too many and one of no area.
    let corners = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [5, 7, 3, 1]];
    let vertices = corners.iter().flatten().map(|i| format!("v {} {} {}\n", i >> 2, i >> 1 & 1, i & 1));
    let faces = (0..6).map(|i| 4 * i + 1).map(|i| format!("f {} {} {} {}\n", i, i + 1, i + 2, i + 3));
    let cube = vertices.chain(faces).chain(["f 1 2 3\nf 1 2 2\n".to_owned()]).collect::<String>();
    fs::write(folder.join("cube.obj"), cube).expect("the folder can be written");
    let said =
        succeeds(&folder, &["convert", "cube.obj", "cube.smf", "--weld=0.001", "--repair", "--normals", "creased=60"]);
    assert_eq!(numbers(&said, "weld")[..2], [16.0, 24.0], "{said}");
    assert_eq!(numbers(&said, "normals")[..2], [8.0, 24.0], "each corner has three normals: {said}");
    let info = succeeds(&folder, &["info", "cube.smf"]);
    for expected in ["12 triangles, 24 vertices at 8 positions", "1 closed, 0 of them inside out", "problems   none"] {
        assert!(info.contains(expected), "{expected} is missing in:\n{info}");
    }
    assert!(info.contains("volume 1.000000e0") && !info.contains("levels"), "{info}");

    // The teapot of 4032 triangles in five parts, refined and coarsened: all parts together come to what was asked for.
    let teapot = asset("assets/teapot.obj");
    let said = succeeds(&folder, &["convert", &teapot, "a.glb", "--subdivide", "midpoint=1", "--simplify", "2000"]);
    assert_eq!(numbers(&said, "subdivide"), [4032.0, 4.0 * 4032.0], "{said}");
    let [_, after, error] = numbers(&said, "simplify")[..] else { panic!("three numbers in {said}") };
    assert_eq!(numbers(&said, "simplify")[..1], [4.0 * 4032.0], "{said}");
    assert!((1900.0..=2100.0).contains(&after) && error > 0.0, "{said}");
    assert!(said.contains(&format!("a.glb: 5 parts, {after} triangles")), "{said}");

    // Without a distance only vertices that are equal in everything are one.
    let said = succeeds(&folder, &["convert", "cube.smf", "same.smf", "--weld"]);
    assert_eq!(numbers(&said, "weld")[..2], [0.0, 24.0], "normals differ: {said}");

    // An error bound by itself is kept to.
    let said =
        succeeds(&folder, &["convert", &teapot, "b.glb", "--max-error", "0.02", "--normals", "face", "--optimize"]);
    let [before, after, error] = numbers(&said, "simplify")[..] else { panic!("three numbers in {said}") };
    assert!(after < 0.75 * before && error <= 0.02, "{said}");
    assert_eq!(numbers(&said, "normals")[1..], [3.0 * after], "three vertices a face: {said}");

    // Parts of a lantern that share a mesh go on sharing it; a part smaller than the distance goes, and that is said.
    let lantern = asset("assets/lantern.glb");
    let said = succeeds(&folder, &["convert", &lantern, "c.glb", "--weld=0.3"]);
    assert!(said.contains("lost       part \"bar\", of which no triangle is left"), "{said}");
    assert!(said.contains("c.glb: 6 parts"), "{said}");
    let size = |name: &str| fs::metadata(folder.join(name)).expect("it was written").len();
    succeeds(&folder, &["convert", &lantern, "d.glb"]);
    succeeds(&folder, &["convert", &lantern, "e.glb", "--normals", "max"]);
    assert_eq!(size("d.glb"), size("e.glb"), "normals are replaced, and nothing is written twice");
}

#[test]
fn info_prints_cameras_and_levels() {
    let folder = folder("info_more");
    let gltf = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "name": "eye"}, {"camera": 1}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
            {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1.5, "znear": 0, "zfar": 10}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri":
            "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    fs::write(folder.join("cameras.gltf"), gltf).expect("the folder can be written");
    let info = succeeds(&folder, &["info", "cameras.gltf", "--levels"]);
    // 0.5 rad is 28.6479°; the magnifications of glTF are halves.
    for expected in [
        "camera     \"eye\": perspective, 28.6479° high, aspect the picture's, from 0.1 to infinity",
        "orthographic, 4 × 3, from 0 to 10",
        "1, 0.00e0, 0.00°, 0.00°",
    ] {
        assert!(info.contains(expected), "{expected} is missing in:\n{info}");
    }
}

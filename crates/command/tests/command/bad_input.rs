//! Bad input of users, and the required parts of the messages.

use crate::command::{asset, folder, halfway};
use std::fs;
use std::process::Command;

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
    let past = |name: &str| fs::read(asset(&format!("crates/texture/tests/past_failures/{name}"))).expect("it is kept");
    write("palette.png", &past("a_palette_that_ends_within_a_color.png"));
    for (name, side) in [("2.png", 2), ("3.png", 3)] {
        image::RgbImage::new(side, 3).save(folder.join(name)).expect("the folder can be written");
    }
    write("absurd.gltf", ABSURD_COUNT.as_bytes());
    for (name, text) in SCENES {
        write(name, text.as_bytes());
    }
    for pipe in ["pipe.json", "pipe.png"] {
        #[cfg(unix)]
        assert!(Command::new("mkfifo").arg(folder.join(pipe)).status().is_ok_and(|status| status.success()));
        #[cfg(not(unix))]
        fs::create_dir_all(folder.join(pipe)).expect("the folder can be written");
    }
    let cases: &[(&[&str], &[&str])] = &[
        (&["render", "pipe.json", "-o", "a.png"], &["pipe.json", "not a regular file"]),
        (&["render", "fine.json", "-o", "a.exr", "--turntable", "2"], &["a.exr", ".png or .apng"]),
        (&["render", "fine.json", "-o", "a.png", "--contact-sheet", "./a.png"], &["a.png", "contact sheet"]),
        (
            &["render", "fine.json", "-o", "turn-{}.png", "--turntable", "2", "--contact-sheet", "turn-0001.png"],
            &["turn-0001.png", "contact sheet"],
        ),
        (&["compare", "2.png", "pipe.png"], &["pipe.png", "not a regular file"]),
        (&["verify", "fine.json", "--picture", "pipe.png"], &["pipe.png", "not a regular file"]),
        (&["verify", "fine.json", "--picture", "2.png", "--tolerance", "1"], &["--picture", "--tolerance"]),
        (&["bench", "missing.json"], &["missing.json"]),
        (&["bench", "s9"], &["s9: ", "known by a name", ".json"]),
        (&["chart", "sphare"], &["sphare: ", "known by a name"]),
        (&["render", "fine.fbx", "-o", "a.png"], &["fine.fbx: ", ".json", ".glb"]),
        (&["bench", "s4", "--octahedra"], &["--octahedra", "s2"]),
        (&["bench", "fine.json", "--octahedra"], &["--octahedra", "s2"]),
        (&["render", "fine.json", "-o", "a.png", "--adapter", ""], &["--adapter"]),
        (&["render", "fine.json", "-o", "a.png", "--reference", "--adapter", "gl"], &["--reference", "--adapter"]),
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
        (&["render", "auto.json", "-o", "a.png"], &["shading.auto.tolerance", "is -1", "0 or more"]),
        (&["render", "tone.json", "-o", "a.png"], &["intensity.reinhard.white", "1 or more"]),
        (&["render", "model.json", "-o", "a.png"], &["model.json", "objects[0].mesh.path", "nowhere.obj"]),
        (&["render", "fine.json", "-o", "a.bmp"], &["a.bmp", ".webp or .exr"]),
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
        (&["compare", "2.png", "palette.png"], &["palette.png", "within a color", "expected a PNG or EXR"]),
        (&["verify", "fine.json", "--picture", "palette.png"], &["palette.png", "within a color"]),
        (&["compare", "2.png", "3.png"], &["2.png and 3.png", "2 × 3", "3 × 3"]),
        (&["compare", "2.png", "2.png", "--background", "1,2"], &["1,2", "three linear intensities"]),
        (&["compare", "2.png", "2.png", "-o", "a.bmp"], &["a.bmp", ".webp or .exr"]),
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
    for (arguments, expected) in cases.iter().chain(TIMES_AND_CAMERAS) {
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

/// The decoder's panic message may reach standard error; the command itself ends with an error.
#[test]
fn a_decoder_that_panics_is_an_error() {
    let file = asset("crates/texture/tests/past_failures/a_jpeg_on_which_the_decoder_panics.jpg");
    let output = halfway(&folder("decoder"), &["compare", &file, &file]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.contains("error:") && error.contains("a_jpeg_on_which"), "{error}");
    assert!(error.contains("its decoder cannot make sense of it; expected a PNG or EXR"), "{error}");
}

#[test]
fn the_largest_pictures_are_not_too_large_to_compare() {
    let folder = folder("largest");
    let header = |name: &str, side: u32| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, side, side);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Sixteen);
        // The pixels, which would be gigabytes, are left out.
        drop(encoder.write_header().expect("memory takes it"));
        fs::write(folder.join(name), bytes).expect("the folder can be written");
    };
    // The same of the format that takes most, made from one of a single pixel.
    image::Rgba32FImage::new(1, 1).save(folder.join("one.exr")).expect("the folder can be written");
    let one = fs::read(folder.join("one.exr")).expect("it was written");
    let large = |name: &str, side: u32| {
        let mut bytes = one.clone();
        let mut set = |attribute: &[u8], at: usize, value: u32| {
            let start = bytes.windows(attribute.len()).position(|part| part == attribute).expect("it is in each file");
            // After its name there are four bytes of its length.
            let start = start + attribute.len() + 4 + at;
            bytes[start..start + 4].copy_from_slice(&value.to_le_bytes());
        };
        for window in [b"displayWindow\0box2i\0".as_slice(), b"dataWindow\0box2i\0"] {
            set(window, 8, side - 1);
            set(window, 12, side - 1);
        }
        set(b"chunkCount\0int\0", 0, side.div_ceil(64).pow(2));
        fs::write(folder.join(name), bytes).expect("the folder can be written");
    };
    for (side, name) in [(16384, "largest"), (16385, "larger")] {
        header(&format!("{name}.png"), side);
        large(&format!("{name}.exr"), side);
    }
    let refused = |name: &str| {
        let output = halfway(&folder, &["compare", name, name]);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        String::from_utf8_lossy(&output.stderr).to_lowercase()
    };
    for ending in ["png", "exr"] {
        let [largest, larger] = ["largest", "larger"].map(|name| refused(&format!("{name}.{ending}")));
        assert!(!largest.contains("limit") && !largest.contains("memory"), "{largest}");
        assert!(larger.contains("limit") || larger.contains("memory"), "{larger}");
    }
    // A failed allocation is an error and does not abort the program.
    if cfg!(target_os = "linux") {
        let mut command = Command::new("sh");
        let line = r#"ulimit -v 1000000; exec "$0" compare largest.exr largest.exr"#;
        let output = command.args(["-c", line, env!("CARGO_BIN_EXE_halfway")]).current_dir(&folder).output();
        let output = output.expect("there is a shell");
        let said = String::from_utf8_lossy(&output.stderr).to_lowercase();
        assert!(output.status.code() == Some(2) && said.contains("memory"), "{output:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_no_partial_file() {
    for signal in ["INT", "TERM"] {
        let folder = folder(&format!("signal_{signal}"));
        let files = || fs::read_dir(&folder).expect("it was made").count();
        let (teapot, frames) = (asset("assets/teapot.obj"), "100000");
        let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
        command.args(["render", &teapot, "--size", "32x24", "--turntable", frames, "-o", "turn.png"]);
        let mut child = command.current_dir(&folder).spawn().expect("the command was built with this test");
        // The animation has begun.
        while files() == 0 {
            assert!(child.try_wait().is_ok_and(|ended| ended.is_none()), "it ended by itself");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let kill = format!("kill -{signal} {}", child.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().is_ok_and(|status| status.success()));
        let status = child.wait().expect("it was started");
        assert_eq!((status.code(), files()), (Some(130), 0), "{signal}: {status:?}");
    }
}

/// Command lines about times and cameras, and parts of their errors.
const TIMES_AND_CAMERAS: &[(&[&str], &[&str])] = &[
    (&["render", "fine.json", "-o", "a.png", "--frames", "0..3"], &["fine.json has no animation", "--turntable N"]),
    (&["render", "fine.json", "-o", "a.png", "--time", "1"], &["--time: fine.json has no animation"]),
    (&["render", "fine.json", "-o", "a.png", "--time=-1"], &["--time", "0 or more"]),
    (&["render", "fine.json", "-o", "a.png", "--fps", "10"], &["--fps", "--frames or --turntable"]),
    (&["render", "fine.json", "-o", "a.png", "--turntable", "0"], &["--turntable", "1..=100000"]),
    (&["render", "fine.json", "-o", "a.png", "--camera", "top"], &["--camera", "\"top\"", "fine.json", "any"]),
    (
        &["render", "fine.json", "-o", "a.png", "--animation", "go"],
        &["fine.json: `animation`: is \"go\"; the models have none"],
    ),
    (&["render", "two.json", "-o", "a.png", "--camera", "top"], &["\"top\"; there are 0, 1 \"side\""]),
    (&["verify", "shared.json", "-o", "a.png"], &["shared.json", "share the picture", "--camera"]),
    (&["render", "beyond.json", "-o", "a.png"], &["beyond.json", "viewport.fractions", "beyond the picture"]),
    (&["verify", "two.json", "--camera", "2"], &["\"2\"; there are 0, 1 \"side\""]),
];

const SCENES: &[(&str, &str)] = &[
    ("fine.json", r#"{"objects": [{"mesh": {"teapot": {"divisions": 2}}}]}"#),
    ("two.json", r#"{"camera": {}, "cameras": [{"name": "side"}]}"#),
    (
        "shared.json",
        r#"{"camera": {"viewport": {}}, "cameras": [{"viewport": {"pixels": [0, 0, 8, 8], "load": "keep"}}]}"#,
    ),
    ("beyond.json", r#"{"camera": {"viewport": {"fractions": [0.5, 0, 0.75, 1]}}}"#),
    ("light.json", "{\n\"lights\": [{\"kind\": \"point\", \"attenuation\": [0, 0, -1]}]}"),
    ("size.json", "{\n\"size\": [0, 4]}"),
    ("sphere.json", "{\n\"objects\": [{\"mesh\": {\"uv_sphere\": {\"segments\": 4000000000}}}]}"),
    ("unknown.json", "{\n\"objects\": [],\n\"shadig\": \"flat\"}"),
    ("auto.json", r#"{"shading": {"auto": {"tolerance": -1.0}}}"#),
    ("tone.json", r#"{"intensity": {"reinhard": {"white": 0.5}}}"#),
    ("model.json", r#"{"objects": [{"mesh": {"path": "nowhere.obj"}}]}"#),
];

/// Four thousand million vertices in twelve bytes.
const ABSURD_COUNT: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4000000000, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 1]}],
    "bufferViews": [{"buffer": 0, "byteLength": 12}],
    "buffers": [{"byteLength": 12, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]}"#;

//! Views, sheets, several models, colours, lights and pipes of `render`, and `thumbnail`.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use image::RgbImage;

fn picture(folder: &Path, name: &str) -> RgbImage {
    image::open(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}")).into_rgb8()
}

/// Draws a small picture with these options.
fn draw(folder: &Path, models: &[&str], options: &[&str]) -> RgbImage {
    succeeds(folder, &[&["render"], models, &["--size", "96x64", "-o", "drawn.png"], options].concat());
    picture(folder, "drawn.png")
}

/// The first and last columns and rows that show something else than the upper left corner.
fn covered(picture: &RgbImage) -> [u32; 4] {
    let background = picture.get_pixel(0, 0);
    let shown = || picture.enumerate_pixels().filter(|(_, _, pixel)| *pixel != background);
    let columns = || shown().map(|(x, ..)| x);
    let rows = || shown().map(|(_, y, _)| y);
    [columns().min(), columns().max(), rows().min(), rows().max()].map(|bound| bound.expect("something is shown"))
}

/// A box 4 wide, 2 high and 1 deep, its front painted by its own shape: a step at the upper right.
const STEP: &str = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 2 1 0\nv 2 2 0\nv 0 2 0\n\
                    v 0 0 1\nv 4 0 1\nv 4 1 1\nv 2 1 1\nv 2 2 1\nv 0 2 1\n\
                    f 7 8 9 10 11 12\nf 6 5 4 3 2 1\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";

fn step(folder: &Path) {
    fs::write(folder.join("step.obj"), STEP).expect("the folder can be written");
}

#[test]
fn views_frame_the_side_that_is_asked_for() {
    let folder = folder("views");
    step(&folder);
    // Width and height of the side over the picture's, at nine tenths of the tighter.
    for (view, [width, height]) in
        [("front", [4.0, 2.0]), ("back", [4.0, 2.0]), ("right", [1.0, 2.0]), ("top", [4.0, 1.0]), ("0,-90", [4.0, 1.0])]
    {
        let drawn = draw(&folder, &["step.obj"], &["--view", view, "--ortho"]);
        let [left, right, top, bottom] = covered(&drawn).map(f64::from);
        let scale = 0.9 * f64::min(96.0 / width, 64.0 / height);
        let off = [right - left + 1.0 - scale * width, bottom - top + 1.0 - scale * height];
        assert!(off.iter().all(|off: &f64| off.abs() < 2.5), "{view}: {off:?}");
        assert!((left + right - 95.0).abs() < 2.5 && (top + bottom - 63.0).abs() < 2.5, "{view} is in the middle");
    }
    // From the front the step is at the upper right, from behind at the upper left.
    let at = |drawn: &RgbImage, x: u32| drawn.get_pixel(x, 24) == drawn.get_pixel(0, 0);
    let front = draw(&folder, &["step.obj"], &["--view", "front"]);
    let back = draw(&folder, &["step.obj"], &["--view", "back"]);
    assert!(at(&front, 75) && !at(&front, 20) && at(&back, 20) && !at(&back, 75));
    // With z up the front is what was the underside.
    let up = draw(&folder, &["step.obj"], &["--view", "front", "--up", "z", "--ortho"]);
    let [.., top, bottom] = covered(&up);
    assert!((bottom - top + 1).abs_diff(22) < 3, "1 of 4 high: {top} {bottom}");
    let near = covered(&draw(&folder, &["step.obj"], &["--fit", "0.45"]));
    let zoomed = covered(&draw(&folder, &["step.obj"], &["--fit", "0.45", "--zoom", "2"]));
    assert!((zoomed[1] - zoomed[0]).abs_diff(2 * (near[1] - near[0])) < 4, "{near:?} {zoomed:?}");
}

#[test]
fn views_replace_the_camera_of_a_scene() {
    let folder = folder("scene_view");
    let scene = asset("examples/scenes/brass_teapot.json");
    let own = draw(&folder, &[&scene], &[]);
    assert_eq!(own, draw(&folder, &[&scene], &[]));
    let others =
        [&["--view", "top"][..], &["--ortho"], &["--zoom", "2"], &["--fit", "0.3"], &["--lights", "headlight"]];
    for options in others {
        assert_ne!(own, draw(&folder, &[&scene], options), "{options:?}");
    }
}

#[test]
fn models_share_a_picture_at_their_own_places() {
    let folder = folder("several");
    fs::write(folder.join("left.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("the folder can be written");
    fs::write(folder.join("right.obj"), "v 9 0 0\nv 10 0 0\nv 9 1 0\nf 1 2 3\n").expect("the folder can be written");
    let both = draw(&folder, &["left.obj", "right.obj"], &["--view", "front", "--ortho"]);
    let [left, right, ..] = covered(&both);
    assert!(right - left > 80, "they are at both ends of the picture");
    let background = both.get_pixel(0, 0);
    assert!((30..60).all(|x| (0..64).all(|y| both.get_pixel(x, y) == background)), "and nothing is between them");
    let refused = halfway(&folder, &["render", "left.obj", &asset("examples/scenes/brass_teapot.json"), "-o", "a.png"]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && said.contains("a scene file is drawn alone"), "{said}");
}

#[test]
fn sheets_hold_views_at_one_scale() {
    let folder = folder("sheet");
    step(&folder);
    let common = ["render", "step.obj", "--size", "96x64", "--ortho", "--views", "front,right,top,30,20"];
    succeeds(&folder, &[&common[..], &["-o", "sheet.png"]].concat());
    let sheet = picture(&folder, "sheet.png");
    // Two columns and two rows, each with a line of text of 8 pixels, and gaps of 4.
    assert_eq!(sheet.dimensions(), (4 + 2 * 100, 4 + 2 * (64 + 16 + 4)));
    let cell = |x: u32, y: u32| covered(&image::imageops::crop_imm(&sheet, x, y, 96, 64).to_image());
    let (front, right) = (cell(4, 4), cell(104, 4));
    let heights = [front, right].map(|[.., top, bottom]| bottom - top);
    assert!(heights[0].abs_diff(heights[1]) <= 1, "both sides are 2 high: {heights:?}");
    let widths = [front, right].map(|[left, right, ..]| right - left + 1);
    assert!(widths[0].abs_diff(4 * widths[1]) < 6, "4 and 1 wide: {widths:?}");
    succeeds(&folder, &[&common[..], &["-o", "oracle.webp", "--reference"]].concat());
    assert_eq!(picture(&folder, "oracle.webp").dimensions(), sheet.dimensions());
    for (views, more) in [("front,sideways", "sheet.png"), ("front", "sheet.exr")] {
        let refused = halfway(&folder, &["render", "step.obj", "--views", views, "-o", more]);
        assert_eq!(refused.status.code(), Some(2), "{views} {more}");
    }
}

#[test]
fn looks_follow_their_options() {
    let folder = folder("options");
    step(&folder);
    let red = draw(&folder, &["step.obj"], &["--color", "#d00000"]);
    let [r, g, b] = red.get_pixel(30, 40).0;
    assert!(r > 2 * g.max(b), "{r} {g} {b}");
    let mut pictures = vec![draw(&folder, &["step.obj"], &[]), red];
    for options in [
        ["--color", "gold"],
        ["--normals", "smooth"],
        ["--lights", "headlight"],
        ["--lights", "three-point"],
        ["--faces", "back"],
        ["--samples", "1"],
    ] {
        pictures.push(draw(&folder, &["step.obj"], &options));
    }
    for (i, a) in pictures.iter().enumerate() {
        assert!(pictures[i + 1..].iter().all(|b| a != b), "{i}");
    }
    // A made part is creased without being asked, as it is flat here.
    assert_eq!(pictures[0], draw(&folder, &["step.obj"], &["--normals", "flat"]));
    assert_eq!(pictures[0], draw(&folder, &["step.obj"], &["--lights", "studio", "--samples", "4"]));
}

/// Runs the command with a file as its standard input.
fn piped(folder: &Path, file: &[u8], arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_halfway"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command was built with this test");
    // A command that refuses its options does not read.
    let _ = child.stdin.take().expect("a pipe").write_all(file);
    child.wait_with_output().expect("it ends")
}

#[test]
fn models_and_pictures_go_through_pipes() {
    let folder = folder("pipes");
    step(&folder);
    let expected = draw(&folder, &["step.obj"], &[]);
    let common = ["render", "-", "-o", "-", "--size", "96x64"];
    for (format, kind) in [
        ("obj", image::ImageFormat::Png),
        ("obj,png", image::ImageFormat::Png),
        ("webp,obj", image::ImageFormat::WebP),
        ("obj,jpeg", image::ImageFormat::Jpeg),
        ("obj,exr", image::ImageFormat::OpenExr),
    ] {
        let output = piped(&folder, STEP.as_bytes(), &[&common[..], &["--format", format]].concat());
        assert!(output.status.success(), "{format}: {}", String::from_utf8_lossy(&output.stderr));
        let drawn = image::load_from_memory_with_format(&output.stdout, kind).expect(format);
        if matches!(kind, image::ImageFormat::Png | image::ImageFormat::WebP) {
            assert_eq!(drawn.into_rgb8(), expected, "{format}");
        }
    }
    for (arguments, expected) in [
        (&["render", "-", "-o", "a.png"][..], "standard input: the format is not known"),
        (&["render", "-", "-o", "a.png", "--format", "stl"], "standard input: "),
        (&["info", "step.obj", "--format", "png"], "--format png: no picture is written"),
        (&["render", "step.obj", "-o", "a.bmp"], ".jpg, .jpeg, .webp or .exr"),
    ] {
        let output = piped(&folder, b"", arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(expected), "{arguments:?}: {said}");
    }
    let output = piped(&folder, STEP.as_bytes(), &["info", "-", "--format", "obj", "--table"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        said.lines().nth(1).is_some_and(|row| row.starts_with("-\t20\t12\t1\t4\t2\t1\t0\ta made part's")),
        "{said}"
    );
}

#[test]
fn an_empty_picture_says_why() {
    let folder = folder("empty");
    let leaf = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 2 1\n";
    fs::write(folder.join("leaf.obj"), leaf).expect("the folder can be written");
    let camera = r#""camera": {"position": [0, 0, 9], "target": [0, 0, 20]}"#;
    let ball = r#""objects": [{"mesh": {"uv_sphere": {}}}]"#;
    for (name, text) in [
        ("behind.json", format!("{{{camera}, {ball}}}")),
        ("dark.json", format!(r#"{{"lights": [], "ambient": [0, 0, 0], {ball}}}"#)),
        ("inside.json", format!(r#"{{"camera": {{"position": [0, 0, 0.1]}}, {ball}}}"#)),
        ("size.json", r#"{"objects": [{"mesh": {"box": {}}, "transform": {"scale": [0, 0, 0]}}]}"#.to_owned()),
    ] {
        fs::write(folder.join(name), text).expect("the folder can be written");
    }
    for (arguments, expected) in [
        (&["leaf.obj", "--view", "front", "--faces", "front"][..], "--faces both draws them"),
        (&["behind.json"], "the only object is behind the camera; --view front"),
        (&["dark.json"], "nothing lights what is in view; --lights studio"),
        (&["inside.json"], "the camera is inside of \"objects[0]\""),
        (&["size.json"], "the only object is without any size"),
    ] {
        let output = halfway(&folder, &[&["render"], arguments, &["--size", "48x32", "-o", "a.png"]].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && said.contains(expected), "{arguments:?}: {said}");
        assert_eq!(said.matches("the picture shows nothing").count(), 1, "{arguments:?}: {said}");
    }
    let output = halfway(&folder, &["render", "leaf.obj", "--view", "front", "--size", "48x32", "-o", "a.png"]);
    assert!(output.stderr.is_empty(), "an open surface without a material has two sides");
}

#[test]
fn info_takes_several_models() {
    let folder = folder("info_several");
    step(&folder);
    let teapot = asset("assets/teapot.obj");
    let output = halfway(&folder, &["info", "step.obj", "gone.obj", &teapot]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "one of them is missing");
    assert!(said.contains("step.obj\n") && said.contains("teapot.obj\n"), "{said}");
    assert!(said.contains("normals    a made part's, creased at 32.5°"), "{said}");
    let table = succeeds(&folder, &["info", "--table", "step.obj", &teapot]);
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split('\t').collect()).collect();
    assert!(rows.len() == 3 && rows.iter().all(|row| row.len() == 11), "{table}");
}

#[test]
fn thumbnails_are_small_pngs_within_limits() {
    let folder = folder("thumbnail");
    step(&folder);
    // File managers name a file without an ending.
    succeeds(&folder, &["thumbnail", "step.obj", "-o", "thumbnail", "--size", "64"]);
    let bytes = fs::read(folder.join("thumbnail")).expect("it was written");
    let drawn = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).expect("a PNG").into_rgb8();
    assert_eq!(drawn.dimensions(), (64, 64));
    covered(&drawn);
    fs::write(folder.join("long.obj"), STEP.repeat(9000)).expect("the folder can be written");
    for (arguments, expected) in [
        (&["long.obj", "--limit", "1"][..], "long.obj: the file is larger than 1000000 bytes"),
        (&["gone.obj"], "gone.obj: cannot be read"),
    ] {
        let output = halfway(&folder, &[&["thumbnail"], arguments, &["-o", "no.png"]].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(expected), "{arguments:?}: {said}");
        assert!(!folder.join("no.png").exists());
    }
}

#[test]
fn properties_are_listed_and_shown() {
    let folder = folder("scalars");
    let rod = asset("assets/warm_rod.ply");
    let said = succeeds(&folder, &["info", &rod]);
    assert!(said.contains("property   \"temperature\" of vertices: from 20"), "{said}");
    assert!(said.contains("property   \"load\" of faces: from "), "{said}");
    // Unlit, the lower end of the rod has the colour of the upper end of the map.
    let looks = ["--scalars", "temperature", "--shading", "unlit", "--samples", "1"];
    let drawn = draw(&folder, &[&rod], &looks);
    let yellow = drawn.pixels().filter(|pixel| pixel.0[0] > 240 && pixel.0[1] > 220 && pixel.0[2] < 80).count();
    assert!(yellow > 10, "{yellow} pixels are yellow");
    let other = draw(&folder, &[&rod], &[&looks[..], &["--map", "magma", "--range", "-5..1000"]].concat());
    assert!(other.pixels().all(|pixel| pixel.0[0] < 120), "all is at the dark end");
    let load = draw(&folder, &[&rod], &["--scalars", "load"]);
    assert_ne!(load, drawn);
    for (options, expected) in [
        (vec!["--scalars", "pressure"], "no property \"pressure\"; it has \"temperature\", \"load\""),
        (vec!["--scalars", "load", "--range", "2..1"], "the lower first"),
        (vec!["--map", "magma"], "--scalars"),
    ] {
        let refused = halfway(&folder, &[&["render", &rod, "-o", "no.png"], &options[..]].concat());
        let error = String::from_utf8_lossy(&refused.stderr);
        assert!(refused.status.code() == Some(2) && error.contains(expected), "{options:?}: {error}");
    }
}

#[test]
fn many_samples_are_those_of_the_reference() {
    let folder = folder("samples");
    let teapot = asset("assets/teapot.obj");
    let args = ["render", &teapot, "--size", "96x64", "--samples", "16", "-o"];
    succeeds(&folder, &[&args[..], &["frames.png"]].concat());
    succeeds(&folder, &[&args[..], &["oracle.png", "--reference"]].concat());
    let [frames, oracle] = ["frames.png", "oracle.png"].map(|name| picture(&folder, name));
    let far = frames.pixels().zip(oracle.pixels()).filter(|(a, b)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 2)).count();
    assert!(far < 96 * 64 / 50, "{far} pixels differ");
    let refused = halfway(&folder, &[&args[..], &["no.png", "--intensity", "aces"]].concat());
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && error.contains("expected 1 or 4 beside this intensity"), "{error}");
}

#[test]
fn convert_reads_and_writes_pipes() {
    let folder = folder("convert_pipes");
    step(&folder);
    succeeds(&folder, &["convert", "step.obj", "expected.glb"]);
    let expected = fs::read(folder.join("expected.glb")).expect("it was written");
    let obj = fs::read(folder.join("step.obj")).expect("it is there");
    for arguments in [
        &["convert", "-", "-", "--format", "obj,glb"][..],
        &["convert", "step.obj", "-", "--format", "glb"],
        &["convert", "step.obj", "-", "--format", "obj,glb", "--normals", "keep"],
    ] {
        let output = piped(&folder, &obj, arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        // A part of the name of its file.
        assert_eq!(&output.stdout[..4], b"glTF", "{arguments:?}");
        assert!(output.stdout.len().abs_diff(expected.len()) < 32, "{arguments:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("standard output: 1 parts"), "{arguments:?}");
    }
    let output = piped(&folder, &obj, &["convert", "-", "from_pipe.glb", "--format", "obj"]);
    assert!(output.status.success() && folder.join("from_pipe.glb").exists());
    for (arguments, expected) in [
        (&["convert", "-", "no.glb"][..], "standard input: the format is not known"),
        (
            &["convert", "step.obj", "-"],
            "standard output: the format is not known; expected --format smf, obj, glb, ply or stl",
        ),
        (&["convert", "step.obj", "-", "--format", "off"], "names no format that is written"),
        (&["convert", "step.obj", "no.glb", "--format", "png"], "no picture is written"),
    ] {
        let output = piped(&folder, &obj, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(expected), "{arguments:?}: {error}");
    }
}

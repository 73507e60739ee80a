//! The results of `convert` and `info`.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;

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

#[test]
fn convert_changes_formats_and_reports_losses() {
    let folder = folder("convert");
    let said = succeeds(&folder, &["convert", &asset("assets/teapot.obj"), "teapot.smf"]);
    assert!(said.contains("teapot.smf: 5 parts") && said.contains("lost       1 materials"), "{said}");
    let said = succeeds(&folder, &["convert", "teapot.smf", "teapot.glb"]);
    assert!(said.contains("teapot.glb: 1 parts") && !said.contains("lost"), "{said}");
    for (arguments, expected) in [
        (
            ["convert", "teapot.smf", "teapot.off"],
            "names no format that is written; smf, obj, glb, gltf, ply or stl is expected",
        ),
        (["convert", "gone.smf", "teapot.obj"], "gone.smf: cannot be read"),
    ] {
        let output = halfway(&folder, &arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(expected), "{arguments:?}: {error}");
    }
    assert!(!folder.join("teapot.obj").exists() && !folder.join("teapot.off").exists());
}

/// The line that begins with this step, and the numbers in it.
#[track_caller]
fn numbers(said: &str, step: &str) -> Vec<f64> {
    let line = said.lines().find(|line| line.starts_with(step)).unwrap_or_else(|| panic!("no {step} in:\n{said}"));
    line.split([' ', ',', ';']).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn convert_takes_the_steps_that_are_asked_for() {
    let folder = folder("convert_steps");
    // A cube whose squares share no vertices, one of them wound inside out, with a triangle too many and one of no
    // area.
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

    // The teapot of 4032 triangles in five parts, refined and coarsened: all parts together have the requested number.
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
    let said = succeeds(&folder, &["convert", &teapot, "b.glb", "--max-error", "0.02", "--normals", "face"]);
    let [before, after, error] = numbers(&said, "simplify")[..] else { panic!("three numbers in {said}") };
    assert!(after < 0.75 * before && error <= 0.02, "{said}");
    assert_eq!(numbers(&said, "normals")[1..], [3.0 * after], "three vertices a face: {said}");

    // Parts of a lantern that share a mesh still share it; a part smaller than the distance is removed, and reported.
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
fn converted_animations_are_drawn_alike() {
    let folder = folder("convert_animated");
    let fish = asset("assets/fish.glb");
    assert!(!succeeds(&folder, &["convert", &fish, "fish.gltf"]).contains("lost"));
    assert!(!succeeds(&folder, &["convert", "fish.gltf", "again.glb"]).contains("lost"));
    let mut pictures = Vec::new();
    for time in ["0.3", "1.25", "2.9"] {
        let [first, gltf, glb] = [&fish[..], "fish.gltf", "again.glb"].map(|model| {
            let arguments = ["render", model, "--camera", "diver", "--time", time, "--size", "96x54", "-o", "fish.png"];
            succeeds(&folder, &arguments);
            fs::read(folder.join("fish.png")).expect("the picture was written")
        });
        assert!(first == gltf && first == glb, "{time}");
        assert!(!pictures.contains(&first), "the fish moves");
        pictures.push(first);
    }
    let said = succeeds(&folder, &["convert", &fish, "fine.glb", "--subdivide", "midpoint=1"]);
    let lost = "lost       1 animations, which no longer fit the model; it is written as it stands";
    assert!(said.contains(lost), "{said}");
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
        "1 clusters in 1 groups",
        // The radius is √2/2.
        "1 triangles within 1.77e-1",
    ] {
        assert!(info.contains(expected), "{expected} is missing in:\n{info}");
    }
}

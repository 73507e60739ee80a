//! Lines and points of models, and `--show`.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;
use std::path::Path;

use image::RgbImage;

/// Eight corners of a box as points, each of its own colour.
const CLOUD: &str = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
                     property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 0\n\
                     property list uchar int vertex_indices\nend_header\n\
                     0 0 0 255 0 0\n4 0 0 255 0 0\n0 2 0 255 0 0\n4 2 0 255 0 0\n0 0 1 0 255 0\n4 0 1 0 255 0\n\
                     0 2 1 0 255 0\n4 2 1 0 255 0\n";

fn draw(folder: &Path, arguments: &[&str]) -> RgbImage {
    succeeds(folder, &[&["render"], arguments, &["--size", "96x64", "-o", "drawn.png"]].concat());
    image::open(folder.join("drawn.png")).expect("a picture").into_rgb8()
}

/// How many pixels have more of this channel than of both others.
fn count(picture: &RgbImage, channel: usize) -> usize {
    let is = |pixel: &[u8; 3]| (0..3).all(|other| other == channel || pixel[channel] > pixel[other].saturating_add(60));
    picture.pixels().filter(|pixel| is(&pixel.0)).count()
}

#[test]
fn models_of_points_or_lines_alone_are_drawn_and_framed() {
    let folder = folder("points");
    fs::write(folder.join("cloud.ply"), CLOUD).expect("the folder can be written");
    let front = draw(&folder, &["cloud.ply", "--view", "front", "--ortho", "--point-size", "8"]);
    // Four of the nearer ones, round, that hide the others; the box fills nine tenths of the width.
    let area = 4.0 * std::f64::consts::PI * 16.0;
    assert!((count(&front, 1) as f64 / area - 1.0).abs() < 0.15 && count(&front, 0) == 0, "{}", count(&front, 1));
    let column = (0..96).find(|x| (0..64).any(|y| front.get_pixel(*x, y) != front.get_pixel(48, 32)));
    assert!(column.is_some_and(|column| column < 5), "{column:?}");
    let wide = draw(&folder, &["cloud.ply", "--view", "front", "--ortho", "--point-size", "1w"]);
    assert!(count(&wide, 1) > 4 * count(&front, 1));

    fs::write(folder.join("wire.obj"), "v 0 0 0\nv 4 0 0\nv 4 2 0\nl 1 2 3 1\n").expect("the folder can be written");
    let thin = draw(&folder, &["wire.obj", "--color", "red", "--line-width", "1"]);
    let thick = draw(&folder, &["wire.obj", "--color", "red", "--line-width", "3"]);
    assert!(
        count(&thin, 0) > 100 && count(&thick, 0) > 2 * count(&thin, 0),
        "{} {}",
        count(&thin, 0),
        count(&thick, 0)
    );

    // A scene file has the same keys.
    let scene = r#"{"objects": [{"mesh": {"path": "wire.obj"}, "material": {"diffuse": [1, 0, 0]}}],
        "line_style": {"line_width": 3}, "show": ["grid"]}"#;
    fs::write(folder.join("scene.json"), scene).expect("the folder can be written");
    let [thick, thin] =
        [&["scene.json"][..], &["scene.json", "--line-width", "1"]].map(|it| count(&draw(&folder, it), 0));
    assert!(thin > 50 && thick > 2 * thin, "{thin} {thick}");
    fs::write(folder.join("bad.json"), scene.replace("grid", "edges")).expect("the folder can be written");
    let refused = halfway(&folder, &["render", "bad.json", "-o", "bad.png"]);
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(2) && error.contains("unknown name `edges`") && error.contains("face_normals"),
        "{error}"
    );
    let judged = halfway(&folder, &["verify", "scene.json", "--size", "32x24"]);
    let said = String::from_utf8_lossy(&judged.stderr);
    assert!(judged.status.success() && said.contains("not judged"), "{said}");
}

#[test]
fn info_counts_them_and_convert_keeps_them() {
    let folder = folder("lines_converted");
    fs::write(folder.join("cloud.ply"), CLOUD).expect("the folder can be written");
    let said = succeeds(&folder, &["info", "cloud.ply"]);
    for expected in
        ["triangles  0", "points     8", "vertices   8", "size [4, 2, 1]", "0 lines, 8 points; positions, colours"]
    {
        assert!(said.contains(expected), "{expected}:\n{said}");
    }
    let said = succeeds(&folder, &["convert", "cloud.ply", "cloud.glb"]);
    assert!(said.contains("cloud.glb: 0 parts, 0 triangles, 8 vertices, 8 points"), "{said}");
    let said = succeeds(&folder, &["convert", "cloud.glb", "cloud.obj"]);
    assert!(said.contains("8 points") && !said.contains("lost"), "{said}");
    let said = succeeds(&folder, &["convert", "cloud.obj", "cloud.smf"]);
    assert!(said.contains("lost       8 points"), "{said}");
    let table = succeeds(&folder, &["info", "--table", "cloud.obj", &asset("assets/helix.obj")]);
    assert!(table.lines().next().is_some_and(|titles| titles.ends_with("lines\tpoints")), "{table}");
    assert!(table.lines().any(|row| row.ends_with("\t217\t50")), "{table}");
}

#[test]
fn show_draws_what_explains_a_model() {
    let folder = folder("show");
    let cube = asset("assets/cube.smf");
    let plain = draw(&folder, &[&cube]);
    assert!((0..3).all(|channel| count(&plain, channel) == 0));
    let axes = draw(&folder, &[&cube, "--show", "axes"]);
    assert!((0..3).all(|channel| count(&axes, channel) > 5), "{:?}", [0, 1, 2].map(|channel| count(&axes, channel)));
    let all = draw(&folder, &[&cube, "--show", "axes,normals,face-normals,lights,grid"]);
    let differ = all.pixels().zip(plain.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ > 500, "{differ}");
    let refused = halfway(&folder, &["render", &cube, "-o", "no.png", "--show", "edges"]);
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && error.contains("expected axes, normals, face-normals"), "{error}");
}

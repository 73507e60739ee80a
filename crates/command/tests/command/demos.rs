//! `halfway demo`: the examples that come with the command.

use crate::command::{asset, folder, halfway, succeeds};
use std::collections::HashSet;

use image::RgbImage;

fn picture(file: &std::path::Path) -> RgbImage {
    image::open(file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).into_rgb8()
}

#[test]
fn each_scene_is_drawn_as_its_file_is() {
    let folder = folder("demos");
    let list = succeeds(&folder, &["demo"]);
    let names: Vec<&str> = list
        .lines()
        .filter_map(|line| line.trim().strip_prefix("halfway demo "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert_eq!(names.len(), 14, "{list}");
    for name in names {
        let size = ["--size", "64x48"];
        succeeds(&folder, &[&["demo", name, "-o", "demo.png"], &size[..]].concat());
        let found = picture(&folder.join("demo.png"));
        assert_eq!(found.dimensions(), (64, 48), "{name}");
        assert!(found.pixels().collect::<HashSet<_>>().len() > 10, "{name} shows nothing");
        let file = if name == "fish" { "assets/fish.glb".to_owned() } else { format!("examples/scenes/{name}.json") };
        succeeds(&folder, &[&["render", &asset(&file), "-o", "file.png"], &size[..]].concat());
        assert!(found == picture(&folder.join("file.png")), "{name}: another picture than that of {file}");
    }
}

#[test]
fn options_are_those_of_render() {
    let folder = folder("demo_options");
    let draw = |options: &[&str]| {
        let line = [&["demo", "brass_teapot", "--size=64x48", "--output=a.png"], options].concat();
        succeeds(&folder, &line);
        picture(&folder.join("a.png"))
    };
    assert!(draw(&["--shading", "flat"]) != draw(&["--shading", "phong"]));
    let help = succeeds(&folder, &["demo", "brass_teapot", "-o", "a.png", "--help"]);
    assert!(help.contains("--turntable <N>") && help.contains("halfway demo NAME -o FILE"), "{help}");
}

#[test]
fn other_names_and_options_are_refused() {
    let folder = folder("demo_errors");
    let rows = [
        (&["demo", "teapot"][..], "error: no example is called teapot; expected brass_teapot, drawing, fish,"),
        (&["demo", "waves"], "error: waves is a Rust program; run it in a checkout of the repository by `cargo run "),
        (&["demo", "lantern", "-o", "a.png", "--shade", "flat"], "error: unexpected argument '--shade' found"),
        (&["demo", "lantern", "-o", "a.txt"], "a.txt"),
        (&["demo", "-o", "a.png"], "'-o'"),
    ];
    for (arguments, expected) in rows {
        let output = halfway(&folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
}

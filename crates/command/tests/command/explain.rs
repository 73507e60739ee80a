//! `halfway explain`.

use crate::command::{asset, folder, halfway, succeeds};
use serde_json::Value;

/// A point light over the middle of a floor, seen from straight above it, from the side where the light is.
const SCENE: &str = r#"{
  "size": [9, 9], "output": "raw", "ambient": [0.5, 0.5, 0.5], "reflectance": "phong",
  "camera": {"position": [0, 4, 0], "target": [0, 0, 0], "up": [0, 0, -1]},
  "lights": [{"kind": "point", "name": "lamp_1", "position": [0, 2, 0], "attenuation": [0, 1, 0], "diffuse": [0.5, 0.5, 0.5]}],
  "objects": [{"name": "floor", "mesh": {"plane": {"size": 10}},
    "material": {"ambient": [0.2, 0.1, 0], "diffuse": [0.4, 0.8, 0], "specular": [0.1, 0.1, 0.1], "shininess": 3}}]
}"#;

#[test]
fn a_pixel_is_explained_as_text_json_and_latex() {
    let folder = folder("explain");
    std::fs::write(folder.join("scene.json"), SCENE).expect("the folder can be written");
    let common = ["explain", "scene.json", "--at", "4,4"];
    let text = succeeds(&folder, &common);
    // By hand: l, v, r and n are the same; att = 1/2; ka·Ga + 0.5·kd·Ld + 0.5·ks·Ls.
    for expected in [
        "Pixel (4, 4) of 9 × 9: 64 77 13 of 255, intensity (0.2500, 0.3000, 0.0500)",
        "\"floor\", triangle",
        "Phong shading: at the visible point",
        "ambient = ka·Ga = (0.1000, 0.0500, 0)",
        "Light \"lamp_1\", point, Ld (0.5, 0.5, 0.5), Ls (1, 1, 1)",
        "d = 2.0000",
        "att = 1/(d) = 0.5000",
        "n·l = 1.0000",
        "diffuse  = att·kd·Ld·(n·l) = (0.1000, 0.2000, 0)",
        "r·v = 1.0000, (r·v)^3 = 1.0000",
        "specular = att·ks·Ls·(r·v)^3 = (0.0500, 0.0500, 0.0500)",
        "Without a curve: (0.2500, 0.3000, 0.0500); times 255: 64 77 13",
    ] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    let json = succeeds(&folder, &[&common[..], &["--json"]].concat());
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["bytes"], serde_json::json!([64, 77, 13]));
    let light = &json["samples"][0]["layers"][0]["points"][0]["lights"][0];
    assert_eq!(light["name"], "lamp_1");
    assert!((light["way"]["attenuation"].as_f64().expect("a number") - 0.5).abs() < 1e-12);
    let latex = succeeds(&folder, &[&common[..], &["--latex"]].concat());
    // A heading or several begin a block, and each line but the last ends one and has one place to be aligned at.
    let blocks: Vec<&str> = latex.trim_end().split_terminator("\n\\end{align*}").collect();
    assert!(blocks.len() >= 3, "pixel and surface, lamp, sum: {latex}");
    for block in blocks {
        let block = block.trim_start().strip_prefix("\\begin{align*}\n").expect("a block");
        assert!(block.starts_with("&\\textbf{"), "{block}");
        let lines: Vec<&str> = block.split(" \\\\\n").collect();
        assert_eq!(lines.len(), block.lines().count(), "{block}");
        for line in lines {
            assert_eq!(line.matches('&').count(), 1, "{line}");
            assert_eq!(line.matches('{').count(), line.matches('}').count(), "{line}");
        }
    }
    assert!(latex.contains("lamp\\_1") && latex.contains("I_{d,1} &= \\mathrm{att}_{1}\\,k_d"), "{latex}");
}

#[test]
fn the_explained_pixel_is_that_of_the_reference_renderer() {
    let folder = folder("explain_reference");
    let teapot = asset("assets/teapot.obj");
    succeeds(&folder, &["render", &teapot, "--size", "64x48", "--reference", "-o", "a.png"]);
    let picture = image::open(folder.join("a.png")).expect("it was drawn").into_rgb8();
    for shading in ["flat", "gouraud", "phong"] {
        let arguments = ["--size", "64x48", "--shading", shading];
        succeeds(&folder, &[&["render", &teapot, "--reference", "-o", "a.png"][..], &arguments].concat());
        let drawn = image::open(folder.join("a.png")).expect("it was drawn").into_rgb8();
        assert!(shading == "phong" || drawn != picture, "{shading}");
        for (x, y) in [(32, 24), (20, 30), (41, 22)] {
            let at = format!("{x},{y}");
            let json = succeeds(&folder, &[&["explain", &teapot, "--json", "--at", &at][..], &arguments].concat());
            let json: Value = serde_json::from_str(&json).expect("JSON");
            assert_eq!(json["bytes"], serde_json::json!(drawn.get_pixel(x, y).0), "{shading} {at}");
            let corners = if shading == "gouraud" { 3 } else { 1 };
            let layers = json["samples"][0]["layers"].as_array().expect("a list");
            assert!(layers.iter().all(|layer| layer["points"].as_array().is_some_and(|it| it.len() == corners)));
        }
    }
}

#[test]
fn pixels_outside_are_refused() {
    let folder = folder("explain_outside");
    let cube = asset("assets/cube.smf");
    for (at, expected) in [
        (
            "64,3",
            "--at: (64, 3) lies outside the picture of 64 × 48 pixels; expected a column from 0 to 63 and a row from 0 to 47",
        ),
        ("1", "expected X,Y, a column and a row"),
    ] {
        let output = halfway(&folder, &["explain", &cube, "--size", "64x48", "--at", at]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && error.contains(expected), "{error}");
    }
}

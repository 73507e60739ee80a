//! Scenes that once exceeded their tolerance no longer do. `halfway-wild --steps` tries other scenes.

use crate::command::{folder, halfway};
use std::fs;

/// Forty point lights in a row of this length, with these keys beside their places.
fn row_of_lights(from: [f64; 3], length: f64, keys: &str) -> String {
    let at = |number: u32| [from[0] + length * f64::from(number) / 40.0, from[1], from[2]];
    let one = |number| format!(r#"{{"kind": "point", "position": {:?}, {keys}}}"#, at(number));
    (0..40).map(one).collect::<Vec<_>>().join(", ")
}

#[test]
fn scenes_that_exceeded_their_tolerance_are_fixed() {
    let sphere = |radius: &str, more: &str| {
        format!(
            r#""objects": [{{"mesh": {{"uv_sphere": {{"radius": {radius}, "segments": 96, "rings": 48}}}}{more}}}]"#
        )
    };
    let sun = r#""lights": [{"kind": "directional", "direction": [0, -1, -1]}]"#;
    let seen_from =
        |distance: &str, near: &str| format!(r#""camera": {{"position": [0, 0, {distance}], "near": {near}}}"#);
    let rows: [(&str, [&str; 2], Vec<String>); 5] = [
        (
            "a sphere scaled to 1e13",
            ["phong", "exact"],
            vec![seen_from("5e13", "1"), sun.into(), sphere("1", r#", "transform": {"scale": [1e13, 1e13, 1e13]}"#)],
        ),
        (
            "a sphere of 1e-15 scaled to 1",
            ["phong", "exact"],
            vec![seen_from("5", "1"), sun.into(), sphere("1e-15", r#", "transform": {"scale": [1e15, 1e15, 1e15]}"#)],
        ),
        ("a sphere of 1e20", ["phong", "1,0"], vec![seen_from("5e20", "1e19"), sun.into(), sphere("1e20", "")]),
        (
            "a sphere of 1e-22 among lights",
            ["phong", "1,0"],
            vec![
                seen_from("5e-22", "1e-23"),
                format!(
                    r#""lights": [{}]"#,
                    row_of_lights([-8e-23, -7e-23, 4e-23], 1.6e-22, r#""attenuation": [1, 0, 0], "range": 6e-23"#)
                ),
                sphere("1e-22", ""),
            ],
        ),
        (
            "lights at 1e20 that have a range",
            ["phong", "1,0"],
            vec![
                seen_from("5", "1"),
                format!(
                    r#""lights": [{}]"#,
                    row_of_lights([-1e20, 5e19, 1e20], 2e20, r#""attenuation": [20, 0, 0], "range": 1e21"#)
                ),
                sphere("1", ""),
            ],
        ),
    ];
    let folder = folder("tolerances");
    let mut wrong = Vec::new();
    for (name, [shading, tolerance], parts) in rows {
        let scene = format!(r#"{{"size": [300, 300], {}}}"#, parts.join(",\n"));
        fs::write(folder.join("scene.json"), scene).expect("the folder can be written");
        let look = ["--shading", shading, "--tolerance", tolerance, "--adapter", "cpu"];
        let output = halfway(&folder, &[&["verify", "scene.json"], &look[..]].concat());
        if !output.status.success() {
            wrong.push(format!("{name}: {}", String::from_utf8_lossy(&output.stderr)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

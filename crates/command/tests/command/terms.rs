//! One term, one light, and the sheet of all of them.

use crate::command::{asset, folder, halfway, succeeds};
use image::RgbImage;

/// Two lights with names before a background.
const SCENE: &str = r#"{
  "size": [40, 30], "background": [0.1, 0.2, 0.3], "ambient": [0.2, 0.2, 0.2],
  "camera": {"position": [0, 0, 3], "target": [0, 0, 0]},
  "lights": [
    {"kind": "directional", "name": "key", "direction": [0, 0, -1], "diffuse": [0.4, 0, 0], "specular": [0, 0, 0]},
    {"kind": "directional", "name": "fill", "direction": [0, 0, -1], "diffuse": [0, 0.3, 0], "specular": [0, 0, 0]}
  ],
  "objects": [{"mesh": {"box": {}}, "material": {"ambient": [0.5, 0.5, 0.5], "diffuse": [1, 1, 1]}}]
}"#;

#[test]
fn one_term_and_one_light_are_drawn_alone() {
    let folder = folder("only");
    std::fs::write(folder.join("scene.json"), SCENE).expect("the folder can be written");
    let draw = |name: &str, more: &[&str]| -> RgbImage {
        succeeds(&folder, &[&["render", "scene.json", "-o", name][..], more].concat());
        succeeds(&folder, &[&["verify", "scene.json"][..], more].concat());
        image::open(folder.join(name)).expect("it was drawn").into_rgb8()
    };
    let decode = |byte: u8| {
        let encoded = f64::from(byte) / 255.0;
        if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    };
    let whole = [(20, 15, [0.5, 0.4, 0.1]), (0, 0, [0.1, 0.2, 0.3])];
    let black = [0.0; 3];
    for (name, more, [middle, corner]) in [
        ("all.png", &[][..], whole.map(|(.., color)| color)),
        ("ambient.png", &["--only", "ambient"], [[0.1, 0.1, 0.1], black]),
        ("diffuse.png", &["--only", "diffuse"], [[0.4, 0.3, 0.0], black]),
        ("specular.png", &["--only", "specular"], [black, black]),
        ("emission.png", &["--only", "emission"], [black, [0.1, 0.2, 0.3]]),
        ("key.png", &["--light", "key"], [[0.4, 0.0, 0.0], black]),
        ("fill.png", &["--light", "1", "--only", "diffuse"], [[0.0, 0.3, 0.0], black]),
    ] {
        let picture = draw(name, more);
        for ((x, y), expected) in [((20, 15), middle), ((0, 0), corner)] {
            let found = picture.get_pixel(x, y).0.map(decode);
            let is_close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 4e-3);
            assert!(is_close, "{name} ({x}, {y}): {found:?} instead of {expected:?}");
        }
    }
    for (more, expected) in [
        (&["--light", "kye"][..], "--light: scene.json: no light is called \"kye\"; there are 0 \"key\", 1 \"fill\""),
        (&["--light", "2"], "no light is called \"2\""),
        (&["--light", "key", "--only", "emission"], "only"),
        (&["--only", "shiny"], "[possible values: ambient, diffuse, specular, emission]"),
    ] {
        let output = halfway(&folder, &[&["render", "scene.json", "-o", "bad.png"][..], more].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && error.contains(expected), "{error}");
    }
}

#[test]
fn a_sheet_holds_every_light_and_term() {
    let folder = folder("terms");
    std::fs::write(folder.join("scene.json"), SCENE).expect("the folder can be written");
    succeeds(&folder, &["terms", "scene.json", "-o", "sheet.png", "--size", "40x30"]);
    succeeds(&folder, &["render", "scene.json", "-o", "whole.png"]);
    let open = |name: &str| image::open(folder.join(name)).expect("it was drawn").into_rgb8();
    let (sheet, whole) = (open("sheet.png"), open("whole.png"));
    // Four columns and four rows: two lights, none, and sums; gaps of 4 pixels, and captions.
    assert_eq!(sheet.width(), 4 * (40 + 4) + 4);
    let row = (sheet.height() - 4) / 4;
    let cell =
        |column: u32, line: u32| image::imageops::crop_imm(&sheet, 4 + 44 * column, 4 + row * line, 40, 30).to_image();
    // The sum is rounded once, the picture a sample of four at a time.
    let sum = cell(3, 3);
    let most = sum.as_raw().iter().zip(whole.as_raw()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1), "{most:?}");
    let middle = |column, line| cell(column, line).get_pixel(20, 15).0.map(|byte| byte > 0);
    assert_eq!(middle(1, 0), [true, false, false], "the diffuse term of the key light");
    assert_eq!(middle(1, 1), [false, true, false], "the diffuse term of the fill light");
    assert_eq!(middle(0, 2), [true, true, true], "global ambient light");
    assert_eq!(middle(1, 2), [false, false, false], "no emission");
    assert_eq!(middle(1, 3), [true, true, false], "all diffuse terms");
    let output = halfway(&folder, &["terms", &asset("assets/cube.smf"), "-o", "sheet.png", "--only", "diffuse"]);
    assert_eq!(output.status.code(), Some(2));
}

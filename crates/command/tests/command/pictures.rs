//! What `render` draws and writes, and what the command says of itself.

use crate::command::{asset, folder, succeeds};
use std::fs;

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

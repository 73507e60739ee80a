//! The pictures of `render`, and the command's messages about itself.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;

#[test]
fn pictures_in_every_format_show_the_same_teapot() {
    let folder = folder("formats");
    let teapot = asset("assets/teapot.obj");
    // Of several samples each is clamped in a picture of bytes.
    let common = ["render", &teapot, "--size", "64x48", "--samples", "1", "-o"];
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
        draw("samples.png", &["--samples", "1"]),
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
    let common = ["render", &cube, "--size", "32x32", "--turntable", "120", "--frames"];
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
fn animations_are_played_and_cameras_chosen() {
    let folder = folder("key_frames");
    let scene = asset("examples/scenes/key_frames.json");
    let draw = |name: &str, more: &[&str]| {
        let common = ["render", &scene, "--size", "48x27", "-o", name];
        succeeds(&folder, &[&common[..], more].concat());
    };
    let read = |name: &str| fs::read(folder.join(name)).expect("the picture was written");
    for (name, by) in [("drawn", &[][..]), ("exact", &["--reference", "--supersample", "1"])] {
        draw(&format!("{name}-{{}}.png"), &[&["--frames", "0..3", "--fps", "2"], by].concat());
        draw("moment.png", &[&["--time", "0.5"], by].concat());
        let frames = [0, 1, 2].map(|number| read(&format!("{name}-{number:04}.png")));
        assert!(frames[1] == read("moment.png"), "{name}: frame 1 is that of half a second");
        assert!(frames[0] != frames[1] && frames[1] != frames[2], "{name}: something moves");
        let start = format!("start_{name}.png");
        draw(&start, by);
        assert!(frames[0] == read(&start), "{name}: without a time it is the first moment");
    }
    draw("walk.png", &["--camera", "walk"]);
    draw("plan.png", &["--camera", "plan"]);
    draw("second.png", &["--camera", "1"]);
    assert!(read("walk.png") == read("start_drawn.png") && read("plan.png") == read("second.png"));
    assert_ne!(read("walk.png"), read("plan.png"));
}

/// Each part of the picture is the picture of its camera at its size, and options that frame leave one camera.
#[test]
fn cameras_share_a_picture_or_have_it_for_themselves() {
    let folder = folder("shared");
    let scene = asset("examples/scenes/four_views.json");
    let draw = |name: &str, more: &[&str]| {
        succeeds(&folder, &[&["render", &scene, "-o", name], more].concat());
        image::open(folder.join(name)).expect("the picture was written").into_rgba8()
    };
    let shared = draw("shared.png", &["--size", "96x54"]);
    let part = |left, top| image::imageops::crop_imm(&shared, left, top, 48, 27).to_image();
    let corners = [("perspective", 0, 0), ("top", 48, 0), ("front", 0, 27), ("right", 48, 27)];
    for (camera, left, top) in corners {
        let alone = draw(&format!("{camera}.png"), &["--size", "48x27", "--camera", camera]);
        assert!(part(left, top) == alone, "{camera}");
    }
    let reference = draw("reference.png", &["--size", "96x54", "--reference"]);
    let differs = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8);
    let differing = shared.pixels().zip(reference.pixels()).filter(|pair| differs(*pair)).count();
    // Four samples a pixel are elsewhere in a pixel of the reference.
    assert!(differing < 400, "{differing} of {} pixels", 96 * 54);
    let views = [&["--view", "top"][..], &["--turntable", "2", "--frames", "0..1"]].map(|more| {
        let name = format!("{}.png", more[0].trim_start_matches('-'));
        draw(&name, &[&["--size", "48x27"], more].concat())
    });
    assert!(views[1] == draw("first.png", &["--size", "48x27", "--camera", "0"]) && views[0] != views[1]);
}

// As promised by docs/many-machines.md.
#[test]
fn two_processes_draw_the_bytes_of_one() {
    let folder = folder("processes");
    let scene = asset("examples/scenes/brass_teapot.json");
    let draw = &|frames: &str, pattern: &str| {
        let common =
            ["render", &scene, "--size", "64x36", "--tolerance", "1,0", "--turntable", "120", "--frames", frames];
        succeeds(&folder, &[&common[..], &["-o", pattern]].concat());
    };
    draw("0..6", "one-{}.png");
    std::thread::scope(|scope| {
        let others = ["0..3", "3..6"].map(|frames| scope.spawn(move || draw(frames, "many-{}.png")));
        for other in others {
            other.join().expect("the process succeeds");
        }
    });
    let frame = |name: &str, number| {
        let path = folder.join(format!("{name}-{number:04}.png"));
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    for number in 0..6 {
        assert!(frame("one", number) == frame("many", number), "frame {number} differs");
    }
    assert!((1..6).all(|number| frame("one", number) != frame("one", number - 1)), "something moves");
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
fn models_are_shown_with_their_images() {
    let folder = folder("textured");
    for (model, least) in [("assets/crate.obj", 100), ("assets/ball.glb", 100)] {
        let arguments = ["render", &asset(model), "--size", "96x96", "--shading", "phong", "-o", "model.png"];
        let output = halfway(&folder, &arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("warning"), "{model}: {said}");
        let picture = image::open(folder.join("model.png")).expect("the picture was written").into_rgb8();
        // Neighbours differ by more than a tenth where an image has edges; on smooth surfaces shading changes by less.
        let differ = |x: u32, y: u32| {
            let [a, b] = [x, x + 1].map(|x| picture.get_pixel(x, y).0.map(f64::from));
            a.iter().zip(b).any(|(a, b)| (a - b).abs() > 0.05 * (a + b + 1.0))
        };
        let inner = (24..72).flat_map(|y| (24..71).map(move |x| (x, y)));
        let edges = inner.filter(|(x, y)| differ(*x, *y)).count();
        assert!(edges > least, "{model}: {edges} edges between colors");
    }
}

#[test]
fn an_image_without_effect_is_logged_once() {
    let folder = folder("ignored");
    let image = asset("assets/crate_height.png");
    let object = |x: f32| {
        let maps = format!(r#"{{"height": {{"path": {image:?}, "amount": 0.1}}}}"#);
        format!(r#"{{"mesh": {{"plane": {{}}}}, "transform": {{"translation": [{x}, 0, 0]}}, "maps": {maps}}}"#)
    };
    for (shading, times) in [("gouraud", 1), ("flat", 1), ("phong", 0), ("auto", 0)] {
        let scene = format!(r#"{{"shading": "{shading}", "objects": [{}, {}]}}"#, object(-1.2), object(1.2));
        fs::write(folder.join("scene.json"), scene).expect("the folder can be written");
        let output = halfway(&folder, &["render", "scene.json", "--size", "64x36", "-o", "scene.png"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert_eq!(said.matches("height image does nothing").count(), times, "{shading}: {said}");
        let retired = "warning: scene.json:1:13: `shading`: \"auto\" is no longer a shading; it is drawn as \"phong\"";
        assert_eq!(said.matches(retired).count(), usize::from(shading == "auto"), "{shading}: {said}");
    }
}

#[test]
fn info_schema_and_adapters_print_their_data() {
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

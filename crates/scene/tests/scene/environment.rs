//! Environments of scene files: read, and what is shown of those that cannot be.

use std::path::Path;

use bevy_app::App;
use halfway_mesh::MeshPlugin;
use halfway_scene::{SceneFile, spawn};
use halfway_texture::TexturePlugin;
use halfway_texture::environment::{EnvironmentLight, EnvironmentMap};
use image::{ImageFormat, Rgb32FImage};

/// The component, its light, and the warnings of a scene with this environment.
fn spawned(entry: &str, folder: &Path) -> (EnvironmentLight, EnvironmentMap, Vec<String>) {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TexturePlugin));
    let scene = SceneFile::from_json(&format!("{{\"environment\": {entry}}}"), "here").unwrap();
    assert_eq!(SceneFile::from_json(&scene.to_json().unwrap(), "again").unwrap(), scene);
    let spawned = spawn(&scene, folder, app.world_mut()).unwrap();
    let world = app.world_mut();
    let light = world.query::<&EnvironmentLight>().single(world).unwrap().clone();
    let map = world.resource::<halfway_asset::Assets<EnvironmentMap>>().get(&light.map).unwrap().clone();
    (light, map, spawned.warnings)
}

fn save(folder: &Path, name: &str, size: [u32; 2], texel: [f32; 3]) {
    let image = Rgb32FImage::from_pixel(size[0], size[1], image::Rgb(texel));
    image.save_with_format(folder.join(name), ImageFormat::OpenExr).unwrap();
}

#[test]
fn broken_environments_are_warnings_and_checkers() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("environments");
    std::fs::create_dir_all(&folder).unwrap();
    save(&folder, "sky.exr", [8, 4], [2.0, 1.0, 0.5]);
    save(&folder, "wide.exr", [8, 4], [1.0; 3]);
    save(&folder, "nan.exr", [8, 4], [1.0, f32::NAN, 1.0]);
    save(&folder, "square.exr", [4, 4], [1.0; 3]);

    let entry = r#"{"paths": ["sky.exr"], "strength": 0.5, "rotation_deg": 90, "sky": false}"#;
    let (light, map, warnings) = spawned(entry, &folder);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!((light.strength, light.sky), (0.5, false));
    assert!((light.rotation - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    assert!((map.at([0.3_f64, 0.5, -1.0], 0.0)[0] - 2.0).abs() < 1e-6);

    let six = r#"["square.exr", "square.exr", "square.exr", "square.exr", "square.exr", "square.exr"]"#;
    for good in
        [format!(r#"{{"paths": {six}, "shape": "cube"}}"#), r#"{"paths": ["square.exr"], "shape": "ball"}"#.into()]
    {
        assert!(spawned(&good, &folder).2.is_empty(), "{good}");
    }
    for (entry, said) in [
        (r#"{"paths": ["missing.hdr"]}"#.to_owned(), "missing.hdr: cannot be read"),
        (r#"{"paths": ["nan.exr"]}"#.into(), "nan.exr"),
        (r#"{"paths": ["wide.exr"], "shape": "ball"}"#.into(), "one square image is expected"),
        (
            format!(r#"{{"paths": {}, "shape": "cube"}}"#, six.replacen("square", "wide", 1)),
            "six square images of one size are expected",
        ),
    ] {
        let (_, map, warnings) = spawned(&entry, &folder);
        let [warning] = &warnings[..] else { panic!("{entry}: {warnings:?}") };
        let is_said = warning.starts_with("environment: ") && warning.contains(said);
        assert!(is_said && warning.ends_with("squares of magenta and black are shown"), "{entry}: {warning}");
        assert_eq!(map, EnvironmentMap::missing(), "{entry}");
    }
}

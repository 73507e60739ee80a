//! The images that a scene file names are on its objects, and what is wrong with them is said by name.

use bevy_app::App;
use bevy_asset::Assets;
use bevy_transform::TransformPlugin;
use halfway_mesh::MeshPlugin;
use halfway_scene::{SceneError, SceneFile, spawn};
use halfway_texture::{ColorMap, LevelFilter, Pyramid, TexelFilter, Texture, TexturePlugin, Wrap};

fn scene(map: &str) -> SceneFile {
    let text = format!(r#"{{"objects": [{{"mesh": {{"uv_sphere": {{}}}}, "color_map": {map}}}]}}"#);
    SceneFile::from_json(&text, "test").expect("a scene")
}

#[test]
fn an_image_is_read_and_an_unreadable_one_is_a_warning_and_a_checker() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-maps-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    image::RgbImage::from_pixel(5, 3, image::Rgb([255, 0, 0])).save(dir.join("red.png")).unwrap();
    std::fs::write(dir.join("broken.png"), b"no image").unwrap();
    for (file, says) in
        [("red.png", None), ("broken.png", Some("broken.png: is no PNG")), ("none.png", Some("none.png: cannot"))]
    {
        let mut app = App::new();
        app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
        let keys = format!(
            r#"{{"path": "{file}", "wrap_v": "mirror", "magnify": "catmull_rom", "levels": "none", "scale": [2, 3]}}"#
        );
        let spawned = spawn(&scene(&keys), &dir, app.world_mut()).unwrap();
        let map = app.world().get::<ColorMap>(spawned.objects[0]).expect("the object has it").clone();
        assert_eq!(map.sampling.wrap, [Wrap::Repeat, Wrap::Mirror]);
        assert_eq!((map.sampling.magnify, map.sampling.levels), (TexelFilter::CatmullRom, LevelFilter::None));
        assert!((map.transform.scale[1] - 3.0).abs() < 1e-6);
        let texture = app.world().resource::<Assets<Texture>>().get(&map.texture).expect("it is kept").0.clone();
        match says {
            None => {
                assert_eq!(spawned.warnings, [""; 0]);
                assert_eq!((texture.size(), texture.texels()[0]), ([5, 3], [1.0, 0.0, 0.0, 1.0]));
            }
            Some(says) => {
                assert!(spawned.warnings.len() == 1 && spawned.warnings[0].contains(says), "{:?}", spawned.warnings);
                assert!(spawned.warnings[0].starts_with("objects[0].color_map: "), "{:?}", spawned.warnings);
                assert_eq!(texture, Pyramid::missing());
            }
        }
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn a_world_without_room_for_images_is_refused() {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TransformPlugin));
    let refused = spawn(&scene(r#"{"path": "red.png"}"#), "".as_ref(), app.world_mut());
    assert!(matches!(refused, Err(SceneError::NoTextureAssets)));
}

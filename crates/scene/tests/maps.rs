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

/// The images on the objects of a scene of one model, and the warnings.
fn of_model(dir: &std::path::Path, file: &str) -> (Vec<(ColorMap, Pyramid)>, Vec<String>) {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
    let text = format!(r#"{{"objects": [{{"mesh": {{"path": "{file}"}}}}]}}"#);
    let scene = SceneFile::from_json(&text, "test").expect("a scene");
    let spawned = spawn(&scene, dir, app.world_mut()).expect("a model");
    let mut query = app.world_mut().query::<&ColorMap>();
    let maps: Vec<ColorMap> = query.iter(app.world()).cloned().collect();
    let textures = app.world().resource::<Assets<Texture>>();
    let of = |map: &ColorMap| textures.get(&map.texture).expect("it is kept").0.clone();
    (maps.iter().map(|map| (map.clone(), of(map))).collect(), spawned.warnings)
}

#[test]
fn the_images_of_models_are_on_their_parts() {
    let dir = std::env::temp_dir().join(format!("halfway-model-maps-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    image::RgbImage::from_pixel(5, 3, image::Rgb([255, 0, 0])).save(dir.join("a red.png")).unwrap();
    let square = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
    std::fs::write(dir.join("a.obj"), square).unwrap();
    let mtl = "newmtl a\nKd 1 1 1\nmap_Kd -s 2 3 1 -blendu on -o 0.25 0.5 -clamp on a red.png\n";
    std::fs::write(dir.join("a.mtl"), mtl).unwrap();
    let (maps, warnings) = of_model(&dir, "a.obj");
    let [(map, pyramid)] = &maps[..] else { panic!("one part: {maps:?}") };
    assert_eq!((pyramid.size(), map.sampling.wrap), ([5, 3], [Wrap::Clamp; 2]));
    // v = 0 of the file is v = 1 of the mesh: there 3·0 + 0.5 of the file is 0.5 of the image.
    let [u, v] = halfway_texture::UvTransform::apply(&map.transform.rows(), [0.0, 1.0]);
    assert!((u - 0.25).abs() < 1e-6 && (v - 0.5).abs() < 1e-6, "{u} {v}");
    assert!(warnings.len() == 1 && warnings[0].contains("the option `-blendu` of `map_Kd` is skipped"), "{warnings:?}");

    std::fs::write(dir.join("a.mtl"), "newmtl a\nmap_Kd gone.png\n").unwrap();
    let (maps, warnings) = of_model(&dir, "a.obj");
    assert_eq!(maps[0].1, Pyramid::missing());
    assert!(warnings.len() == 1 && warnings[0].contains("gone.png"), "{warnings:?}");
    std::fs::write(dir.join("a.mtl"), "newmtl a\nmap_Kd ../gone.png\n").unwrap();
    let (maps, warnings) = of_model(&dir, "a.obj");
    assert!(maps[0].1 == Pyramid::missing() && warnings[0].contains("outside the folder"), "{warnings:?}");

    let gltf = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "extensionsUsed": ["KHR_texture_transform"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0,
            "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}}}}}],
        "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "a%20red.png"}],
        "samplers": [{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 0, 1], "max": [1, 1, 1]}, {"bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "points.bin"}]}"#;
    let points: [f32; 9] = [0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0];
    std::fs::write(dir.join("points.bin"), points.map(f32::to_le_bytes).concat()).unwrap();
    std::fs::write(dir.join("a.gltf"), gltf).unwrap();
    let (maps, warnings) = of_model(&dir, "a.gltf");
    let [(map, pyramid)] = &maps[..] else { panic!("one part: {maps:?}, {warnings:?}") };
    assert_eq!((pyramid.size(), map.sampling.wrap), ([5, 3], [Wrap::Clamp, Wrap::Mirror]));
    let found = (map.sampling.magnify, map.sampling.minify, map.sampling.levels);
    assert_eq!(found, (TexelFilter::Nearest, TexelFilter::Bilinear, LevelFilter::Nearest));
    assert_eq!((map.transform.offset, map.transform.scale), ([0.5, 0.25], [2.0, 4.0]));
    assert_eq!(warnings, [""; 0]);
    std::fs::remove_dir_all(&dir).unwrap();
}

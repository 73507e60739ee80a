//! The images that a scene file names are on its objects, and what is wrong with them is said by name.

use bevy_app::App;
use bevy_color::LinearRgba;
use bevy_ecs::query::With;
use bevy_transform::TransformPlugin;
use halfway_asset::Assets;
use halfway_lighting::{AlphaMode, Material};
use halfway_mesh::{Mesh3d, MeshPlugin};
use halfway_scene::{SceneError, SceneFile, spawn};
use halfway_texture::{
    Channel, LevelFilter, MapKind, Maps, Pyramid, SurfaceMap, TexelFilter, Texture, TexturePlugin, UvSet, Wrap,
};

fn color(maps: &Maps) -> SurfaceMap {
    maps.get(MapKind::Color).expect("a color map").clone()
}

fn scene(map: &str) -> SceneFile {
    let text = format!(r#"{{"objects": [{{"mesh": {{"uv_sphere": {{}}}}, "maps": {{"color": {map}}}}}]}}"#);
    SceneFile::from_json(&text, "test").expect("a scene")
}

#[test]
fn an_unreadable_image_is_a_warning_and_a_checker() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-maps-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    image::RgbImage::from_pixel(5, 3, image::Rgb([255, 0, 0])).save(dir.join("red.png")).unwrap();
    std::fs::write(dir.join("broken.png"), b"no image").unwrap();
    for (file, says) in
        [("red.png", None), ("broken.png", Some("broken.png: is no image")), ("none.png", Some("none.png: cannot"))]
    {
        let mut app = App::new();
        app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
        let keys = format!(
            r#"{{"path": "{file}", "wrap_v": "mirror", "magnify": "catmull_rom", "levels": "none", "scale": [2, 3]}}"#
        );
        let spawned = spawn(&scene(&keys), &dir, app.world_mut()).unwrap();
        let map = color(app.world().get::<Maps>(spawned.objects[0]).expect("the object has it"));
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
                assert!(spawned.warnings[0].starts_with("objects[0].maps.color: "), "{:?}", spawned.warnings);
                assert_eq!(texture, Pyramid::missing());
            }
        }
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

/// An image of a model that is missing or broken leaves its material as it is, and a checker where that is asked for.
#[test]
fn a_missing_image_of_a_model_leaves_its_material() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-missing-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    std::fs::write(dir.join("broken.png"), b"no image").unwrap();
    let square = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nusemtl p\nf 1/1 2/1 3/1\n";
    std::fs::write(dir.join("m.obj"), square).unwrap();
    for (file, says) in [("none.png", "cannot be read"), ("broken.png", "is no image")] {
        std::fs::write(dir.join("m.mtl"), format!("newmtl p\nKd 0.5 0.25 1\nmap_Kd {file}\nmap_Ks {file}\n")).unwrap();
        for mark in [false, true] {
            let mut app = App::new();
            app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
            let text = format!(r#"{{"objects": [{{"mesh": {{"path": "m.obj"}}, "mark_missing_images": {mark}}}]}}"#);
            let scene = SceneFile::from_json(&text, "test").expect("a scene");
            let spawned = spawn(&scene, &dir, app.world_mut()).unwrap();
            assert!(spawned.warnings.iter().any(|warning| warning.contains(says)), "{:?}", spawned.warnings);
            let world = app.world_mut();
            let (material, maps) = world.query::<(&Material, Option<&Maps>)>().single(world).expect("one part");
            assert_eq!(material.diffuse, LinearRgba::rgb(0.5, 0.25, 1.0), "{file}");
            // White where there is an image.
            assert_eq!(material.specular, if mark { LinearRgba::WHITE } else { LinearRgba::BLACK }, "{file}");
            assert_eq!(maps.is_some(), mark, "{file}");
        }
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

/// Each word, and itself again when it is written.
#[test]
fn every_filter_of_levels_has_a_word() {
    use LevelFilter as L;
    let words = [
        ("none", L::None),
        ("nearest", L::Nearest),
        ("linear", L::Linear),
        ("ripmap", L::Ripmap),
        ("summed_areas", L::SummedArea),
        ("anisotropic_2", L::Anisotropic2),
        ("anisotropic_4", L::Anisotropic4),
        ("anisotropic_8", L::Anisotropic8),
        ("anisotropic_16", L::Anisotropic16),
        ("elliptical", L::Elliptical),
    ];
    for (word, filter) in words {
        let read = scene(&format!(r#"{{"path": "red.png", "levels": "{word}"}}"#));
        let maps = read.objects[0].maps.clone().expect("it has images");
        assert_eq!(maps.color.as_ref().expect("a color").levels, filter);
        let written = read.to_json().expect("it can be written");
        assert!(word == "linear" || written.contains(word), "{written}");
        assert_eq!(SceneFile::from_json(&written, "written").expect("a scene"), read);
    }
    let text = r#"{"objects": [{"mesh": {"uv_sphere": {}}, "maps": {"color": {"path": "red.png", "levels": "anisotropic"}}}]}"#;
    let error = SceneFile::from_json(text, "test").expect_err("no such filter").to_string();
    assert!(error.contains("unknown value `anisotropic`, expected") && error.contains("\"anisotropic_16\""), "{error}");
}

#[test]
fn a_world_without_room_for_images_is_refused() {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TransformPlugin));
    let refused = spawn(&scene(r#"{"path": "red.png"}"#), "".as_ref(), app.world_mut());
    assert!(matches!(refused, Err(SceneError::NoTextureAssets)));
}

/// The images on the objects of a scene of one model, and the warnings.
fn of_model(dir: &std::path::Path, file: &str) -> (Vec<(SurfaceMap, Pyramid)>, Vec<String>) {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
    let text = format!(r#"{{"objects": [{{"mesh": {{"path": "{file}"}}}}]}}"#);
    let scene = SceneFile::from_json(&text, "test").expect("a scene");
    let spawned = spawn(&scene, dir, app.world_mut()).expect("a model");
    let mut query = app.world_mut().query::<&Maps>();
    let maps: Vec<SurfaceMap> = query.iter(app.world()).map(color).collect();
    let textures = app.world().resource::<Assets<Texture>>();
    let of = |map: &SurfaceMap| textures.get(&map.texture).expect("it is kept").0.clone();
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
    assert!(maps.is_empty(), "{maps:?}");
    assert!(warnings.len() == 1 && warnings[0].contains("gone.png"), "{warnings:?}");
    std::fs::write(dir.join("a.mtl"), "newmtl a\nmap_Kd ../gone.png\n").unwrap();
    let (maps, warnings) = of_model(&dir, "a.obj");
    assert!(maps.is_empty() && warnings[0].contains("outside the folder"), "{warnings:?}");

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

/// The images and the mask on the one part of a model, and the warnings.
fn all_of_model(dir: &std::path::Path, file: &str, keys: &str) -> (Maps, Option<f32>, Vec<String>) {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
    let text = format!(r#"{{"objects": [{{"mesh": {{"path": "{file}"}}{keys}}}]}}"#);
    let spawned = spawn(&SceneFile::from_json(&text, "test").expect("a scene"), dir, app.world_mut()).expect("a model");
    let mut query = app.world_mut().query_filtered::<(&Maps, Option<&AlphaMode>), With<Mesh3d>>();
    let (maps, alpha) = query.single(app.world()).expect("one part");
    let alpha = alpha.copied().unwrap_or_default();
    assert_eq!(alpha.blends(), keys.contains("blend"), "{file}{keys}");
    (maps.clone(), alpha.cutoff(), spawned.warnings)
}

#[test]
fn every_image_of_an_mtl_file_is_on_its_part() {
    let dir = std::env::temp_dir().join(format!("halfway-mtl-maps-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    image::RgbImage::from_pixel(5, 3, image::Rgb([128, 0, 0])).save(dir.join("red.png")).unwrap();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([255, 0, 0, 51])).save(dir.join("clear.png")).unwrap();
    let square = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
    std::fs::write(dir.join("a.obj"), square).unwrap();
    let mtl = "newmtl a\nNs 8\nmap_Kd red.png\nmap_Ks red.png\nmap_Ke red.png\nmap_d clear.png\n\
               map_Ns -imfchan g red.png\nmap_Bump -bm 0.25 red.png\nmap_Pr red.png\n";
    std::fs::write(dir.join("a.mtl"), mtl).unwrap();
    let (maps, mask, warnings) = all_of_model(&dir, "a.obj", "");
    assert!(warnings.len() == 1 && warnings[0].contains("the texture `map_Pr` is skipped"), "{warnings:?}");
    assert_eq!(mask, Some(0.5));
    let kinds: Vec<MapKind> = maps.iter().map(|(kind, _)| kind).collect();
    let (color, specular, emission) = (MapKind::Color, MapKind::Specular, MapKind::Emission);
    assert_eq!(kinds, [color, specular, emission, MapKind::Opacity, MapKind::Shininess, MapKind::Height]);
    let of = |kind| maps.get(kind).expect("it is there");
    assert_eq!(of(MapKind::Opacity).channel, Channel::Alpha, "the image has an alpha");
    assert_eq!(of(MapKind::Shininess).channel, Channel::Green);
    assert_eq!((of(MapKind::Height).channel, of(MapKind::Height).amount), (Channel::Red, 0.25));
    // A color is decoded from sRGB, and a number is not.
    assert_eq!(of(color).texture, of(emission).texture);
    assert_ne!(of(color).texture, of(MapKind::Height).texture);
    // Who asks for blending is not cut out, and who asks for another mask gets it.
    assert_eq!(all_of_model(&dir, "a.obj", r#", "blend": true"#).1, None);
    assert_eq!(all_of_model(&dir, "a.obj", r#", "mask": 0.75"#).1, Some(0.75));
    assert_eq!(all_of_model(&dir, "a.obj", r#", "mask": 0"#).1, None);

    std::fs::write(dir.join("a.mtl"), "newmtl a\nKe 0 0 0\nmap_Ke red.png\nnorm red.png\nbump red.png\n").unwrap();
    let (_, mask, warnings) = all_of_model(&dir, "a.obj", "");
    assert_eq!(mask, None);
    assert!(warnings.len() == 2, "{warnings:?}");
    assert!(warnings[0].contains("its emission is black"), "{warnings:?}");
    assert!(warnings[1].contains("only the normal map is shown"), "{warnings:?}");
    std::fs::write(dir.join("a.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n").unwrap();
    let text = r#"{"objects": [{"mesh": {"path": "a.obj"}}]}"#;
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TexturePlugin, TransformPlugin));
    let spawned = spawn(&SceneFile::from_json(text, "test").unwrap(), &dir, app.world_mut()).unwrap();
    let says = "has no texture coordinates for its images: emission, normal, height";
    assert!(spawned.warnings.iter().any(|warning| warning.contains(says)), "{:?}", spawned.warnings);
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn every_image_of_a_gltf_file_is_on_its_part() {
    let dir = std::env::temp_dir().join(format!("halfway-gltf-maps-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    image::RgbImage::from_pixel(5, 3, image::Rgb([128, 0, 0])).save(dir.join("red.png")).unwrap();
    let gltf = |alpha: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "extensionsUsed": ["KHR_texture_transform"],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1}}, "material": 0}}]}}],
        "materials": [{{{alpha}, "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}},
            "emissiveFactor": [1, 1, 1], "emissiveTexture": {{"index": 0, "texCoord": 1}},
            "occlusionTexture": {{"index": 0, "texCoord": 1, "strength": 0.5}},
            "normalTexture": {{"index": 0, "scale": 0.25,
                "extensions": {{"KHR_texture_transform": {{"texCoord": 1, "scale": [2, 4]}}}}}}}}],
        "textures": [{{"source": 0}}], "images": [{{"uri": "red.png"}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 0, 1], "max": [1, 1, 1]}}, {{"bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 3}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"byteLength": 36, "uri": "points.bin"}}]}}"#
        )
    };
    let points: [f32; 9] = [0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0];
    std::fs::write(dir.join("points.bin"), points.map(f32::to_le_bytes).concat()).unwrap();
    for (alpha, keys, expected) in [
        (r#""alphaMode": "OPAQUE""#, "", None),
        (r#""alphaMode": "MASK""#, "", Some(0.5)),
        (r#""alphaMode": "MASK", "alphaCutoff": 0.25"#, "", Some(0.25)),
        (r#""alphaMode": "MASK""#, r#", "blend": true"#, None),
    ] {
        std::fs::write(dir.join("a.gltf"), gltf(alpha)).unwrap();
        let (maps, mask, warnings) = all_of_model(&dir, "a.gltf", keys);
        assert_eq!(mask, expected, "{alpha}");
        assert!(warnings.iter().all(|warning| warning.contains("normals")), "{warnings:?}");
        let kinds: Vec<MapKind> = maps.iter().map(|(kind, _)| kind).collect();
        assert_eq!(kinds, [MapKind::Color, MapKind::Emission, MapKind::Occlusion, MapKind::Normal]);
        let sets: Vec<UvSet> = maps.iter().map(|(_, map)| map.uv_set).collect();
        assert_eq!(sets, [UvSet::First, UvSet::Second, UvSet::Second, UvSet::Second]);
        let amounts: Vec<f32> = maps.iter().map(|(_, map)| map.amount).collect();
        assert_eq!(amounts, [1.0, 1.0, 0.5, 0.25]);
        let [scale_u, scale_v] = maps.get(MapKind::Normal).expect("a normal map").transform.scale;
        assert_eq!((scale_u, scale_v), (2.0, 4.0));
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn invalid_maps_are_refused_by_key() {
    for (maps, says) in [
        (r#"{"color": {"path": ""}}"#, "objects[0].maps.color.path"),
        (r#"{"colour": {"path": "a.png"}}"#, "colour"),
        (r#"{"occlusion": {"path": "a.png", "amount": 1.5}}"#, "objects[0].maps.occlusion.amount"),
        (r#"{"normal": {"path": "a.png", "uv_set": "third"}}"#, "uv_set"),
        (r#"{"normal": {"path": "a.png"}, "height": {"path": "b.png"}}"#, "objects[0].maps.height"),
    ] {
        let text = format!(r#"{{"objects": [{{"mesh": {{"uv_sphere": {{}}}}, "maps": {maps}}}]}}"#);
        let error = SceneFile::from_json(&text, "test").and_then(|scene| scene.validate().map(|()| scene)).unwrap_err();
        assert!(error.to_string().contains(says), "{maps}: {error}");
    }
    let text = r#"{"objects": [{"mesh": {"uv_sphere": {}}, "mask": -1}]}"#;
    let error = SceneFile::from_json(text, "test").and_then(|scene| scene.validate().map(|()| scene)).unwrap_err();
    assert!(error.to_string().contains("`objects[0].mask`: is -1; expected a finite number, 0 or more"), "{error}");
}

//! Several cameras, their projections and their names; those of glTF.

use std::path::{Path, PathBuf};

use bevy_ecs::prelude::*;
use bevy_math::{UVec2, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{
    Camera, Film, Layers, Load, Projection, Reflectance, Samples, Shading, Tolerance, ViewTolerance, Viewport,
};

use crate::spawned::app;
use halfway_scene::{SceneError, SceneFile, spawn, spawn_seen_from};

fn projection(camera: &str) -> Projection {
    let scene = SceneFile::from_json(&format!("{{\"camera\": {camera}}}"), "test").unwrap();
    let again = SceneFile::from_json(&scene.to_json().unwrap(), "again").unwrap();
    assert_eq!(again, scene);
    let mut app = app();
    let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
    app.world().get::<Camera>(spawned.camera).unwrap().projection
}

#[test]
fn every_projection_has_its_keys() {
    assert_eq!(projection("{}"), Projection::default());
    assert_eq!(projection(r#"{"height": 3}"#), Projection::orthographic(3.0));
    let film = Film { shift: [0.5, -0.25], aspect: Some(2.0), pixel_aspect: 1.5 };
    assert_eq!(
        projection(r#"{"height": 3, "near": -2, "far": 7, "shift": [0.5, -0.25], "aspect": 2, "pixel_aspect": 1.5}"#),
        Projection::Orthographic { height: 3.0, near: -2.0, far: Some(7.0), film }
    );
    assert_eq!(
        projection(r#"{"fov_y_deg": 60, "near": 2, "shift": [0.5, -0.25], "aspect": 2, "pixel_aspect": 1.5}"#),
        Projection::Perspective { fov_y: 60_f32.to_radians(), near: 2.0, film }
    );
    assert_eq!(
        projection(r#"{"near": 2, "intrinsics": {"focal": [500, 510], "center": [310, 250], "size": [640, 480]}}"#),
        Projection::intrinsics([500.0, 510.0], [310.0, 250.0], [640, 480]).with_near(2.0)
    );
}

/// A glTF file of a triangle, a perspective camera and an orthographic one.
fn write_model(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("halfway-scene-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let gltf = r#"{"asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]},
            {"camera": 1, "name": "plan", "translation": [0, 4, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}},
            {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 1, "znear": 0.25, "zfar": 9}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 0, 1], "max": [1, 1, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "points.bin"}]}"#;
    std::fs::write(dir.join("seen.gltf"), gltf).unwrap();
    let points: [f32; 9] = [0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0];
    std::fs::write(dir.join("points.bin"), points.map(f32::to_le_bytes).concat()).unwrap();
    dir
}

const SCENE: &str = r#"{
  "shading": "flat", "tolerance": {"steps": 1},
  "camera": {"position": [0, 0, 9]},
  "cameras": [
    {"name": "plan view", "position": [0, 8, 0], "up": [0, 0, -1], "height": 4, "shading": "gouraud",
     "reflectance": "phong", "samples": 4, "tolerance": {"steps": 2}},
    {"name": "1"}
  ],
  "lights": [{"kind": "point", "name": "lamp", "attach": "camera"}, {"kind": "point", "attach": {"object": 0}}],
  "objects": [{"name": "model", "mesh": {"path": "seen.gltf"}, "transform": {"translation": [10, 0, 0], "scale": [2, 2, 2]}}]
}"#;

#[test]
fn a_camera_is_chosen_by_its_name_or_its_number() {
    let dir = write_model("cameras");
    let scene = SceneFile::from_json(SCENE, "test").unwrap();
    let unused = format!("{}: 2 cameras are not used; a scene has its own", dir.join("seen.gltf").display());
    let orthographic = Projection::Orthographic {
        height: 2.0,
        near: 0.25,
        far: Some(9.0),
        film: Film { aspect: Some(3.0), ..Film::DEFAULT },
    };
    let plain = Projection::default();
    // Cameras 0 to 2 are the scene's; the name of the last one comes before the number of another.
    for (wanted, name, position, projection, look) in [
        (None, "camera", Vec3::new(0.0, 0.0, 9.0), plain, Shading::Flat),
        (Some("0"), "camera", Vec3::new(0.0, 0.0, 9.0), plain, Shading::Flat),
        (Some("plan view"), "plan view", Vec3::new(0.0, 8.0, 0.0), Projection::orthographic(4.0), Shading::Gouraud),
        (Some("1"), "1", Vec3::new(0.0, 0.0, 3.0), plain, Shading::Flat),
        (Some("2"), "1", Vec3::new(0.0, 0.0, 3.0), plain, Shading::Flat),
        (Some("3"), "camera", Vec3::new(10.0, 0.0, 10.0), Projection::perspective(1.0).with_near(0.5), Shading::Flat),
        (Some("4"), "plan", Vec3::new(10.0, 8.0, 0.0), orthographic, Shading::Flat),
        (Some("plan"), "plan", Vec3::new(10.0, 8.0, 0.0), orthographic, Shading::Flat),
    ] {
        let mut app = app();
        let world = app.world_mut();
        let spawned = match wanted {
            None => spawn(&scene, &dir, world),
            Some(wanted) => spawn_seen_from(&scene, &dir, wanted, world),
        };
        let spawned = spawned.unwrap();
        let is_models = matches!(wanted, Some("3" | "4" | "plan"));
        assert_eq!(spawned.warnings, if is_models { vec![] } else { vec![unused.clone()] }, "{wanted:?}");
        assert_eq!(world.query::<&Camera>().iter(world).count(), 1);
        let camera = world.entity(spawned.camera);
        assert_eq!(camera.get::<Name>().unwrap().as_str(), name, "{wanted:?}");
        assert_eq!(camera.get::<Camera>().unwrap().projection, projection, "{wanted:?}");
        let transform = camera.get::<Transform>().unwrap();
        assert!((transform.translation - position).length() < 1e-5, "{wanted:?}: {transform:?}");
        let forward = if name.starts_with("plan") { Vec3::NEG_Y } else { Vec3::NEG_Z };
        assert!((*transform.forward() - forward).length() < 1e-5, "{wanted:?}: {transform:?}");
        assert_eq!(camera.get::<Shading>(), Some(&look));
        let is_plan = wanted == Some("plan view");
        let reflectance = if is_plan { Reflectance::Phong } else { Reflectance::BlinnPhong };
        assert_eq!(camera.get::<Reflectance>(), Some(&reflectance));
        assert_eq!(camera.get::<Camera>().unwrap().samples, if is_plan { Samples::Four } else { Samples::One });
        let steps = if is_plan { 2.0 } else { 1.0 };
        let tolerance = camera.get::<Tolerance>().copied().unwrap_or(world.resource::<ViewTolerance>().0);
        assert_eq!(tolerance, Tolerance { steps, ..Tolerance::EXACT });
        // The lights are on the camera that is drawn, and on the first object.
        let parent = |light: Entity| world.get::<ChildOf>(light).map(ChildOf::parent);
        assert_eq!(parent(spawned.lights[0]), Some(spawned.camera));
        assert_eq!(parent(spawned.lights[1]), Some(spawned.objects[0]));
        assert_eq!(world.get::<Name>(spawned.lights[0]).unwrap().as_str(), "lamp");
    }
    let mut app = app();
    let error = spawn_seen_from(&scene, &dir, "lamp", app.world_mut()).unwrap_err();
    assert!(matches!(error, SceneError::NoCamera { .. }));
    let expected = r#"no camera is called "lamp"; there are 0, 1 "plan view", 2 "1", 3, 4 "plan""#;
    assert_eq!(error.to_string(), expected);
    let none = spawn_seen_from(&SceneFile::default(), &dir, "0", app.world_mut()).unwrap_err();
    assert_eq!(none.to_string(), r#"no camera is called "0"; neither the scene nor its models have any"#);
    assert_eq!(app.world_mut().query::<&Camera>().iter(app.world()).count(), 0, "nothing is spawned");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn a_picture_of_any_shape_shows_what_an_orthographic_camera_of_gltf_sees() {
    let dir = write_model("magnified");
    let scene = SceneFile::from_json(SCENE, "test").unwrap();
    let mut app = app();
    let spawned = spawn_seen_from(&scene, &dir, "plan", app.world_mut()).unwrap();
    let projection = app.world().get::<Camera>(spawned.camera).unwrap().projection;
    for (size, expected) in [([300, 100], [3.0, 1.0]), ([600, 100], [6.0, 1.0]), ([100, 100], [3.0, 3.0])] {
        assert_eq!(projection.half_extent(size), expected, "{}", UVec2::from_array(size));
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn cameras_with_viewports_share_the_picture() {
    let scene = r#"{
        "size": [200, 100], "shading": "flat",
        "camera": {"name": "alone"},
        "cameras": [
            {"name": "left", "viewport": {"fractions": [0, 0, 0.5, 1]}, "shading": "gouraud", "tolerance": {"steps": 2}},
            {"name": "right", "viewport": {"pixels": [100, 0, 100, 50], "order": 3, "load": "keep"}, "layers": [0, 4],
             "view": "top"}
        ],
        "lights": [{"kind": "point", "layers": [4]}],
        "objects": [{"mesh": {"box": {}}, "layers": [0, 31]}, {"mesh": {"box": {}}}]
    }"#;
    let scene = SceneFile::from_json(scene, "test").unwrap();
    assert_eq!(SceneFile::from_json(&scene.to_json().unwrap(), "again").unwrap(), scene);
    let mut app = app();
    let world = app.world_mut();
    let spawned = spawn(&scene, Path::new(""), world).unwrap();
    assert_eq!(world.query::<&Camera>().iter(world).count(), 2);
    let [left, right] = spawned.cameras[..] else { panic!("two cameras") };
    assert_eq!((spawned.camera, world.get::<Name>(left).unwrap().as_str()), (left, "left"));
    let [first, second] = [left, right].map(|camera| *world.get::<Viewport>(camera).unwrap());
    assert_eq!(first.part, Viewport::fractions([0.0, 0.0, 0.5, 1.0]).part);
    assert_eq!((second.part, second.load), (Viewport::pixels([100, 0, 100, 50]).part, Load::Keep));
    assert!(first.order < second.order && first.load == Load::Clear);
    assert_eq!(world.get::<Shading>(left), Some(&Shading::Gouraud));
    assert_eq!(world.get::<Shading>(right), Some(&Shading::Flat));
    assert_eq!(world.get::<Tolerance>(left), Some(&Tolerance::steps(2.0)));
    assert_eq!(world.get::<Tolerance>(right), None);
    let layers = |entity| world.get::<Layers>(entity).copied();
    assert_eq!([left, right].map(layers), [None, Some(Layers::layer(0).and(4))]);
    assert_eq!(layers(spawned.lights[0]), Some(Layers::layer(4)));
    assert_eq!([0, 1].map(|i| layers(spawned.objects[i])), [Some(Layers::layer(0).and(31)), None]);

    // One that is chosen has the picture for itself.
    let mut app = self::app();
    let world = app.world_mut();
    let spawned = spawn_seen_from(&scene, Path::new(""), "right", world).unwrap();
    assert_eq!((spawned.cameras.len(), world.get::<Viewport>(spawned.camera)), (1, None));

    for (viewport, expected) in [
        (r#"{"fractions": [0.5, 0, 0.75, 1]}"#, "fractions"),
        (r#"{"fractions": [0, 0, 0.5, 1], "pixels": [0, 0, 5, 5]}"#, "cannot stand beside"),
        (r#"{"pixels": [0, 0, 0, 5]}"#, "no width"),
        (r#"{"load": "blend"}"#, "load"),
        (r#"{"order": 1001}"#, "order"),
    ] {
        let error = SceneFile::from_json(&format!("{{\"camera\": {{\"viewport\": {viewport}}}}}"), "test").unwrap_err();
        assert!(error.to_string().contains(expected), "{viewport}: {error}");
    }
    let error = SceneFile::from_json(r#"{"objects": [{"mesh": {"box": {}}, "layers": [32]}]}"#, "test").unwrap_err();
    assert!(error.to_string().contains("0 to 31"), "{error}");
}

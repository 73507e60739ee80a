//! Scenes far from the origin of the world: what is near the camera shares its origin, and keeps all its digits.

use std::path::Path;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Material, Origin, world_place};
use halfway_mesh::{Cuboid, Mesh, Model, Part};
use halfway_scene::{LoadedModel, MeshEntry, ObjectEntry, SceneFile, outline, spawn};

use crate::spawned::app;

const TOWN: DVec3 = DVec3::new(400_000.0, 5_000_000.0, 0.0);

#[test]
fn positions_of_a_scene_file_are_in_f64() {
    let text = r#"{"camera": {"position": [400003.1, 5000002.2, 4.3], "target": [400000.1, 5000000.2, 0.3]},
        "lights": [{"kind": "point", "position": [400001.7, 5000005.1, 9.9]}, {"kind": "point", "position": [1, 2, 3]},
                   {"kind": "point", "position": [1, 2, 3], "attach": "camera"},
                   {"kind": "homogeneous", "position": [800003.4, 10000010.2, 19.8, 2]}],
        "objects": [{"mesh": {"box": {}}, "transform": {"translation": [400000.1, 5000000.2, 0.3]}},
                    {"mesh": {"box": {}}},
                    {"mesh": {"box": {}}, "transform": {"translation": [0, 0, 0]},
                     "animation": [{"of": "translation", "keys": [[0, [0, 0, 0]], [1, [400000.1, 5000000.2, 0.3]]]}]}]}"#;
    let scene = SceneFile::from_json(text, "far.json").unwrap();
    assert_eq!(SceneFile::from_json(&scene.to_json().unwrap(), "far.json").unwrap(), scene);
    let mut app = app();
    let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
    let origin = spawned.origin;
    assert!(origin.distance(TOWN) < 10.0, "{origin}");
    let world = app.world();
    let place = |entity: Entity| world_place(entity, world).translation;
    let origin_of = |entity: Entity| world.get::<Origin>(entity).map(|origin| origin.0);
    assert_eq!(origin_of(spawned.camera), Some(origin));
    assert!(place(spawned.camera).distance(DVec3::new(400_003.1, 5_000_002.2, 4.3)) < 1e-6);
    for (number, at, near) in [
        (0, DVec3::new(400_001.7, 5_000_005.1, 9.9), true),
        (1, DVec3::new(1.0, 2.0, 3.0), false),
        (3, DVec3::new(400_001.7, 5_000_005.1, 9.9), true),
    ] {
        let light = spawned.lights[number];
        assert!(place(light).distance(at) < 1e-6, "{number}: {}", place(light));
        assert_eq!(origin_of(light), Some(origin).filter(|_| near), "{number}");
    }
    assert_eq!(world.get::<Transform>(spawned.lights[2]).unwrap().translation, Vec3::new(1.0, 2.0, 3.0));
    assert!(place(spawned.objects[0]).distance(DVec3::new(400_000.1, 5_000_000.2, 0.3)) < 1e-6);
    assert_eq!((place(spawned.objects[1]), origin_of(spawned.objects[1])), (DVec3::ZERO, None));

    let matrix = scene.objects[0].transform.matrix();
    let world = app.world_mut();
    assert!(spawned.place_object(1, &matrix, world) && spawned.place_camera(scene.camera.as_ref().unwrap(), world));
    assert!(spawned.place_object(0, &bevy_math::DMat4::IDENTITY, world));
    assert_eq!(world_place(spawned.objects[0], world).translation, DVec3::ZERO);
    assert!(world_place(spawned.objects[1], world).translation.distance(matrix.w_axis.truncate()) < 1e-6);
}

#[test]
fn near_scenes_have_no_origins() {
    let mut app = app();
    let text = r#"{"camera": {"position": [40, 30, 20]}, "objects": [{"mesh": {"box": {}}}]}"#;
    let spawned = spawn(&SceneFile::from_json(text, "near.json").unwrap(), Path::new(""), app.world_mut()).unwrap();
    assert_eq!(spawned.origin, DVec3::ZERO);
    assert_eq!(app.world_mut().query::<&Origin>().iter(app.world()).count(), 0);
}

/// A model at map coordinates is framed where it is, by the automatic camera and by a view.
#[test]
fn a_model_far_away_is_framed_where_it_is() {
    let part = Part {
        name: "house".into(),
        mesh: Mesh::from(Cuboid::default()),
        material: None,
        world_from_part: bevy_math::Mat4::IDENTITY,
    };
    let model = Arc::new(Model { parts: vec![part], origin: TOWN, ..Model::default() });
    for camera in ["", r#""camera": {"view": "iso"}"#] {
        let mut scene = SceneFile::from_json(&format!("{{{camera}}}"), "far.json").unwrap();
        let loaded = LoadedModel { path: "house.ply".into(), model: model.clone(), material: Material::default() };
        scene.objects.push(ObjectEntry::new(MeshEntry::Model(loaded)));
        let mut app = app();
        let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
        assert!(spawned.origin.distance(TOWN) < 8.0, "{}", spawned.origin);
        let eye = world_place(spawned.camera, app.world()).translation;
        assert!((1.0..10.0).contains(&eye.distance(TOWN)), "{eye}");
        let outline = outline(app.world_mut());
        let far = outline.iter().map(|point| (point.as_dvec3() + spawned.origin).distance(TOWN)).fold(0.0, f64::max);
        assert!((far - 0.75_f64.sqrt()).abs() < 1e-5, "{camera} {far}");
        assert!(app.world().get::<Camera>(spawned.camera).unwrap().projection.near() > 0.0);
    }
}

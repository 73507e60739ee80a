//! Animations of model files on the entities of a scene.

use std::path::{Path, PathBuf};

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Quat, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::PointLight;
use halfway_mesh::{Mesh, Mesh3d};
use halfway_scene::options::SceneOptions;
use halfway_scene::{
    AnimationPlugin, MeshEntry, ModelParts, NameOrIndex, ObjectEntry, SceneFile, SceneTime, spawn, spawn_model,
    spawn_seen_from,
};

use crate::spawned::app;

/// A triangle that goes along x by 2 a second while a morph target lifts its third corner along z by 1 a second, under a
/// scale along x alone; a light and a camera hang on it. Both of its animations are of 4 seconds; the second one stands
/// still.
fn moving() -> String {
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let target = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let (times, places) = ([0.0, 4.0], [0.0, 0.0, 0.0, 8.0, 0.0, 0.0]);
    let (weights, still) = ([0.0, 4.0], [0.0; 6]);
    let lists = [&positions[..], &target, &times, &places, &weights, &still];
    let bytes = lists.iter().flat_map(|list| *list).flat_map(|x: &f32| x.to_le_bytes());
    let data = bytes.map(|byte| format!("%{byte:02x}")).collect::<Vec<_>>().concat();
    let (mut offset, mut accessors) = (0, Vec::new());
    for (list, shape, width) in lists
        .iter()
        .zip(["VEC3", "VEC3", "SCALAR", "VEC3", "SCALAR", "VEC3"])
        .map(|(list, shape)| (list, shape, if shape == "VEC3" { 3 } else { 1 }))
    {
        let bounds = if width == 3 { r#","min":[0,0,0],"max":[1,1,1]"# } else { "" };
        let count = list.len() / width;
        accessors.push(format!(
            r#"{{"bufferView":0,"byteOffset":{offset},"componentType":5126,"type":"{shape}","count":{count}{bounds}}}"#
        ));
        offset += 4 * list.len();
    }
    let animation = |name: &str, places: usize, weights: &str| {
        format!(
            r#"{{"name":"{name}","channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}{weights}],
            "samplers":[{{"input":2,"output":{places}}},{{"input":2,"output":4}}]}}"#
        )
    };
    let go = animation("go", 3, r#",{"sampler":1,"target":{"node":1,"path":"weights"}}"#);
    let stay = animation("stay", 5, "");
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"children":[1],"scale":[2,1,1],"camera":0,"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
            {{"mesh":0,"name":"flag","rotation":[0,0,0.5,0.8660254]}}],
        "cameras":[{{"name":"eye","type":"perspective","perspective":{{"yfov":1,"znear":0.1}}}}],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point"}}]}}}},
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":1}}]}}]}}],
        "animations":[{go},{stay}],"accessors":[{}],"bufferViews":[{{"buffer":0,"byteLength":{offset}}}],
        "buffers":[{{"byteLength":{offset},"uri":"data:,{data}"}}]}}"#,
        accessors.join(",")
    )
}

/// A file of the test's own, removed at the end.
struct ModelFile(PathBuf);

impl ModelFile {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("halfway_{name}_{}.gltf", std::process::id()));
        std::fs::write(&path, moving()).unwrap();
        Self(path)
    }
}

impl Drop for ModelFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn at(app: &mut App, time: f64) {
    app.insert_resource(SceneTime::At(time));
    app.update();
}

fn mesh_of(world: &World, entity: Entity) -> &Mesh {
    world.resource::<Assets<Mesh>>().get(&world.get::<Mesh3d>(entity).unwrap().0).unwrap()
}

fn placed(world: &World, entity: Entity) -> Mat4 {
    world.get::<GlobalTransform>(entity).unwrap().to_matrix()
}

/// The place of the triangle at a time: it shears.
fn expected(time: f32) -> Mat4 {
    let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_3);
    Mat4::from_translation(Vec3::X * 2.0 * time) * Mat4::from_scale(Vec3::new(2.0, 1.0, 1.0)) * Mat4::from_quat(turn)
}

#[test]
fn a_model_follows_the_time_of_the_scene() {
    let file = ModelFile::new("animated");
    let text = format!(
        r#"{{"objects": [{{"mesh": {{"path": {:?}}}, "normals": "face", "transform": {{"translation": [0, 0, 5]}}}}]}}"#,
        file.0.display().to_string()
    );
    let scene = SceneFile::from_json(&text, "test").unwrap();
    let mut app = app();
    app.add_plugins(AnimationPlugin);
    let spawned = spawn_seen_from(&scene, Path::new(""), "eye", app.world_mut()).unwrap();
    assert!(spawned.is_animated);
    let played = "the animation \"go\" is played, and not \"stay\"";
    assert!(spawned.warnings.iter().any(|warning| warning.ends_with(played)), "{:?}", spawned.warnings);
    let world = app.world_mut();
    let triangle = world.query_filtered::<Entity, With<Mesh3d>>().single(world).unwrap();
    let light = world.query_filtered::<Entity, With<PointLight>>().single(world).unwrap();
    for time in [0.0, 0.5, 1.75, 4.0, 0.0] {
        at(&mut app, time);
        let (world, time) = (app.world(), time as f32);
        let object = Mat4::from_translation(Vec3::Z * 5.0);
        let found = placed(world, triangle);
        assert!(found.abs_diff_eq(object * expected(time), 1e-5), "{time}: {found}");
        let mesh = mesh_of(world, triangle);
        assert_eq!(mesh.positions()[2], Vec3::new(0.0, 1.0, time));
        // Normals are made anew by the object's policy.
        let normal = Vec3::new(0.0, -time, 1.0).normalize();
        assert!(mesh.normals().iter().all(|n| n.distance(normal) < 1e-6), "{time}: {:?}", mesh.normals());
        for entity in [light, spawned.camera] {
            let place = placed(world, entity).w_axis.truncate();
            assert!(place.distance(Vec3::new(2.0 * time, 0.0, 5.0)) < 1e-5, "{time}: {place}");
        }
    }
}

/// The second animation stands still where the first one has gone by 3 after 1.5 seconds.
#[test]
fn an_animation_is_chosen_by_name_or_number() {
    let (file, other) = (ModelFile::new("chosen"), ModelFile::new("chosen_beside"));
    std::fs::write(&other.0, moving().replace("\"stay\"", "\"rest\"")).unwrap();
    let model = SceneFile::for_model;
    let chosen = |animation: &str, mut scene: SceneFile| {
        let animation = SceneOptions { animation: Some(animation.to_owned()), ..SceneOptions::default() };
        animation.apply(&mut scene);
        scene
    };
    let by_number = SceneFile { animation: Some(NameOrIndex::Index(1)), ..model(&file.0) };
    let read = SceneFile::from_json(&by_number.to_json().unwrap(), "test").unwrap();
    assert_eq!(read.animation, by_number.animation);
    for (scene, gone) in [
        (model(&file.0), 1.5),
        (chosen("go", model(&file.0)), 1.5),
        (chosen("stay", model(&file.0)), 0.0),
        (chosen("1", model(&file.0)), 0.0),
        (by_number, 0.0),
    ] {
        let mut app = app();
        app.add_plugins(AnimationPlugin);
        let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
        let is_said = spawned.warnings.iter().any(|warning| warning.contains("is played"));
        assert_eq!(is_said, scene.animation.is_none(), "{:?}", spawned.warnings);
        at(&mut app, 1.5);
        let world = app.world_mut();
        let triangle = world.query_filtered::<Entity, With<Mesh3d>>().single(world).unwrap();
        let place = placed(world, triangle).w_axis.truncate();
        assert!(place.distance(Vec3::X * 2.0 * gone) < 1e-5, "{:?}: {place}", scene.animation);
    }

    // Of two models one has it, and the other plays its first.
    let objects = [&file, &other].map(|file| ObjectEntry::new(MeshEntry::Path(file.0.clone()))).to_vec();
    let both = SceneFile { objects, ..SceneFile::default() };
    let spawned = spawn(&chosen("stay", both.clone()), Path::new(""), app().world_mut()).unwrap();
    let said = format!("{}: has no animation \"stay\"; \"go\" is played", other.0.display());
    assert!(spawned.warnings.contains(&said), "{:?}", spawned.warnings);
    let (first, second) = (file.0.display(), other.0.display());
    for wanted in ["walk", "2"] {
        let error = spawn(&chosen(wanted, both.clone()), Path::new(""), app().world_mut()).unwrap_err();
        let expected = format!(
            r#"scene: `animation`: is "{wanted}"; {first} has 0 "go", 1 "stay"; {second} has 0 "go", 1 "rest""#
        );
        assert_eq!(error.to_string(), expected);
    }
    let still = chosen("go", SceneFile::from_json(r#"{"objects": [{"mesh": {"teapot": {}}}]}"#, "test").unwrap());
    let error = spawn(&still, Path::new(""), app().world_mut()).unwrap_err();
    assert_eq!(error.to_string(), r#"scene: `animation`: is "go"; the models have none"#);
}

#[test]
fn a_model_by_itself_is_played_too() {
    let file = ModelFile::new("root");
    let mut app = app();
    app.add_plugins(AnimationPlugin);
    let root = spawn_model(&file.0, app.world_mut()).unwrap();
    let flag = app.world().get::<ModelParts>(root).and_then(|parts| parts.entity("flag")).expect("a part");
    at(&mut app, 1.5);
    assert!(placed(app.world(), flag).abs_diff_eq(expected(1.5), 1e-5));
    assert_eq!(mesh_of(app.world(), flag).positions()[2].z, 1.5);
}

#[test]
fn without_the_plugin_it_is_in_the_pose_of_the_file() {
    let file = ModelFile::new("still");
    let scene = SceneFile::for_model(&file.0);
    let mut app = app();
    spawn(&scene, Path::new(""), app.world_mut()).unwrap();
    app.update();
    let world = app.world_mut();
    let triangle = world.query_filtered::<Entity, With<Mesh3d>>().single(world).unwrap();
    assert!(placed(world, triangle).abs_diff_eq(expected(0.0), 1e-6));
}

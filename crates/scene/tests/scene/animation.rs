//! Key frames: their values in time, and the entities that have them.

use std::time::Duration;

use bevy_color::LinearRgba;
use bevy_math::{Quat, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{Camera, DirectionalLight, PointLight, Projection, light_direction};

use crate::spawned::app;
use halfway_scene::{AnimatedKey, AnimationPlugin, Interpolation, KeyFrame, SceneFile, SceneTime, TrackEntry, spawn};

fn track(of: AnimatedKey, keys: &[(f32, &[f64])]) -> TrackEntry {
    TrackEntry::new(of, keys.iter().map(|(time, value)| KeyFrame { time: *time, value: value.to_vec() }).collect())
}

#[test]
fn values_go_straight_from_a_key_frame_to_the_next() {
    let track = track(AnimatedKey::Translation, &[(1.0, &[1.0, 2.0, 3.0]), (3.0, &[2.0, 0.0, 3.0]), (4.0, &[0.0; 3])]);
    for (time, expected) in [
        (-5.0, [1.0, 2.0, 3.0]),
        (0.0, [1.0, 2.0, 3.0]),
        (1.0, [1.0, 2.0, 3.0]),
        (1.5, [1.25, 1.5, 3.0]),
        (3.0, [2.0, 0.0, 3.0]),
        (3.75, [0.5, 0.0, 0.75]),
        (4.0, [0.0; 3]),
        (1e9, [0.0; 3]),
    ] {
        assert_eq!(track.at(time)[..3], expected, "{time}");
    }
    let again = TrackEntry { repeat: true, ..track.clone() };
    for (time, same) in [(0.5, 1.0), (5.5, 1.5), (4.0, 0.0), (402.0, 2.0)] {
        assert_eq!(again.at(time), track.at(same), "{time}");
    }
    let steps = TrackEntry { interpolation: Interpolation::Step, ..track };
    for (time, expected) in [(0.0, 1.0), (2.999, 1.0), (3.0, 2.0), (3.999, 2.0), (4.0, 0.0), (9.0, 0.0)] {
        assert_eq!(steps.at(time)[0], expected, "{time}");
    }
}

#[test]
fn a_value_that_stays_is_exact() {
    let still = track(AnimatedKey::Diffuse, &[(0.0, &[0.1, 0.7, 1e-9]), (1.0, &[0.1, 0.7, 1e-9])]);
    let single = TrackEntry { repeat: true, ..track(AnimatedKey::Diffuse, &[(0.0, &[0.1, 0.7, 1e-9])]) };
    for time in [0.0, 0.1, 0.3, 0.7, 0.999, 1.0, 7.0] {
        assert_eq!(still.at(time), [0.1, 0.7, 1e-9, 0.0]);
        assert_eq!(single.at(time), still.at(0.0));
    }
}

#[test]
fn rotations_take_the_shorter_way_at_an_even_speed() {
    let about = |degrees: f32| Quat::from_rotation_y(degrees.to_radians()).to_array().map(f64::from);
    // The last one is the negative of the same rotation, and not of unit length.
    let minus = about(120.0).map(|c| -1.01 * c);
    let track = track(AnimatedKey::Rotation, &[(0.0, &about(0.0)), (1.0, &about(120.0)), (2.0, &minus)]);
    for (time, degrees) in [(0.0, 0.0), (0.25, 30.0), (0.5, 60.0), (1.0, 120.0), (1.5, 120.0), (2.0, 120.0)] {
        let found = bevy_math::DQuat::from_array(track.at(time)).as_quat();
        let expected = bevy_math::DQuat::from_array(about(degrees)).as_quat();
        assert!(found.is_normalized() && found.angle_between(expected) < 1e-3, "{time}: {found}");
    }
}

const SCENE: &str = r#"{
  "camera": {"position": [0, 0, 5], "animation": [
    {"of": "position", "keys": [[0, [0, 0, 5]], [2, [10, 0, 5]]]}, {"of": "target", "keys": [[0, [0, 0, 0]], [2, [10, 0, 0]]]},
    {"of": "fov_y_deg", "keys": [[0, 40], [2, 60]]}]},
  "lights": [
    {"kind": "point", "attach": {"object": 0}, "animation": [{"of": "position", "keys": [[0, [0, 1, 0]], [4, [0, 5, 0]]]}]},
    {"kind": "directional", "name": "sun", "animation": [
      {"of": "direction", "keys": [[0, [0, 0, -1]], [2, [-1, 0, 0]]], "interpolation": "step"},
      {"of": "diffuse", "keys": [[0, [0, 0, 0]], [2, [1, 2, 4]]]}]}
  ],
  "objects": [
    {"name": "box", "mesh": {"box": {}}, "transform": {"translation": [1, 2, 3], "scale": [2, 2, 2]}, "animation": [
      {"of": "translation", "keys": [[0, [1, 2, 3]], [1, [3, 2, 3]]], "repeat": true}]},
    {"mesh": {"box": {}}}
  ]
}"#;

#[test]
fn entities_have_the_values_of_the_time() {
    let scene = SceneFile::from_json(SCENE, "test").unwrap();
    assert_eq!(SceneFile::from_json(&scene.to_json().unwrap(), "again").unwrap(), scene);
    let mut app = app();
    app.add_plugins(AnimationPlugin);
    let spawned = spawn(&scene, "".as_ref(), app.world_mut()).unwrap();
    assert!(spawned.is_animated);
    for _ in 0..2 {
        app.insert_resource(SceneTime::At(1.5));
        app.update();
        let world = app.world();
        let transform = |entity| *world.get::<Transform>(entity).unwrap();
        let camera = transform(spawned.camera);
        assert_eq!(camera.translation, Vec3::new(7.5, 0.0, 5.0));
        assert!((*camera.forward() - Vec3::NEG_Z).length() < 1e-6);
        let projection = world.get::<Camera>(spawned.camera).unwrap().projection;
        assert_eq!(projection, Projection::perspective(55_f32.to_radians()));
        let [point, sun] = spawned.lights[..] else { panic!("two lights") };
        assert_eq!(transform(point).translation, Vec3::new(0.0, 2.5, 0.0));
        // The light is on the box, which is twice as large.
        assert_eq!(world.get::<GlobalTransform>(point).unwrap().translation(), Vec3::new(2.0, 7.0, 3.0));
        assert_eq!(world.get::<PointLight>(point), Some(&PointLight::white()));
        let toward = light_direction(world.get::<GlobalTransform>(sun).unwrap()).unwrap();
        assert!((toward - Vec3::NEG_Z).length() < 1e-6, "{toward}");
        assert_eq!(world.get::<DirectionalLight>(sun).unwrap().diffuse, LinearRgba::rgb(0.75, 1.5, 3.0));
        assert_eq!(transform(spawned.objects[0]).translation, Vec3::new(2.0, 2.0, 3.0));
        assert_eq!(transform(spawned.objects[0]).scale, Vec3::splat(2.0));
        assert_eq!(transform(spawned.objects[1]), Transform::IDENTITY);
        // The order of times is of no account.
        app.insert_resource(SceneTime::At(0.0));
        app.update();
    }
}

#[test]
fn the_clock_is_followed_unless_a_time_is_set() {
    let scene = SceneFile::from_json(SCENE, "test").unwrap();
    let mut app = app();
    app.add_plugins((AnimationPlugin, TimePlugin));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(250)));
    let spawned = spawn(&scene, "".as_ref(), app.world_mut()).unwrap();
    for frame in 0..4_u8 {
        app.update();
        let x = app.world().get::<Transform>(spawned.objects[0]).unwrap().translation.x;
        assert_eq!(x, 1.0 + 0.5 * f32::from(frame));
    }
}

#[test]
fn a_camera_that_would_look_nowhere_stays_as_it_was() {
    let text = r#"{"camera": {"animation": [{"of": "position", "keys": [[0, [0, 0, 2]], [2, [0, 0, -2]]]}]}}"#;
    let scene = SceneFile::from_json(text, "test").unwrap();
    let mut app = app();
    app.add_plugins(AnimationPlugin);
    let spawned = spawn(&scene, "".as_ref(), app.world_mut()).unwrap();
    let at = |app: &mut bevy_app::App, time| {
        app.insert_resource(SceneTime::At(time));
        app.update();
        app.world().get::<Transform>(spawned.camera).unwrap().translation.z
    };
    assert_eq!([0.5, 1.0, 1.5].map(|time| at(&mut app, time)), [1.0, 1.0, -1.0]);
}

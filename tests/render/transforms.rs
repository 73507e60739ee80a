//! Objects under every kind of transform: scaled, mirrored, sheared, flattened, tiny, huge and far away.

use crate::render::compare::{FLOAT, Failures, assert_as_expected, assert_finite, brightest, difference};
use crate::render::scene::{
    Lamp, On, Scene, Thing, directional_light, other_material, point_light, rotated, scaled, shining,
};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::prelude::*;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

/// A camera that is turned against every axis, and two lights.
fn around_origin() -> Scene {
    Scene::seen_from(Vec3::new(1.3, 1.1, 3.2), Vec3::ZERO)
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(2.0, 1.5, 1.0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.4, -0.5, -1.0)))
}

#[test]
fn normals_and_sides_are_right_under_every_transform() {
    let turn = rotated(0.5, 0.6, 0.7);
    let rows: [(&str, Vec<Transform>); 16] = [
        ("turned", vec![turn]),
        ("halved", vec![turn.with_scale(Vec3::splat(0.5))]),
        ("stretched", vec![scaled(1.6, 0.4, 0.9)]),
        ("stretched, then turned", vec![turn.with_scale(Vec3::new(1.5, 0.3, 0.8))]),
        ("mirrored in x", vec![turn.with_scale(Vec3::new(-1.0, 1.0, 1.0))]),
        ("mirrored in y", vec![turn.with_scale(Vec3::new(1.0, -1.0, 1.0))]),
        ("mirrored in z", vec![turn.with_scale(Vec3::new(1.0, 1.0, -1.0))]),
        ("mirrored in x and y", vec![turn.with_scale(Vec3::new(-1.0, -1.0, 1.0))]),
        ("mirrored in all axes", vec![turn.with_scale(Vec3::splat(-1.0))]),
        ("mirrored and stretched", vec![turn.with_scale(Vec3::new(1.4, -0.5, 0.8))]),
        ("a mirrored parent", vec![scaled(1.0, 1.0, -1.0), turn]),
        (
            "a mirrored child of a mirrored parent",
            vec![scaled(-1.0, 1.0, 1.0), turn.with_scale(Vec3::new(1.0, -1.0, 1.0))],
        ),
        ("sheared by its parent", vec![scaled(1.5, 0.5, 1.0), rotated(0.3, 0.4, 0.9)]),
        ("sheared and mirrored", vec![scaled(1.2, -0.6, 1.0), rotated(0.3, 0.4, 0.9)]),
        ("a thousandth as thick", vec![turn.with_scale(Vec3::new(1.0, 1e-3, 1.0))]),
        ("three frames deep", vec![rotated(0.2, 0.0, 0.1), scaled(0.7, 1.2, 1.0), turn.with_scale(Vec3::splat(0.8))]),
    ];
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let mesh = hemisphere(16, 8);
    for (name, frames) in rows {
        for shading in SHADINGS {
            for faces in [Faces::Front, Faces::Both] {
                let thing = Thing::new(mesh.clone()).frames(frames.clone()).shaded(shading).faces(faces);
                let scene = around_origin().with(thing.back(other_material()));
                let row = format!("{name}, {shading:?}, {faces:?} faces");
                let verdict = failures.draw_any(&row, &mut stage, &scene, FLOAT);
                // An open hemisphere may turn its inside to the camera, and only its front be asked for.
                let shows = verdict.counted + verdict.edges > 0.01 || faces == Faces::Front;
                failures.unless(shows, || format!("{row}: {verdict}"));
            }
        }
    }
    failures.finish();
}

#[test]
fn a_mirrored_sphere_looks_like_itself() {
    let mut stage = Stage::new(48, 48);
    let mut draw = |scale: Vec3| {
        let sphere = Thing::new(UvSphere::new(1.0, 64, 32)).at(Transform::from_scale(scale));
        stage.draw(&around_origin().with(sphere))
    };
    let plain = draw(Vec3::ONE);
    for scale in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, -1.0), -Vec3::ONE] {
        let mirrored = draw(scale);
        for (x, y) in [(24, 24), (16, 24), (32, 24), (24, 16), (24, 32), (30, 17)] {
            let (a, b) = (plain.get_pixel(x, y).0, mirrored.get_pixel(x, y).0);
            // Facets of 1/32 turn lie up to 1 − cos(π/32) = 0.5 % under the sphere, and cells have two diagonals.
            let close = (0..3).all(|k| (a[k] - b[k]).abs() < 0.01);
            assert!(close && a[0] > 0.03, "scale {scale}: pixel ({x}, {y}) is {b:?}, unmirrored {a:?}");
        }
    }
}

#[test]
fn a_flattened_sphere_is_a_disc_that_faces_one_way() {
    // Half of the sphere winds counter-clockwise on either side of the disc, whichever sign rounding gives the
    // determinant, which is 0.
    let turn = rotated(0.9, 0.4, 0.7);
    let rows: [(&str, Vec<Transform>); 7] = [
        ("x", vec![scaled(0.0, 1.0, 1.0)]),
        ("y", vec![scaled(1.0, 0.0, 1.0)]),
        ("z", vec![scaled(1.0, 1.0, 0.0)]),
        ("y, then turned", vec![turn.with_scale(Vec3::new(1.0, 0.0, 1.0))]),
        ("y by its parent", vec![scaled(1.0, 0.0, 1.0), turn]),
        ("z by its parent", vec![scaled(1.0, 1.0, 0.0), turn]),
        ("z by its parent, mirrored", vec![scaled(-1.0, 1.0, 0.0), rotated(0.3, 0.5, 0.1)]),
    ];
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    for (name, frames) in rows {
        for shading in SHADINGS {
            for eye in [Vec3::new(1.3, 1.1, 3.2), Vec3::new(-2.4, -0.7, 1.9), Vec3::new(0.8, 2.5, -2.2)] {
                let sphere = Thing::new(UvSphere::new(1.0, 16, 8)).frames(frames.clone()).shaded(shading);
                let mut scene = around_origin().with(sphere);
                scene.eye = Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Y);
                scene.lamps.push(Lamp::point(point_light(), Vec3::new(-1.0, -2.0, -1.5)));
                let row = format!("flattened in {name}, {shading:?}, seen from {eye}");
                failures.draw(&row, &mut stage, &scene, FLOAT);
            }
        }
    }
    failures.finish();
}

#[test]
fn an_object_flattened_to_a_line_or_a_point_shows_nothing() {
    let mut stage = Stage::new(32, 32);
    // Where nothing is round, rounding leaves triangles of some area.
    for turn in [Transform::IDENTITY, rotated(0.9, 0.4, 0.7), rotated(-0.5, 1.1, 2.3), rotated(2.9, -0.2, 0.4)] {
        for scale in [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0), Vec3::ZERO] {
            for shading in SHADINGS {
                let teapot = Thing::new(Teapot { divisions: 4 }).at(turn.with_scale(scale)).shaded(shading);
                let picture = stage.draw(&around_origin().ambient(1.0).with(teapot));
                let row = format!("{turn:?} after scale {scale}, {shading:?}");
                assert_finite(&row, &picture);
                assert!(brightest(&picture) < 1e-6, "{row}: {}", brightest(&picture));
            }
        }
    }
}

#[test]
fn every_scale_of_the_world_gives_the_same_picture() {
    // Lengths that differ by a common factor look the same where nothing weakens with distance.
    let light = PointLight { attenuation: Attenuation::NONE, ..point_light() };
    let sphere = |size: f32, shading, reflectance| {
        let at = |p: Vec3| p * size;
        let object = Transform::from_scale(Vec3::new(0.8, 1.0, 1.2) * size)
            .with_rotation(Quat::from_rotation_z(0.3))
            .with_translation(at(Vec3::new(0.1, 0.0, -0.2)));
        // Turned toward the origin from a unit's distance: the squares of these leave f32.
        let mut scene = Scene::seen_from(Vec3::new(1.3, 1.1, 3.2), Vec3::ZERO)
            .ambient(0.1)
            .lit(Lamp::point(light, at(Vec3::new(2.0, 1.5, 1.0))))
            .with(Thing::new(hemisphere(16, 8)).at(object).faces(Faces::Both).shaded(shading).reflecting(reflectance));
        scene.eye.translation = at(scene.eye.translation);
        scene.camera.projection = scene.camera.projection.with_near(0.1 * size);
        scene
    };
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    for (shading, reflectance) in
        SHADINGS.into_iter().flat_map(|shading| [Reflectance::default(), Reflectance::Phong].map(|r| (shading, r)))
    {
        let plain = stage.draw(&sphere(1.0, shading, reflectance));
        // The first and the last leave the object's lengths within 1e±30, which is as far as scene files go.
        for size in [1.3e-30, 1e-28, 1e-23, 1e-18, 1e-12, 1e-6, 1e6, 1e12, 1e18, 1e23, 1e28, 8e29] {
            let scene = sphere(size, shading, reflectance);
            let row = format!("{size:e} times as large, {shading:?}, {reflectance:?}");
            let picture = stage.draw(&scene);
            failures.compare(&row, &mut stage, &picture, FLOAT);
            // Powers of ten round, so an edge may move over a pixel's centre; compare where both are inside.
            let (a, b) = (plain.get_pixel(24, 24).0, picture.get_pixel(24, 24).0);
            let same = (0..3).all(|k| f64::from((a[k] - b[k]).abs()) < FLOAT.most);
            failures.unless(same, || format!("{row}: {b:?} instead of {a:?}"));
        }
    }
    failures.finish();
}

#[test]
fn a_mesh_of_any_size_gives_the_same_picture() {
    let mut stage = Stage::new(32, 32);
    let mut failures = Failures::default();
    let light = PointLight { attenuation: Attenuation::NONE, ..point_light() };
    for shading in SHADINGS {
        for size in [1e-18f32, 1e-9, 1.0, 1e9, 1e18] {
            let mut scene = Scene::seen_from(Vec3::new(0.5, 1.0, 3.0) * size, Vec3::ZERO)
                .with(Thing::new(UvSphere::new(size, 16, 8)).shaded(shading))
                .lit(Lamp::point(light, Vec3::new(2.0, 1.5, 1.0) * size));
            scene.camera.projection = scene.camera.projection.with_near(0.1 * size);
            let row = format!("radius {size:e}, {shading:?}");
            failures.draw(&row, &mut stage, &scene, FLOAT);
        }
    }
    failures.finish();
}

#[test]
fn a_scene_far_from_the_origin_looks_like_one_at_it() {
    // Whole units, which f32 holds exactly at 10⁷.
    let scene = |origin: Vec3, shading| {
        let mut scene = Scene::in_eye_space()
            .ambient(0.1)
            .with(Thing::new(UvSphere::new(1.0, 16, 8)).at(rotated(0.1, 0.2, 0.3).with_translation(origin)))
            .with(Thing::square(origin - Vec3::Y, Vec3::Y, 6.0))
            .lit(Lamp::point(point_light(), origin + Vec3::new(2.0, 3.0, 1.0)))
            .lit(Lamp {
                kind: crate::render::scene::Kind::Spot(SpotLight { light: point_light(), cone: Cone::new(0.5) }),
                on: On::World,
                at: shining(origin + Vec3::new(-2.0, 3.0, 2.0), Vec3::new(2.0, -3.0, -2.0)),
            });
        scene.eye = Transform::from_translation(origin + Vec3::new(1.0, 1.0, 4.0))
            .with_rotation(Transform::from_xyz(1.0, 1.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y).rotation);
        scene.view_shading = Some(shading);
        scene
    };
    let mut stage = Stage::new(48, 48);
    for shading in SHADINGS {
        let plain = stage.draw_bytes(&scene(Vec3::ZERO, shading));
        for origin in [Vec3::new(1e7, 0.0, 0.0), Vec3::new(-1e7, 1e7, 1e7), Vec3::new(0.0, -1.6e7, 1.2e7)] {
            let far = stage.draw_bytes(&scene(origin, shading));
            let largest = plain.iter().zip(far.iter()).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(largest <= Some(1), "{shading:?} at {origin}: off by {largest:?} steps");
        }
    }
}

#[test]
fn a_scene_far_from_the_origin_does_not_jitter() {
    // The camera and the light move by whole units, which f32 holds exactly at 10⁷; the picture must move as it does at
    // the origin, and a frame drawn again be the same.
    let frame = |origin: Vec3, step: f32, shading| {
        let eye = Vec3::new(step - 4.0, 3.0, 12.0);
        let turn = rotated(0.1, 0.2, 0.3).with_scale(Vec3::splat(3.0));
        let mut scene = Scene::in_eye_space()
            .ambient(0.1)
            .with(Thing::new(UvSphere::new(1.0, 16, 8)).at(turn.with_translation(origin)).shaded(shading))
            .lit(Lamp::point(point_light(), origin + Vec3::new(step, 4.0, 3.0)));
        let looking = Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Y).rotation;
        scene.eye = Transform::from_translation(origin + eye).with_rotation(looking);
        scene
    };
    let mut stage = Stage::new(48, 48);
    for shading in SHADINGS {
        for step in 0..8 {
            let near = stage.draw_bytes(&frame(Vec3::ZERO, step as f32, shading));
            for origin in [Vec3::new(1e7, 0.0, 0.0), Vec3::new(-1e7, 1e7, 1e7)] {
                let row = format!("{shading:?}, step {step}, at {origin}");
                let far = stage.draw_bytes(&frame(origin, step as f32, shading));
                let largest = near.iter().zip(far.iter()).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(largest <= Some(1), "{row}: off by {largest:?} steps");
                assert_eq!(far, stage.bytes(), "{row}: the next frame differs");
            }
        }
    }
}

#[test]
fn lights_in_a_hierarchy_move_with_their_parents() {
    let spot = SpotLight { light: point_light(), cone: Cone { cutoff: 0.6, inner: Some(0.3), exponent: 1.0 } };
    let beside = shining(Vec3::new(0.5, 1.8, 0.4), Vec3::new(-0.3, -1.0, -0.2));
    let kinds = [
        ("point", Lamp::point(point_light(), Vec3::new(0.4, 1.7, 0.6))),
        ("spot", Lamp { at: beside, ..Lamp::spot(spot, Vec3::ZERO, Vec3::NEG_Z) }),
        ("directional", Lamp { at: beside, ..Lamp::directional(directional_light(), Vec3::NEG_Z) }),
    ];
    let mut stage = Stage::new(48, 48);
    for (kind, lamp) in kinds {
        for (to, on) in [("the world", On::World), ("the camera", On::Camera), ("an object", On::Thing(0))] {
            let frames = vec![rotated(0.2, 0.5, 0.1), scaled(0.9, 0.7, 1.1), rotated(0.0, 0.3, 0.8)];
            let mut scene = Scene::seen_from(Vec3::new(1.3, 1.1, 3.2), Vec3::ZERO).ambient(0.1);
            scene.things = vec![
                Thing::new(UvSphere::new(1.0, 16, 8)).frames(frames),
                Thing::square(Vec3::new(0.0, -1.0, 0.0), Vec3::Y, 6.0),
            ];
            let scene = scene.lit(lamp.clone().on(on));
            assert_as_expected(&format!("a {kind} light on {to}"), &mut stage, &scene);
        }
    }
}

#[test]
fn moving_the_camera_and_the_world_together_changes_nothing() {
    // Shading depends on relative positions: the camera's rotation must cancel. f32 transforms leave some 1e-6 of it.
    let scene = |turn: Quat| {
        let moved = |t: Transform| Transform::from_rotation(turn) * t;
        let mut scene = around_origin().with(Thing::square(Vec3::ZERO, Vec3::new(0.1, 1.0, 0.4), 9.0));
        scene.eye = moved(scene.eye);
        for lamp in &mut scene.lamps {
            lamp.at = moved(lamp.at);
        }
        scene.things[0].frames[0] = moved(scene.things[0].frames[0]);
        scene
    };
    let mut stage = Stage::new(24, 24);
    let plain = stage.draw(&scene(Quat::IDENTITY));
    for turn in [Quat::from_rotation_x(1.0), Quat::from_rotation_z(2.5), Quat::from_euler(EulerRot::XYZ, 0.4, 3.0, 1.2)]
    {
        let turned = stage.draw(&scene(turn));
        assert!(difference(&plain, &turned) < 1e-4, "{turn}: {}", difference(&plain, &turned));
    }
}

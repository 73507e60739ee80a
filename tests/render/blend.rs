//! Blended objects: their order, their sides, and their effect on surfaces behind them.

use crate::render::compare::assert_as_expected;
use crate::render::scene::{Lamp, Scene, Thing, glowing, other_material, point_light};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::prelude::*;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

/// A glowing square before the camera.
fn pane(distance: f32, colour: [f32; 3], opacity: f32) -> Thing {
    let [red, green, blue] = colour;
    Thing::square(Vec3::NEG_Z * distance, Vec3::Z, 99.0).with_material(glowing(red, green, blue)).blended(opacity)
}

/// Layers over a background, farthest first.
fn over(background: f32, layers: &[(f32, f32)]) -> f32 {
    layers.iter().fold(background, |behind, (value, opacity)| opacity * value + (1.0 - opacity) * behind)
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

fn assert_centre(row: &str, stage: &mut Stage, scene: &Scene, expected: [f32; 3]) {
    let centre = stage.draw(scene).get_pixel(4, 4).0;
    // A few roundings of numbers of about 1.
    let close = (0..3).all(|k| (centre[k] - expected[k]).abs() < 1e-6 * expected[k].max(1.0));
    assert!(close && centre[3].to_bits() == 1f32.to_bits(), "{row}: {centre:?}, expected {expected:?}");
}

#[test]
fn layers_are_drawn_back_to_front_in_any_spawn_order() {
    let panes = [pane(5.0, RED, 0.5), pane(4.0, GREEN, 0.25), pane(3.0, BLUE, 0.75)];
    let expected = [0, 1, 2].map(|k| {
        let of = |i: usize| f32::from(u8::from(i == k));
        over(0.1, &[(of(0), 0.5), (of(1), 0.25), (of(2), 0.75)])
    });
    let mut stage = Stage::new(9, 9);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mut scene = Scene::in_eye_space();
        scene.camera.background = LinearRgba::rgb(0.1, 0.1, 0.1);
        scene.things = order.map(|i: usize| panes[i].clone()).to_vec();
        assert_centre(&format!("spawned as {order:?}"), &mut stage, &scene, expected);
    }
}

#[test]
fn the_order_follows_the_camera() {
    let mut stage = Stage::new(9, 9);
    let red = pane(0.0, RED, 0.5).faces(Faces::Both).at(Transform::from_xyz(0.0, 0.0, 1.0).with_rotation(facing()));
    let blue = pane(0.0, BLUE, 0.5).faces(Faces::Both).at(Transform::from_xyz(0.0, 0.0, -1.0).with_rotation(facing()));
    for (eye, expected) in [(5.0, [0.5, 0.0, 0.25]), (-5.0, [0.25, 0.0, 0.5])] {
        let scene = Scene::seen_from(Vec3::Z * eye, Vec3::ZERO).with(red.clone()).with(blue.clone());
        assert_centre(&format!("seen from {eye}"), &mut stage, &scene, expected);
    }
}

fn facing() -> Quat {
    Quat::from_rotation_arc(Vec3::Y, Vec3::Z)
}

#[test]
fn equal_depths_are_drawn_in_the_order_they_were_spawned() {
    let mut stage = Stage::new(9, 9);
    for (colours, expected) in [
        ([RED, GREEN, BLUE], [0.125, 0.25, 0.5]),
        ([BLUE, GREEN, RED], [0.5, 0.25, 0.125]),
        ([GREEN, BLUE, RED], [0.5, 0.125, 0.25]),
    ] {
        let mut scene = Scene::in_eye_space();
        scene.things = colours.map(|colour| pane(3.0, colour, 0.5)).to_vec();
        assert_centre(&format!("{colours:?}"), &mut stage, &scene, expected);
    }
}

#[test]
fn equal_depths_keep_the_spawn_order_after_despawns() {
    // A later entity reuses the index of a despawned one.
    let mut stage = Stage::new(9, 9);
    stage.set(&Scene::in_eye_space());
    let spawn = |stage: &mut Stage, colour| {
        let thing = pane(3.0, colour, 0.5);
        let handle = stage.handle(&thing.mesh);
        stage.world().spawn((Mesh3d(handle), thing.material, AlphaMode::Blend, thing.frames[0])).id()
    };
    let gone = spawn(&mut stage, BLUE);
    let red = spawn(&mut stage, RED);
    stage.float();
    stage.world().despawn(gone);
    let green = spawn(&mut stage, GREEN);
    let blue = spawn(&mut stage, BLUE);
    let centre = stage.float().get_pixel(4, 4).0;
    for entity in [red, green, blue] {
        stage.world().despawn(entity);
    }
    assert_eq!(centre, [0.125, 0.25, 0.5, 1.0], "red, then green, then blue over each other");
}

#[test]
fn a_blended_object_covers_and_is_covered_by_opaque_ones() {
    let mut stage = Stage::new(9, 9);
    let wall =
        |distance: f32| Thing::square(Vec3::NEG_Z * distance, Vec3::Z, 99.0).with_material(glowing(0.2, 0.4, 0.6));
    let glass = || pane(3.0, [0.8, 0.8, 0.8], 0.25);
    let through = [over(0.2, &[(0.8, 0.25)]), over(0.4, &[(0.8, 0.25)]), over(0.6, &[(0.8, 0.25)])];
    for (row, things, expected) in [
        ("before a wall, spawned first", [glass(), wall(5.0)], through),
        ("before a wall, spawned last", [wall(5.0), glass()], through),
        ("behind a wall, spawned first", [glass(), wall(2.0)], [0.2, 0.4, 0.6]),
        ("behind a wall, spawned last", [wall(2.0), glass()], [0.2, 0.4, 0.6]),
    ] {
        let mut scene = Scene::in_eye_space();
        scene.things = things.to_vec();
        assert_centre(row, &mut stage, &scene, expected);
    }
}

#[test]
fn blended_objects_write_no_depth() {
    // The near pane's centre is farther away than the far one's: it is drawn first, and must not hide the other.
    let mut stage = Stage::new(9, 9);
    let near = pane(3.0, RED, 0.5);
    let tilted =
        Thing::square(Vec3::new(0.0, 0.0, -4.0), Vec3::Z, 99.0).with_material(glowing(0.0, 0.0, 1.0)).blended(0.5);
    let mut aside = near.clone();
    // Moved far to the side along itself, and back, by tilting it about the axis of the view.
    aside.frames[0].translation = Vec3::new(20.0, 0.0, -12.0);
    aside.frames[0].rotation = Quat::from_rotation_arc(Vec3::Y, Vec3::new(9.0, 0.0, 20.0).normalize());
    let scene = Scene::in_eye_space().with(aside).with(tilted);
    let picture = stage.draw(&scene);
    let centre = picture.get_pixel(4, 4).0;
    assert!((centre[0] - 0.25).abs() < 1e-6 && (centre[2] - 0.5).abs() < 1e-6, "{centre:?}");
}

#[test]
fn zero_and_full_opacity() {
    let mut stage = Stage::new(9, 9);
    let mut scene = Scene::in_eye_space().with(pane(3.0, RED, 0.0));
    scene.camera.background = LinearRgba::rgb(0.0, 0.5, 0.0);
    assert_centre("clear", &mut stage, &scene, [0.0, 0.5, 0.0]);
    scene.things = vec![pane(3.0, RED, 1.0)];
    assert_centre("opaque", &mut stage, &scene, RED);
}

#[test]
fn opacity_does_nothing_without_blend() {
    let mut stage = Stage::new(9, 9);
    for opacity in [0.0, 0.3, 1.0] {
        let mut thing = pane(3.0, [0.3, 0.6, 0.9], opacity);
        thing.blend = false;
        for shading in SHADINGS {
            let scene = Scene::in_eye_space().with(thing.clone().shaded(shading));
            assert_centre(&format!("opacity {opacity}, {shading:?}"), &mut stage, &scene, [0.3, 0.6, 0.9]);
        }
    }
}

#[test]
fn a_two_sided_object_shows_its_far_side_through_its_near_one() {
    // A bowl from outside: its inside is behind its outside, under every shading and with both ways of lighting.
    let mut stage = Stage::new(40, 40);
    for shading in SHADINGS {
        for lit in [false, true] {
            for opacity in [0.3, 0.8] {
                let mut back = other_material();
                back.opacity = 0.6;
                let bowl = Thing::new(hemisphere(12, 6)).at(Transform::from_rotation(Quat::from_rotation_x(2.6)));
                let bowl = bowl.shaded(shading).faces(Faces::Both).back(back).blended(opacity);
                let mut scene = Scene::seen_from(Vec3::new(0.0, -0.4, 3.0), Vec3::ZERO).ambient(0.3).with(bowl);
                scene.camera.background = LinearRgba::rgb(0.5, 0.2, 0.1);
                if lit {
                    scene = scene.lit(Lamp::point(point_light(), Vec3::new(1.5, -0.5, 2.0)));
                }
                assert_as_expected(&format!("{shading:?}, lit {lit}, opacity {opacity}"), &mut stage, &scene);
            }
        }
    }
}

#[test]
fn one_sided_blended_objects_show_the_side_asked_for() {
    let mut stage = Stage::new(9, 9);
    for (eye, faces, expected) in [
        (3.0, Faces::Front, [0.5, 0.0, 0.0]),
        (-3.0, Faces::Front, [0.0, 0.0, 0.0]),
        (3.0, Faces::Back, [0.0, 0.0, 0.0]),
        (-3.0, Faces::Back, [0.0, 0.0, 0.25]),
        (3.0, Faces::Both, [0.5, 0.0, 0.0]),
        (-3.0, Faces::Both, [0.0, 0.0, 0.25]),
    ] {
        for shading in SHADINGS {
            let back = Material { opacity: 0.25, ..glowing(0.0, 0.0, 1.0) };
            let square =
                Thing::square(Vec3::ZERO, Vec3::Z, 9.0).with_material(glowing(1.0, 0.0, 0.0)).back(back).blended(0.5);
            let scene = Scene::seen_from(Vec3::Z * eye, Vec3::ZERO).with(square.faces(faces).shaded(shading));
            assert_centre(&format!("from {eye}, {faces:?}, {shading:?}"), &mut stage, &scene, expected);
        }
    }
}

#[test]
fn opaque_pixels_are_the_same_beside_a_blended_object() {
    let mut stage = Stage::new(24, 24);
    let mut scene = Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO).with(Thing::new(UvSphere::new(1.0, 24, 12)));
    scene = scene.lit(Lamp::point(point_light(), Vec3::new(1.0, 2.0, 4.0)));
    scene.camera.encoding = Encoding::Srgb;
    let alone = stage.draw_bytes(&scene);
    let out_of_sight = pane(0.0, [1.0; 3], 0.5).at(Transform::from_xyz(500.0, 0.0, 0.0));
    let beside = stage.draw_bytes(&scene.clone().with(out_of_sight));
    let steps = alone.iter().zip(beside.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    // Each encodes within a step.
    assert!(steps <= Some(1), "{steps:?}");
    assert!(stage.draw_bytes(&scene) == alone, "alone again it looks different");
}

#[test]
fn bytes_clamp_overbright_surfaces_before_blending() {
    let mut stage = Stage::new(9, 9);
    for encoding in [Encoding::Raw, Encoding::Srgb] {
        let mut scene = Scene::in_eye_space().with(pane(3.0, [8.0, 0.5, 0.0], 0.5));
        scene.camera.encoding = encoding;
        let centre = stage.draw_bytes(&scene).get_pixel(4, 4).0;
        for (k, expected) in [0.5, 0.25, 0.0].into_iter().enumerate() {
            let expected = 255.0 * encoding.encode(expected);
            // Blending happens on stored 8-bit values, which may round once more.
            assert!((f64::from(centre[k]) - expected).abs() <= 1.0, "{encoding:?}: {centre:?}, channel {k} {expected}");
        }
        // Floating point keeps all of it.
        assert!((stage.float().get_pixel(4, 4).0[0] - 4.0).abs() < 1e-6);
    }
}

#[test]
fn blended_objects_are_smoothed_like_others() {
    let mut stage = Stage::new(9, 9);
    let mut scene = Scene::in_eye_space().with(pane(4.0, RED, 0.5)).with(pane(3.0, BLUE, 0.5));
    scene.camera.samples = Samples::Four;
    let centre = stage.draw(&scene).get_pixel(4, 4).0;
    // Powers of two are exact.
    assert_eq!(centre, [0.25, 0.0, 0.5, 1.0]);
}

#[test]
fn transforms_and_meshes_may_differ_between_neighbours_in_depth() {
    // Sorted by depth, neighbours rarely share mesh and material: every draw must set its own.
    let mut stage = Stage::new(40, 40);
    let mut scene = Scene::seen_from(Vec3::new(0.5, 0.8, 6.0), Vec3::ZERO).ambient(0.2);
    for i in 0..9 {
        let at = Transform::from_xyz(0.25 * i as f32 - 1.0, 0.2 * (i % 3) as f32, 0.6 * ((i * 4) % 9) as f32 - 2.0);
        let thing = match i % 3 {
            0 => Thing::new(UvSphere::new(0.6, 10, 5)),
            1 => Thing::square(Vec3::ZERO, Vec3::Z, 1.2).with_material(other_material()),
            _ => Thing::new(Cuboid::new(0.7, 0.7, 0.1)).with_material(glowing(0.2, 0.9, 0.4)),
        };
        let rotation = thing.frames[0].rotation;
        scene.things.push(thing.at(at.with_rotation(rotation)).blended(0.4).shaded(SHADINGS[i / 3]));
    }
    let scene = scene.lit(Lamp::point(point_light(), Vec3::new(1.0, 2.0, 4.0)));
    assert_as_expected("nine things", &mut stage, &scene);
}

//! The visible one of coincident surfaces, whatever else is in the scene.

use crate::render::compare::{FLOAT, Failures, assert_as_expected};
use crate::render::scene::{Lamp, Scene, Thing, glowing, material, other_material, point_light, rotated};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::prelude::*;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

/// The near side was once drawn first if an equal draw came before.
#[test]
fn a_far_side_comes_first_whatever_was_drawn_before() {
    let mut stage = Stage::new(40, 40);
    for shading in SHADINGS {
        let bowl = |faces| {
            let bowl = Thing::new(hemisphere(12, 6)).shaded(shading).faces(faces).back(other_material()).blended(0.6);
            bowl.at(Transform::from_rotation(Quat::from_rotation_x(2.6)))
        };
        let mut aside = bowl(Faces::Front);
        aside.frames[0].translation = Vec3::new(1.2, 0.8, -1.0);
        let scene = Scene::seen_from(Vec3::new(0.0, -0.4, 3.0), Vec3::ZERO)
            .ambient(0.3)
            .with(aside)
            .with(bowl(Faces::Both))
            .lit(Lamp::point(point_light(), Vec3::new(1.5, -0.5, 2.0)));
        let verdict = assert_as_expected(&format!("{shading:?}"), &mut stage, &scene);
        assert!(verdict.counted > 0.2, "{verdict}");
    }
}

/// Coincident objects of one mesh, after objects that are drawn first because of their state.
#[test]
fn of_equal_opaque_objects_the_first_spawned_is_seen() {
    let mut stage = Stage::new(40, 40);
    let mut failures = Failures::default();
    let ball = |material, shading, faces| {
        Thing::new(UvSphere::new(0.8, 24, 12))
            .at(rotated(0.3, 0.4, 0.5))
            .with_material(material)
            .shaded(shading)
            .faces(faces)
    };
    let brass = Material::BRASS;
    for (name, lights) in [("one light", 1), ("many lights", 12)] {
        for (first, second) in [
            ((brass, Shading::Phong, Faces::Front), (material(), Shading::Phong, Faces::Front)),
            ((brass, Shading::Flat, Faces::Front), (material(), Shading::Flat, Faces::Both)),
            // Depths of flat triangles are rounded otherwise: here either may be seen.
            ((brass, Shading::Flat, Faces::Front), (material(), Shading::Phong, Faces::Front)),
            ((brass, Shading::Phong, Faces::Front), (material(), Shading::Gouraud, Faces::Both)),
            ((brass, Shading::Gouraud, Faces::Both), (glowing(1.0, 0.0, 0.5), Shading::Phong, Faces::Front)),
        ] {
            let [first, second] = [first, second].map(|(material, shading, faces)| ball(material, shading, faces));
            let mut aside = second.clone();
            aside.frames[0].translation = Vec3::new(1.1, 0.9, -1.0);
            let mut scene = Scene::seen_from(Vec3::new(0.2, 0.1, 3.5), Vec3::ZERO).ambient(0.2);
            for i in 0..lights {
                let (sine, cosine) = (0.5 * i as f32).sin_cos();
                scene = scene.lit(Lamp::point(point_light(), Vec3::new(3.0 * cosine, 3.0 * sine, 2.0)));
            }
            for (unrelated, before) in [("none", vec![]), ("one like the second", vec![aside])] {
                let mut scene = scene.clone();
                scene.things = before;
                scene.things.extend([first.clone(), second.clone(), first.clone()]);
                stage.set(&scene);
                let picture = stage.float();
                let row = format!("{name}, {:?} before {:?}, unrelated: {unrelated}", first.shading, second.shading);
                failures.compare(&row, &mut stage, &picture, FLOAT);
            }
        }
    }
    failures.finish();
}

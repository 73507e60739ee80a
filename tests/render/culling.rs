//! Patches of large meshes: those outside the frustum or facing away are culled, and nothing visible is missing.

use crate::render::compare::{FLOAT, Failures};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, other_material, point_light, rotated, scaled};
use crate::render::stage::Stage;
use halfway::prelude::*;
use std::ops::RangeInclusive;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
const FACES: [Faces; 3] = [Faces::Front, Faces::Back, Faces::Both];
/// A sphere of 65,024 triangles. The normals of a patch of 32 spread by a few degrees, so that a ring of patches about
/// the outline is drawn without a visible triangle; the finer the sphere, the narrower the ring.
const SPHERE: UvSphere = UvSphere { radius: 1.0, segments: 256, rings: 128 };
/// A sphere of 8,064 triangles, which are wider than their rounding errors.
const COARSE: UvSphere = UvSphere { radius: 1.0, segments: 64, rings: 64 };

fn lit(scene: Scene) -> Scene {
    scene
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(0.3, 0.4, 0.5)))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)))
}

/// Draws the scene in every shading; the share of the patches that are culled has to be within `culled`.
fn assert_culled(failures: &mut Failures, stage: &mut Stage, row: &str, scene: &Scene, culled: RangeInclusive<f32>) {
    for shading in SHADINGS {
        let mut scene = scene.clone();
        scene.things[0].shading = Some(shading);
        let row = format!("{row}, {shading:?}");
        // The first picture shows meshes whole.
        failures.draw_any(&format!("{row}, whole"), stage, &scene, FLOAT);
        let verdict = failures.draw_any(&row, stage, &scene, FLOAT);
        let FrameReport { patches, patches_culled, triangles, triangles_in, .. } = *stage.report();
        let share = patches_culled as f32 / patches as f32;
        println!("{row}: {patches_culled} of {patches} patches culled; 99.9 % within {:.1e}", verdict.most);
        failures.unless(patches > 100, || format!("{row}: {patches} patches"));
        failures.unless(culled.contains(&share), || format!("{row}: {patches_culled} of {patches} patches culled"));
        // Culled patches are not drawn, and the others are drawn once.
        let drawn = triangles as f32 / triangles_in as f32;
        failures
            // A few hidden patches between two of a run are drawn with it.
            .unless((-0.01..0.12).contains(&(drawn + share - 1.0)), || {
                format!("{row}: {triangles} of {triangles_in} triangles")
            });
    }
}

#[test]
fn about_half_of_a_sphere_is_turned_away() {
    let mut stage = Stage::new(64, 64);
    let mut failures = Failures::default();
    // From 20 radii away 47.5 % of it face the eye.
    let rows: [(&str, Vec<Transform>); 5] = [
        ("as it is", vec![Transform::IDENTITY]),
        ("turned", vec![rotated(0.5, 0.6, 0.7)]),
        ("mirrored", vec![scaled(-1.0, 1.0, 1.0)]),
        ("mirrored and turned", vec![rotated(0.5, 0.6, 0.7).with_scale(Vec3::new(1.0, 1.0, -1.0))]),
        ("larger, turned inside out", vec![rotated(0.3, 0.6, 0.7).with_scale(Vec3::splat(-1.5))]),
    ];
    for (row, frames) in rows {
        for faces in FACES {
            let mut scene = lit(Scene::seen_from(Vec3::new(3.0, 5.0, 19.0), Vec3::ZERO));
            scene.camera.projection = Projection::perspective(0.2);
            let scene = scene.with(Thing::new(SPHERE).frames(frames.clone()).faces(faces).back(other_material()));
            let share = if faces == Faces::Both { 0.0..=0.0 } else { 0.4..=0.6 };
            assert_culled(&mut failures, &mut stage, &format!("{row}, {faces:?} faces"), &scene, share);
        }
    }
    failures.finish();
}

#[test]
fn sheared_spheres_are_whole() {
    let mut stage = Stage::new(64, 64);
    let mut failures = Failures::default();
    let turn = rotated(0.0, 0.0, 0.7);
    let rows: [(&str, Vec<Transform>); 3] = [
        ("stretched", vec![scaled(1.8, 0.6, 1.0)]),
        ("sheared", vec![scaled(1.8, 0.5, 1.0), turn]),
        ("sheared and mirrored", vec![scaled(-1.8, 0.5, 1.0), turn]),
    ];
    for (row, frames) in rows {
        for faces in FACES {
            let mut scene = lit(Scene::seen_from(Vec3::new(3.0, 5.0, 19.0), Vec3::ZERO));
            scene.camera.projection = Projection::perspective(0.25);
            let scene = scene.with(Thing::new(COARSE).frames(frames.clone()).faces(faces).back(other_material()));
            // Their normals spread differently from those of the mesh, so that patches that face away may be kept.
            assert_culled(&mut failures, &mut stage, &format!("{row}, {faces:?} faces"), &scene, 0.0..=0.6);
        }
    }
    failures.finish();
}

#[test]
fn a_sphere_around_the_camera_shows_what_lies_ahead() {
    let mut stage = Stage::new(64, 64);
    let mut failures = Failures::default();
    for (place, eye) in [("the middle", Vec3::ZERO), ("beside the wall", Vec3::new(0.5, 0.3, -0.72))] {
        for target in [Vec3::NEG_Z, Vec3::new(1.0, 0.2, 0.1), Vec3::new(-0.3, -1.0, 0.4)] {
            for faces in FACES {
                let mut scene = lit(Scene::seen_from(eye, eye + target));
                scene.camera.projection = scene.camera.projection.with_near(0.01);
                let thing = Thing::new(SPHERE).faces(faces).back(other_material());
                let share = if faces == Faces::Front { 0.8..=1.0 } else { 0.2..=0.995 };
                let row = format!("from {place} to {target}, {faces:?} faces");
                assert_culled(&mut failures, &mut stage, &row, &scene.with(thing), share);
            }
        }
    }
    failures.finish();
}

#[test]
fn walls_close_by_are_cut_at_the_borders_alone() {
    let mut stage = Stage::new(96, 64);
    let mut failures = Failures::default();
    let wall = Plane { size: 20.0, divisions: 64 };
    // Over the plane y = 0, close to it and far away, along it and across.
    let rows = [
        ("along it", Vec3::new(0.2, 0.3, 9.0), Vec3::new(0.3, 0.1, 0.0), 0.2..=0.95),
        ("just above it", Vec3::new(0.2, 0.05, 3.0), Vec3::new(0.3, 0.0, 0.0), 0.2..=0.95),
        ("down on it", Vec3::new(1.2, 0.4, 2.0), Vec3::new(1.3, 0.0, 1.9), 0.9..=1.0),
        ("from a corner", Vec3::new(9.9, 0.5, 9.9), Vec3::ZERO, 0.0..=0.8),
    ];
    for (row, eye, target, share) in rows {
        for faces in [Faces::Front, Faces::Both] {
            let scene = lit(Scene::seen_from(eye, target)).with(Thing::new(wall).faces(faces));
            assert_culled(&mut failures, &mut stage, &format!("{row}, {faces:?} faces"), &scene, share.clone());
        }
    }
    failures.finish();
}

#[test]
fn a_flat_wall_is_culled_whole_or_not_at_all() {
    let mut stage = Stage::new(64, 64);
    let mut failures = Failures::default();
    let wall = Plane { size: 2.0, divisions: 64 };
    for (side, eye) in [("front", 4.0), ("back", -4.0)] {
        for faces in FACES {
            let scene = lit(Scene::seen_from(Vec3::new(0.3, eye, 0.5), Vec3::ZERO));
            let scene = scene.with(Thing::new(wall).faces(faces).back(other_material()));
            let shows = matches!((side, faces), (_, Faces::Both) | ("front", Faces::Front) | ("back", Faces::Back));
            let share = if shows { 0.0..=0.0 } else { 1.0..=1.0 };
            assert_culled(&mut failures, &mut stage, &format!("{faces:?} faces from the {side}"), &scene, share);
        }
    }
    failures.finish();
}

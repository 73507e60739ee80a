//! Scenes far from the origin of the world, with an `Origin`: they look as they do at the origin.

use crate::render::compare::{FLOAT, Failures, brightest};
use crate::render::scene::{Lamp, On, Scene, Thing, directional_light, other_material, point_light, rotated, scaled};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// A town in map coordinates, and where f32 counts in steps of 64.
const FAR: [DVec3; 3] =
    [DVec3::new(400_000.25, 5_000_000.5, 0.0), DVec3::splat(1e9), DVec3::new(-1e9, 0.0, 123_456_789.125)];

/// Things in frames of their own, lamps in the world, on the camera and on a thing.
fn scene() -> Scene {
    let cone = Thing::new(UvSphere::new(0.5, 24, 12)).frames(vec![rotated(0.3, 0.2, 0.1), scaled(1.2, 0.7, 1.0)]);
    Scene::seen_from(Vec3::new(1.3, 1.1, 3.2), Vec3::ZERO)
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(2.0, 1.5, 1.0)))
        .lit(Lamp::point(point_light(), Vec3::new(0.3, 0.2, 0.0)).on(On::Camera))
        .lit(Lamp::point(point_light(), Vec3::new(0.0, 1.0, 0.0)).on(On::Thing(0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.4, -0.5, -1.0)))
        .with(cone.back(other_material()))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(0.8, -0.4, -0.6)))
}

/// Moves all that has no parent, in f64.
fn move_roots(stage: &mut Stage, origin: DVec3) {
    let world = stage.world();
    let mut roots = world.query_filtered::<Entity, (With<Transform>, Without<ChildOf>)>();
    let roots: Vec<Entity> = roots.iter(world).collect();
    for root in roots {
        world.entity_mut(root).insert(Origin(origin));
    }
}

#[test]
fn a_scene_far_away_looks_as_it_does_at_the_origin() {
    let mut stage = Stage::new(64, 48);
    let mut failures = Failures::default();
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let mut scene = scene();
        scene.view_shading = Some(shading);
        let near = stage.draw(&scene);
        for origin in FAR {
            move_roots(&mut stage, origin);
            let far = stage.float();
            failures.compare(&format!("{shading:?} at {origin}"), &mut stage, &far, FLOAT);
            // Of all pixels few are at edges, where a last bit of a place decides.
            let others =
                near.pixels().zip(far.pixels()).filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 0.5 / 255.0));
            let others = others.count();
            failures.unless(others <= 16, || format!("{shading:?} at {origin}: {others} pixels differ by half a step"));
        }
        // The planted fault: as far away by its `Transform`s, which f32 rounds.
        let mut rounded = scene.clone();
        let away = FAR[1].as_vec3();
        rounded.eye.translation += away;
        rounded
            .lamps
            .iter_mut()
            .filter(|lamp| matches!(lamp.on, On::World))
            .for_each(|lamp| lamp.at.translation += away);
        rounded.things.iter_mut().for_each(|thing| thing.frames[0].translation += away);
        let rounded = stage.draw(&rounded);
        let others = near.pixels().zip(rounded.pixels()).filter(|(a, b)| (a[0] - b[0]).abs() > 0.5 / 255.0).count();
        failures
            .unless(others > 200 && brightest(&near) > 0.5, || format!("{shading:?}: only {others} pixels show it"));
    }
    failures.finish();
}

#[test]
fn what_a_pixel_shows_is_told_in_the_world() {
    let mut stage = Stage::new(64, 48);
    stage.draw(&scene());
    let near = Surfaces::take(stage.world()).expect("surfaces").at(30, 24).expect("a thing");
    for origin in FAR {
        move_roots(&mut stage, origin);
        stage.float();
        let surfaces = Surfaces::take(stage.world()).expect("surfaces");
        let far = surfaces.at(30, 24).expect("a thing");
        assert_eq!((far.entity, far.triangle, surfaces.origin()), (near.entity, near.triangle, origin));
        assert!(far.position.distance(near.position + origin) < 1e-5, "{}", far.position - origin);
    }
}

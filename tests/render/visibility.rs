//! Hidden objects are drawn as if they were not there, by the renderer and by the oracle.

use crate::render::compare::{FLOAT, Failures, assert_identical, difference};
use crate::render::scene::{Lamp, On, Scene, Thing, directional_light, material, other_material, point_light, rotated};
use crate::render::stage::Stage;
use Visibility::{Hidden, Inherited, Visible};
use halfway::prelude::*;

const SIZE: UVec2 = UVec2::new(40, 32);

/// A sphere that carries a spot, a floor, a pane and two more lights. The sphere hangs on a frame of its own.
fn scene() -> Scene {
    let sphere = Thing::new(UvSphere::new(0.8, 12, 6)).frames([rotated(0.1, 0.2, 0.3), rotated(0.0, 0.4, 0.0)]);
    let floor = Thing::new(Plane { size: 4.0, divisions: 4 }).at(Transform::from_xyz(0.0, -0.8, 0.0));
    let pane = Thing::square(Vec3::new(0.5, 0.0, 1.2), Vec3::Z, 0.8).blended(0.5);
    let spot = SpotLight { light: point_light(), cone: Cone { cutoff: 0.9, inner: Some(0.2), exponent: 1.0 } };
    Scene::seen_from(Vec3::new(0.4, 1.4, 3.2), Vec3::new(0.0, -0.1, 0.0))
        .ambient(0.15)
        .with(sphere.with_material(material()))
        .with(floor.with_material(other_material()))
        .with(pane)
        .lit(Lamp::spot(spot, Vec3::Y * 2.0, Vec3::NEG_Y).on(On::Thing(0)))
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.7, -1.0, -0.2)))
}

fn without(things: &[usize], lamps: &[usize]) -> Scene {
    let mut scene = scene();
    // In reverse, so that indices stay valid; a lamp on a thing is removed with it.
    for &lamp in lamps.iter().rev() {
        scene.lamps.remove(lamp);
    }
    for &thing in things.iter().rev() {
        scene.things.remove(thing);
    }
    scene
}

fn each<L: Component>(world: &mut World) -> Vec<Entity> {
    world.query_filtered::<Entity, With<L>>().iter(world).collect()
}

fn set(world: &mut World, entity: Entity, visibility: Visibility) {
    world.entity_mut(entity).insert(visibility);
}

fn hide_first<L: Component>(world: &mut World) {
    let first = each::<L>(world)[0];
    set(world, first, Hidden);
}

fn parent(world: &World, entity: Entity) -> Entity {
    world.get::<ChildOf>(entity).expect("it hangs on a frame").parent()
}

type Hide = fn(&mut World, &[Entity]);

/// The hidden entities, and the scene without them.
fn rows() -> Vec<(&'static str, Hide, Scene)> {
    vec![
        ("nothing", |world, things| set(world, things[0], Inherited), scene()),
        ("the floor", |world, things| set(world, things[1], Hidden), without(&[1], &[])),
        ("the blended pane", |world, things| set(world, things[2], Hidden), without(&[2], &[])),
        ("the sphere and its light", |world, things| set(world, things[0], Hidden), without(&[0], &[0])),
        (
            "what they hang on",
            |world, things| {
                let frame = parent(world, things[0]);
                set(world, frame, Hidden);
            },
            without(&[0], &[0]),
        ),
        (
            "what they hang on, but not them",
            |world, things| {
                let frame = parent(world, things[0]);
                set(world, frame, Hidden);
                set(world, things[0], Visible);
            },
            scene(),
        ),
        ("the spot", |world, _| hide_first::<SpotLight>(world), without(&[], &[0])),
        ("the point light", |world, _| hide_first::<PointLight>(world), without(&[], &[1])),
        ("the sun", |world, _| hide_first::<DirectionalLight>(world), without(&[], &[2])),
        (
            "all lights and the pane",
            |world, things| {
                let mut lights = each::<SpotLight>(world);
                lights.extend(each::<PointLight>(world));
                lights.extend(each::<DirectionalLight>(world));
                lights.push(things[2]);
                for entity in lights {
                    set(world, entity, Hidden);
                }
            },
            without(&[2], &[0, 1, 2]),
        ),
        // Visibility has no effect on the camera.
        ("the camera", |world, _| hide_first::<Camera>(world), scene()),
    ]
}

#[test]
fn hidden_entities_do_not_change_the_picture() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let whole = stage.draw(&scene());
    let mut failures = Failures::default();
    for (name, hide, expected) in rows() {
        let things = stage.set(&scene());
        // Drawn once before it is hidden, so that leftovers of earlier frames would show.
        assert_identical(name, &whole, &stage.float());
        hide(stage.world(), &things);
        let (hidden, of_hidden) = (stage.float(), stage.report().clone());
        failures.compare(name, &mut stage, &hidden, FLOAT);
        let bytes = stage.bytes();
        let is_whole = expected.things.len() + expected.lamps.len() == 6;
        failures.unless((difference(&hidden, &whole) == 0.0) == is_whole, || format!("{name}: hiding does not show"));

        let mut other = Stage::new(SIZE.x, SIZE.y);
        assert_identical(name, &other.draw(&expected), &hidden);
        let count = |report: &FrameReport| (report.objects, report.visible, report.lights, report.draws);
        assert_eq!(count(&of_hidden), count(other.report()), "{name}");
        assert_eq!(bytes, other.bytes(), "{name}: bytes");

        let world = stage.world();
        for entity in each::<Visibility>(world) {
            world.entity_mut(entity).remove::<Visibility>();
        }
        assert_identical(&format!("{name} shown again"), &whole, &stage.float());
    }
    failures.finish();
}

#[test]
fn hidden_entities_are_not_validated() {
    let rows: [(&str, Hide); 4] = [
        ("a transform that is no number", |world, things| {
            world.get_mut::<Transform>(things[1]).expect("it has one").translation.x = f32::NAN;
            set(world, things[1], Hidden);
        }),
        ("a mesh that is missing", |world, things| {
            world.entity_mut(things[1]).insert((Mesh3d::default(), Hidden));
        }),
        ("a material out of range", |world, things| {
            world.get_mut::<Material>(things[1]).expect("it has one").shininess = -1.0;
            set(world, things[1], Hidden);
        }),
        ("a light out of range", |world, _| {
            let light = each::<PointLight>(world)[0];
            world.get_mut::<PointLight>(light).expect("it is one").range = Some(-1.0);
            set(world, light, Hidden);
        }),
    ];
    let mut stage = Stage::new(8, 8);
    for (name, spoil) in rows {
        let things = stage.set(&scene());
        spoil(stage.world(), &things);
        assert_eq!(stage.frame().errors, [], "{name}");
        stage.oracle();
        for hidden in each::<Visibility>(stage.world()) {
            set(stage.world(), hidden, Visible);
        }
        assert_eq!(stage.frame().errors.len(), 1, "{name}: shown, it is checked");
    }
}

#[test]
fn hidden_entities_cost_no_computation() {
    let mut stage = Stage::new(8, 8);
    let things = stage.set(&scene());
    stage.frame();
    set(stage.world(), things[1], Hidden);
    for (entity, x) in [(things[1], 0.1), (things[0], 0.2)] {
        stage.world().get_mut::<Transform>(entity).expect("it has one").translation.x = x;
    }
    assert_eq!(stage.frame().matrices, 1, "of the one that is shown");
}

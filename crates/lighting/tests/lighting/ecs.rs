//! The components in an app of somebody else's.

use bevy_app::App;
use bevy_color::LinearRgba;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::world::World;
use bevy_transform::TransformPlugin;
use bevy_transform::components::{GlobalTransform, Transform};
use glam::{Quat, Vec3};
use halfway_lighting::{
    DirectionalLight, GlobalAmbient, LightingPlugin, PointLight, Propagation, SpotLight, light_direction,
    light_position, propagation,
};

#[test]
fn the_plugin_works_alone_and_keeps_what_is_there() {
    let mut app = App::new();
    app.add_plugins(LightingPlugin);
    app.update();
    assert_eq!(*app.world().resource::<GlobalAmbient>(), GlobalAmbient::default());

    let night = GlobalAmbient(LinearRgba::BLACK);
    let mut app = App::new();
    app.insert_resource(night).add_plugins(LightingPlugin);
    assert_eq!(*app.world().resource::<GlobalAmbient>(), night);
}

#[test]
fn every_light_brings_its_transform() {
    let mut app = App::new();
    let lights = [
        app.world_mut().spawn(PointLight::white()).id(),
        app.world_mut().spawn(SpotLight::default()).id(),
        app.world_mut().spawn(DirectionalLight::white()).id(),
    ];
    for light in lights {
        assert!(app.world().entity(light).contains::<GlobalTransform>());
    }
}

#[test]
fn a_light_moves_with_its_parent() {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, LightingPlugin));
    let quarter_turn = Transform::from_xyz(10.0, 0.0, 0.0)
        .with_rotation(Quat::from_rotation_y(core::f32::consts::FRAC_PI_2))
        .with_scale(Vec3::new(1.0, 2.0, 3.0));
    let carrier = app.world_mut().spawn(quarter_turn).id();
    let light =
        app.world_mut().spawn((SpotLight::default(), Transform::from_xyz(0.0, 0.0, -1.0), ChildOf(carrier))).id();
    app.update();
    let transform = *app.world().entity(light).get::<GlobalTransform>().expect("required");
    let (position, direction) = (light_position(&transform), light_direction(&transform));
    assert!(position.expect("finite").distance(Vec3::new(7.0, 0.0, 0.0)) < 1e-5);
    assert!(direction.expect("not 0").distance(Vec3::NEG_X) < 1e-6, "scale leaves the direction a unit vector");

    app.world_mut().entity_mut(carrier).get_mut::<Transform>().expect("spawned so").translation.y = 5.0;
    app.update();
    let moved = *app.world().entity(light).get::<GlobalTransform>().expect("required");
    assert!(light_position(&moved).expect("finite").distance(Vec3::new(7.0, 5.0, 0.0)) < 1e-5);
}

#[test]
fn one_entity_shows_whether_transforms_are_propagated() {
    let (here, there) = (Transform::from_xyz(1.0, 2.0, 3.0), Transform::from_xyz(4.0, 5.0, 6.0));
    let (origin, nowhere) = (Transform::IDENTITY, Transform::from_xyz(f32::NAN, 0.0, 0.0));
    let none = GlobalTransform::IDENTITY;
    let mut world = World::new();
    let [a, b] = [(); 2].map(|()| world.spawn_empty().id());
    let rows = [
        ("nothing", vec![], Propagation::Unknown),
        ("at the origin", vec![(a, origin, none)], Propagation::Unknown),
        (
            "the identity, written otherwise",
            vec![(a, origin.with_rotation(-Quat::IDENTITY), none)],
            Propagation::Unknown,
        ),
        ("propagated", vec![(a, here, here.into())], Propagation::Works),
        ("not propagated", vec![(a, here, none)], Propagation::Missing(a)),
        ("the first of two", vec![(a, here, none), (b, there, none)], Propagation::Missing(a)),
        ("late", vec![(a, here, none), (b, there, there.into())], Propagation::Works),
        ("by hand, with a transform", vec![(a, here, there.into())], Propagation::Unknown),
        ("by hand, without", vec![(a, origin, there.into())], Propagation::Unknown),
        ("no number", vec![(a, nowhere, nowhere.into())], Propagation::Unknown),
    ];
    for (row, roots, expected) in rows {
        let found = propagation(roots.iter().map(|(entity, transform, global)| (*entity, transform, global)));
        assert_eq!(found, expected, "{row}");
    }
}

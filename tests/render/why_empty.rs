//! Why a picture shows nothing, and pictures of the world as it is.

use halfway::prelude::*;
use halfway::render::{AdapterChoice, EmptyReason, why_empty};

/// An app with a ball, a camera before it and a light.
fn app() -> (App, [Entity; 3]) {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(UVec2::new(32, 24))).insert_resource(AdapterChoice::cpu());
    let world = app.world_mut();
    let ball = world.resource_mut::<Assets<Mesh>>().add(UvSphere::default());
    world.insert_resource(GlobalAmbient(LinearRgba::BLACK));
    let ball = world.spawn((Mesh3d(ball), Material::BRASS, Name::new("ball"))).id();
    let camera = world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0))).id();
    let light = world.spawn((PointLight::white(), Transform::from_xyz(0.0, 2.0, 4.0))).id();
    (app, [ball, camera, light])
}

#[test]
fn an_empty_picture_has_its_reason() {
    type Row = (fn(&mut World, [Entity; 3]), Option<EmptyReason>);
    let inside = EmptyReason::CameraInside { entity: "\"ball\"".into() };
    let rows: [Row; 12] = [
        (|_, _| {}, None),
        (
            |world, [_, camera, _]| {
                world.despawn(camera);
            },
            Some(EmptyReason::NoCamera),
        ),
        (
            |world, [ball, ..]| {
                world.despawn(ball);
            },
            Some(EmptyReason::NoObject),
        ),
        (
            |world, [ball, ..]| {
                world.entity_mut(ball).insert(Visibility::Hidden);
            },
            Some(EmptyReason::AllHidden(1)),
        ),
        (
            |world, [ball, ..]| {
                world.entity_mut(ball).insert(Mesh3d(Handle::default()));
            },
            Some(EmptyReason::NoMesh(1)),
        ),
        (
            |world, [_, camera, _]| {
                world.entity_mut(camera).insert(Transform::from_xyz(0.0, 0.0, -4.0));
            },
            Some(EmptyReason::AllBehind(1)),
        ),
        (
            |world, [_, camera, _]| {
                world.entity_mut(camera).insert(Transform::from_xyz(40.0, 0.0, 4.0));
            },
            Some(EmptyReason::AllOutside(1)),
        ),
        (
            |world, [.., light]| {
                world.despawn(light);
            },
            Some(EmptyReason::NoLight(1)),
        ),
        (
            |world, [ball, _, light]| {
                world.despawn(light);
                world.entity_mut(ball).insert(Material::emissive(Color::WHITE));
            },
            None,
        ),
        (
            |world, [_, camera, _]| {
                world.entity_mut(camera).insert(Transform::default());
            },
            Some(inside),
        ),
        (
            |world, [ball, ..]| {
                world.entity_mut(ball).insert(Transform::from_scale(Vec3::ZERO));
            },
            Some(EmptyReason::NoSize(1)),
        ),
        (
            |world, [ball, ..]| {
                // It turns its back to the camera.
                let leaf = Mesh::from(Plane { size: 1.0, divisions: 1 });
                let leaf = world.resource_mut::<Assets<Mesh>>().add(leaf);
                let turned = Transform::from_rotation(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2));
                world.entity_mut(ball).insert((Mesh3d(leaf), turned));
            },
            Some(EmptyReason::FacesAway(1)),
        ),
    ];
    for (row, (change, expected)) in rows.into_iter().enumerate() {
        let (mut app, entities) = app();
        change(app.world_mut(), entities);
        app.update();
        assert_eq!(why_empty(app.world_mut()), expected, "row {row}");
    }
}

#[test]
fn a_picture_of_the_world_steps_nothing() {
    #[derive(Resource, Default)]
    struct Steps(u32);
    let (mut app, [ball, ..]) = app();
    app.init_resource::<Steps>().add_systems(Update, |mut steps: ResMut<Steps>| steps.0 += 1);
    let stepped = render_picture(&mut app).expect("a picture");
    let now = app.world().resource::<Time>().elapsed();
    let taken = take_picture(app.world_mut()).expect("a picture");
    assert!(stepped == taken && app.world().resource::<Steps>().0 == 1);
    app.world_mut().entity_mut(ball).insert(Transform::from_xyz(0.5, 0.0, 0.0));
    let moved = take_picture(app.world_mut()).expect("a picture");
    assert!(moved != taken && app.world().resource::<Steps>().0 == 1);
    assert_eq!(app.world().resource::<Time>().elapsed(), now);
    let error = take_picture(&mut World::new()).expect_err("nothing draws");
    assert_eq!(format!("{error:?}"), error.to_string());
}

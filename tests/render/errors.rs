//! Errors name the entity and the field that cannot be drawn as asked, and nothing panics.

use crate::render::scene::{Lamp, Scene, Thing, glowing, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::render::{PendingPicture, RenderError};

fn scene() -> Scene {
    Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO)
        .with(Thing::new(UvSphere::new(1.0, 8, 4)).named("ball"))
        .lit(Lamp::point(point_light(), Vec3::ONE))
}

fn camera(world: &mut World) -> Entity {
    world.query_filtered::<Entity, With<Camera>>().iter(world).next().expect("a camera")
}

fn object(world: &mut World) -> Entity {
    world.query_filtered::<Entity, With<Mesh3d>>().iter(world).next().expect("an object")
}

fn edit_camera(world: &mut World, edit: impl FnOnce(&mut Camera)) {
    let camera = camera(world);
    let mut entity = world.entity_mut(camera);
    entity.insert(Name::new("eye"));
    edit(&mut entity.get_mut::<Camera>().expect("a camera"));
}

fn edit_material(world: &mut World, edit: impl FnOnce(&mut Material)) {
    let object = object(world);
    edit(&mut world.get_mut::<Material>(object).expect("a material"));
}

fn place(world: &mut World, entity: Entity, transform: Transform) {
    world.entity_mut(entity).insert(transform);
}

fn lamp(world: &mut World, light: impl Bundle) {
    world.spawn((Name::new("lamp"), light));
}

fn point(edit: impl FnOnce(&mut PointLight)) -> PointLight {
    let mut light = PointLight::white();
    edit(&mut light);
    light
}

/// A fault planted in a good scene, and the words of its error.
type Row = (&'static str, fn(&mut World), &'static [&'static str]);

const NAN: LinearRgba = LinearRgba::rgb(0.5, f32::NAN, 0.5);

const LIGHTS: &[Row] = &[
    ("a NaN colour", |w| lamp(w, point(|l| l.diffuse = NAN)), &["\"lamp\"", "PointLight.diffuse.green", "NaN"]),
    (
        "a negative colour",
        |w| lamp(w, point(|l| l.specular.blue = -1.0)),
        &["\"lamp\"", "PointLight.specular.blue", "-1"],
    ),
    (
        "an infinite ambient",
        |w| lamp(w, point(|l| l.ambient.red = f32::INFINITY)),
        &["\"lamp\"", "PointLight.ambient.red"],
    ),
    (
        "a negative attenuation",
        |w| lamp(w, point(|l| l.attenuation.linear = -0.5)),
        &["\"lamp\"", "attenuation.linear", "-0.5"],
    ),
    (
        "no attenuation",
        |w| lamp(w, point(|l| l.attenuation = Attenuation::new(0.0, 0.0, 0.0))),
        &["\"lamp\"", "attenuation", "all 0"],
    ),
    ("a range of 0", |w| lamp(w, point(|l| l.range = Some(0.0))), &["\"lamp\"", "PointLight.range"]),
    ("a NaN range", |w| lamp(w, point(|l| l.range = Some(f32::NAN))), &["\"lamp\"", "PointLight.range", "NaN"]),
    ("a cone of 100°", |w| lamp(w, SpotLight::white(1.75)), &["\"lamp\"", "SpotLight.cone.cutoff", "1.75"]),
    (
        "an inner cone that is the outer one",
        |w| lamp(w, SpotLight { cone: Cone { inner: Some(0.9), ..Cone::new(0.5) }, ..SpotLight::white(0.5) }),
        &["\"lamp\"", "cone.inner", "0.9"],
    ),
    (
        "a NaN exponent",
        |w| lamp(w, SpotLight { cone: Cone { exponent: f32::NAN, ..Cone::new(0.5) }, ..SpotLight::white(0.5) }),
        &["\"lamp\"", "cone.exponent", "NaN"],
    ),
    (
        "a spot whose light is bad",
        |w| lamp(w, SpotLight { light: point(|l| l.range = Some(-1.0)), ..SpotLight::white(0.5) }),
        &["\"lamp\"", "SpotLight.light.range", "-1"],
    ),
    (
        "a NaN direction's colour",
        |w| lamp(w, DirectionalLight::new(NAN)),
        &["\"lamp\"", "DirectionalLight.diffuse.green"],
    ),
    (
        "a NaN place",
        |w| lamp(w, (PointLight::white(), Transform::from_xyz(f32::NAN, 0.0, 0.0))),
        &["\"lamp\"", "translation", "NaN"],
    ),
    (
        "an infinite place",
        |w| lamp(w, (PointLight::white(), Transform::from_xyz(0.0, f32::INFINITY, 0.0))),
        &["\"lamp\"", "translation", "inf"],
    ),
    (
        "no direction",
        |w| lamp(w, (DirectionalLight::white(), Transform::from_scale(Vec3::ZERO))),
        &["\"lamp\"", "direction"],
    ),
    (
        "a spot's direction of NaN",
        |w| lamp(w, (SpotLight::white(0.5), Transform::from_rotation(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)))),
        &["\"lamp\"", "direction"],
    ),
    ("a NaN global ambient", |w| w.insert_resource(GlobalAmbient(NAN)), &["GlobalAmbient", "green", "NaN"]),
    (
        "a light without a name",
        |w| {
            w.spawn(point(|l| l.range = Some(0.0)));
        },
        &["entity ", "PointLight.range"],
    ),
];

const OBJECTS: &[Row] = &[
    (
        "a term a triangle beside one at the vertices",
        |w| {
            let object = object(w);
            let terms = Terms { diffuse: Frequency::Triangle, specular: Frequency::Vertex };
            w.entity_mut(object).insert(Shading::Terms(terms));
        },
        &["\"ball\"", "Shading.Terms.diffuse", "Vertex", "Triangle"],
    ),
    ("a NaN colour", |w| edit_material(w, |m| m.diffuse = NAN), &["\"ball\"", "Material.diffuse.green", "NaN"]),
    (
        "a negative colour",
        |w| edit_material(w, |m| m.specular.red = -0.1),
        &["\"ball\"", "Material.specular.red", "-0.1"],
    ),
    (
        "an infinite emission",
        |w| edit_material(w, |m| m.emission.blue = f32::INFINITY),
        &["\"ball\"", "Material.emission.blue"],
    ),
    ("a negative shininess", |w| edit_material(w, |m| m.shininess = -2.0), &["\"ball\"", "Material.shininess", "-2"]),
    ("a NaN shininess", |w| edit_material(w, |m| m.shininess = f32::NAN), &["\"ball\"", "Material.shininess", "NaN"]),
    ("an opacity above 1", |w| edit_material(w, |m| m.opacity = 1.5), &["\"ball\"", "Material.opacity", "1.5"]),
    ("a NaN opacity", |w| edit_material(w, |m| m.opacity = f32::NAN), &["\"ball\"", "Material.opacity", "NaN"]),
    (
        "a bad back material",
        |w| {
            let object = object(w);
            w.entity_mut(object).insert(BackMaterial(Material { shininess: -3.0, ..Material::DEFAULT }));
        },
        &["\"ball\"", "BackMaterial.shininess", "-3"],
    ),
    (
        "a handle to no mesh",
        |w| {
            let object = object(w);
            w.entity_mut(object).insert(Mesh3d(Handle::default()));
        },
        &["\"ball\"", "mesh"],
    ),
    (
        "a NaN place",
        |w| {
            let object = object(w);
            place(w, object, Transform::from_xyz(0.0, f32::NAN, 0.0));
        },
        &["\"ball\"", "NaN"],
    ),
    (
        "an infinite scale",
        |w| {
            let object = object(w);
            place(w, object, Transform::from_scale(Vec3::new(1.0, f32::INFINITY, 1.0)));
        },
        &["\"ball\""],
    ),
    (
        "a NaN rotation",
        |w| {
            let object = object(w);
            place(w, object, Transform::from_rotation(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)));
        },
        &["\"ball\""],
    ),
];

const VIEWS: &[Row] = &[
    (
        "no camera",
        |w| {
            let camera = camera(w);
            w.entity_mut(camera).remove::<Camera>();
        },
        &["no camera"],
    ),
    (
        "two cameras",
        |w| {
            w.spawn(Camera::default());
        },
        &["2 cameras"],
    ),
    (
        "a field of view of 0",
        |w| edit_camera(w, |c| c.projection = Projection::perspective(0.0)),
        &["\"eye\"", "Camera.projection.fov_y", "0.0"],
    ),
    (
        "a field of view of 180°",
        |w| edit_camera(w, |c| c.projection = Projection::perspective(3.2)),
        &["\"eye\"", "Camera.projection.fov_y", "3.2"],
    ),
    (
        "a NaN field of view",
        |w| edit_camera(w, |c| c.projection = Projection::perspective(f32::NAN)),
        &["\"eye\"", "Camera.projection.fov_y", "NaN"],
    ),
    (
        "a near plane at the eye",
        |w| edit_camera(w, |c| c.projection = c.projection.with_near(0.0)),
        &["\"eye\"", "Camera.projection.near"],
    ),
    (
        "an infinite near plane",
        |w| edit_camera(w, |c| c.projection = c.projection.with_near(f32::INFINITY)),
        &["\"eye\"", "Camera.projection.near"],
    ),
    ("a NaN background", |w| edit_camera(w, |c| c.background = NAN), &["\"eye\"", "Camera.background", "NaN"]),
    ("a negative background", |w| edit_camera(w, |c| c.background.red = -1.0), &["\"eye\"", "Camera.background"]),
    (
        "a camera at NaN",
        |w| {
            edit_camera(w, |_| ());
            let camera = camera(w);
            place(w, camera, Transform::from_xyz(0.0, 0.0, f32::NAN));
        },
        &["\"eye\""],
    ),
    (
        "a camera without size, which has no direction",
        |w| {
            edit_camera(w, |_| ());
            let camera = camera(w);
            place(w, camera, Transform::from_xyz(0.0, 0.0, 4.0).with_scale(Vec3::ZERO));
        },
        &["\"eye\""],
    ),
    ("a picture without width", |w| w.resource_mut::<Headless>().size.x = 0, &["pixel"]),
    ("a picture without size", |w| w.resource_mut::<Headless>().size = UVec2::ZERO, &["pixel"]),
    ("a picture too wide", |w| w.resource_mut::<Headless>().size.x = 1_000_000, &["1000000", "pixels", "limit"]),
    ("the largest number of pixels", |w| w.resource_mut::<Headless>().size = UVec2::MAX, &["4294967295", "limit"]),
];

/// Each row on a good scene, in one App, which must draw again as soon as the scene is good again.
fn every_row_is_refused(rows: &[Row]) {
    let mut stage = Stage::new(8, 8);
    let good = stage.draw(&scene());
    let mut wrong = Vec::new();
    for (row, spoil, says) in rows {
        stage.set(&scene());
        spoil(stage.world());
        match stage.try_draw() {
            Ok(_) => wrong.push(format!("{row} is drawn without an error")),
            Err(error) => {
                let message = error.to_string();
                for part in says.iter().filter(|part| !message.contains(**part)) {
                    wrong.push(format!("{row}: \"{message}\" does not say {part}"));
                }
            }
        }
        // Everything that the row spawned beside the scene.
        let world = stage.world();
        let strays: Vec<Entity> = world
            .query_filtered::<Entity, Or<(With<PointLight>, With<SpotLight>, With<DirectionalLight>, With<Camera>)>>()
            .iter(world)
            .collect();
        stage.world().resource_mut::<Headless>().size = UVec2::new(8, 8);
        for stray in strays {
            stage.world().despawn(stray);
        }
        if stage.draw(&scene()) != good {
            wrong.push(format!("after {row} a good scene is not drawn as before"));
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn bad_lights_are_refused_by_name_and_field() {
    every_row_is_refused(LIGHTS);
}

#[test]
fn bad_objects_are_refused_by_name_and_field() {
    every_row_is_refused(OBJECTS);
}

#[test]
fn bad_views_and_targets_are_refused_by_name_and_field() {
    every_row_is_refused(VIEWS);
}

#[test]
fn invalid_entities_are_left_out_and_the_rest_is_drawn() {
    let mut stage = Stage::new(16, 16);
    let square = |x: f32, name: &str, material: Material| {
        Thing::square(Vec3::new(x, 0.0, -3.0), Vec3::Z, 1.0).named(name).with_material(material)
    };
    let scene = Scene::in_eye_space()
        .with(square(-0.6, "good", glowing(0.5, 0.5, 0.5)))
        .with(square(0.6, "bad", Material { shininess: f32::NAN, ..glowing(0.5, 0.5, 0.5) }))
        .lit(Lamp::point(PointLight { range: Some(-1.0), ..point_light() }, Vec3::ZERO));
    stage.set(&scene);
    let report = stage.frame();
    let messages: Vec<String> = report.errors.iter().map(ToString::to_string).collect();
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("range")), "{messages:?}");
    assert!(
        messages.iter().any(|message| message.contains("\"bad\"") && message.contains("shininess")),
        "{messages:?}"
    );
    assert_eq!((report.lights, report.draws), (0, 1));
    let pending = PendingPicture::request(stage.app.world()).expect("the frame was drawn");
    let Ok(Picture::Float(picture)) = pending.wait() else { panic!("no picture") };
    assert_eq!(picture.get_pixel(4, 8).0, [0.5, 0.5, 0.5, 1.0], "the good one");
    assert_eq!(picture.get_pixel(11, 8).0, [0.0, 0.0, 0.0, 1.0], "the bad one");
}

#[test]
fn errors_last_as_long_as_their_cause() {
    let mut stage = Stage::new(8, 8);
    stage.set(&Scene {
        things: vec![Thing::new(Cuboid::default()).with_material(Material { opacity: 2.0, ..Material::DEFAULT })],
        ..scene()
    });
    for _ in 0..3 {
        assert_eq!(stage.frame().errors.len(), 1);
    }
    edit_material(stage.world(), |material| material.opacity = 1.0);
    assert_eq!(stage.frame().errors, []);
}

#[test]
fn there_is_no_picture_before_the_first_frame() {
    let stage = Stage::new(8, 8);
    assert_eq!(PendingPicture::request(stage.app.world()).err(), Some(RenderError::NoPicture));
}

#[test]
fn an_empty_scene_is_its_background() {
    let mut stage = Stage::new(8, 8);
    let mut scene = Scene::in_eye_space();
    scene.camera.background = LinearRgba::rgb(0.1, 0.2, 0.3);
    assert!(stage.draw(&scene).pixels().all(|pixel| pixel.0 == [0.1, 0.2, 0.3, 1.0]));
}

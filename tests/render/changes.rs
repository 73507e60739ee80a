//! Scenes that change between frames: each frame shows the current scene.

use crate::render::compare::{assert_identical, difference};
use crate::render::conformance::environment::around;
use crate::render::scene::{Around, Lamp, Map, Scene, Thing, material, other_material, point_light};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use bevy_ecs::entity_disabling::Disabled;
use halfway::lighting::{Edges, Frequency};
use halfway::prelude::*;
use halfway::texture::environment::{EnvironmentLight, EnvironmentMap};
use halfway::texture::{TexelFilter, TexelImage};

fn one(mesh: impl Into<Mesh>) -> Scene {
    Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO)
        .with(Thing::new(mesh).with_material(material()))
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 2.0, 3.0)))
}

#[test]
fn a_mesh_that_is_replaced_shows_at_once() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        // New Apps: the order of systems that have none is drawn anew.
        let mut stage = Stage::new(24, 24);
        let (sphere, cuboid) = (Mesh::from(UvSphere::new(1.0, 12, 6)), Mesh::from(Cuboid::new(1.9, 1.0, 1.0)));
        let mut of_cuboid = one(cuboid.clone());
        of_cuboid.view_shading = Some(shading);
        let expected = Stage::new(24, 24).draw(&of_cuboid);
        let mut scene = one(sphere.clone());
        scene.view_shading = Some(shading);
        let before = stage.draw(&scene);
        assert!(difference(&before, &expected) > 0.1);
        let handle = stage.handle(&sphere);
        stage.world().resource_mut::<Assets<Mesh>>().insert(handle.id(), cuboid.clone()).expect("the handle is alive");
        assert_identical(&format!("inserted, {shading:?}"), &expected, &stage.float());
        *stage.world().resource_mut::<Assets<Mesh>>().get_mut(&handle).expect("it is there") = sphere.clone();
        assert_identical(&format!("written, {shading:?}"), &before, &stage.float());
        stage.float();
        assert_eq!(stage.report().bytes_uploaded, 0, "{shading:?}: uploaded again");
    }
}

/// A sheet of 8192 triangles, which is cut into patches, at a time.
fn sheet(time: f32) -> (Vec<Vec3>, Vec<Vec3>) {
    let flat = Mesh::from(Plane { size: 3.0, divisions: 64 });
    let wave = |p: &Vec3| {
        let slope = 0.6 * (2.0 * p.x + time).cos();
        (p.with_y(0.3 * (2.0 * p.x + time).sin()), Vec3::new(-slope, 1.0, 0.0))
    };
    flat.positions().iter().map(wave).unzip()
}

#[test]
fn a_mesh_that_moves_is_drawn_as_one_that_is_made_anew() {
    let flat = Mesh::from(Plane { size: 3.0, divisions: 64 });
    let colors: Vec<_> =
        flat.positions().iter().map(|p| Vec4::new(p.x.abs() / 1.5, 0.5, p.z.abs() / 1.5, 1.0)).collect();
    let view = |thing: Thing, lights: u8| {
        let mut scene = Scene::seen_from(Vec3::new(0.0, 2.5, 3.5), Vec3::ZERO).ambient(0.1).with(thing);
        for i in 0..lights {
            scene =
                scene.lit(Lamp::point(point_light(), Vec3::new(f32::from(i % 5) - 2.0, 1.0, f32::from(i / 5) - 2.0)));
        }
        scene
    };
    let rows: [(&str, fn(Thing) -> Thing, u8, bool); 6] = [
        ("flat", |thing| thing.shaded(Shading::Flat), 2, false),
        ("gouraud", |thing| thing.shaded(Shading::Gouraud), 2, false),
        ("phong", |thing| thing, 2, false),
        ("colored", |thing| thing, 2, true),
        ("lists of lights", |thing| thing.faces(Faces::Both), 20, false),
        ("blended", |thing| thing.blended(0.5), 2, false),
    ];
    for (row, look, lights, colored) in rows {
        let (mut stage, mut fresh) = (Stage::new(48, 32), Stage::new(48, 32));
        let paint = |mesh: Mesh| {
            let colors = colored.then(|| colors.clone());
            colors.map_or(Ok(mesh.clone()), |colors| mesh.with_colors(colors)).expect("a color a vertex")
        };
        let first = paint(flat.clone());
        stage.draw_bytes(&view(look(Thing::new(first.clone()).with_material(material())), lights));
        let handle = stage.handle(&first);
        for frame in 1..=4_u8 {
            let (positions, normals) = sheet(0.7 * f32::from(frame));
            let mut meshes = stage.world().resource_mut::<Assets<Mesh>>();
            let mesh = meshes.get_mut(&handle).expect("it is there");
            mesh.set_positions(positions.clone()).expect("as many");
            mesh.set_normals(normals.clone()).expect("as many");
            let moved = stage.bytes();
            let indices = flat.indices().to_vec();
            let anew = paint(Mesh::from_parts(positions, Some(normals), None, indices).expect("a sound mesh"));
            let expected = fresh.draw_bytes(&view(look(Thing::new(anew).with_material(material())), lights));
            assert!(expected == moved, "{row}, frame {frame}: another picture");
        }
        stage.bytes();
        assert_eq!(stage.report().bytes_uploaded, 0, "{row}: uploaded again");
    }
}

#[test]
fn a_mesh_that_is_removed_is_missed_until_it_is_back() {
    let mut stage = Stage::new(24, 24);
    let sphere = Mesh::from(UvSphere::new(1.0, 12, 6));
    let before = stage.draw(&one(sphere.clone()));
    let handle = stage.handle(&sphere);
    stage.world().resource_mut::<Assets<Mesh>>().remove(&handle);
    for _ in 0..2 {
        let report = stage.frame();
        assert_eq!((report.errors.len(), report.draws, report.visible), (1, 0, 0));
        assert!(report.errors[0].to_string().contains("mesh"), "{}", report.errors[0]);
    }
    stage.world().resource_mut::<Assets<Mesh>>().insert(handle.id(), sphere).expect("the handle is alive");
    assert_identical("back again", &before, &stage.float());
}

#[test]
fn a_despawned_object_is_gone_in_the_next_frame() {
    let mut stage = Stage::new(24, 24);
    let scene = one(UvSphere::new(1.0, 12, 6))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(1.2, 0.0, 0.0)).shaded(Shading::Flat));
    let things = stage.set(&scene);
    let both = stage.float();
    assert_eq!(stage.report().draws, 2);
    stage.world().entity_mut(things[1]).remove::<Mesh3d>();
    let alone = stage.float();
    assert_eq!((stage.report().draws, stage.report().objects), (1, 1));
    assert!(difference(&both, &alone) > 0.1);
    assert_identical(
        "as if it had never been there",
        &alone,
        &Stage::new(24, 24).draw(&one(UvSphere::new(1.0, 12, 6))),
    );
    let nothing = stage.draw(&Scene { things: vec![], ..scene });
    assert_eq!((stage.report().draws, stage.report().objects, stage.report().bytes_uploaded), (0, 0, 0));
    assert!(nothing.pixels().all(|pixel| pixel.0 == [0.0, 0.0, 0.0, 1.0]));
}

const MOVED: Transform = Transform::from_xyz(0.3, 0.2, 0.1);

fn insert(entity: &mut EntityWorldMut, bundle: impl Bundle) {
    entity.insert(bundle);
}

#[test]
fn changed_components_show_at_once() {
    let changes: [(&str, fn(&mut EntityWorldMut, Handle<Mesh>), fn(&mut Thing)); 8] = [
        ("material", |e, _| insert(e, other_material()), |t| t.material = other_material()),
        ("shading", |e, _| insert(e, Shading::Flat), |t| t.shading = Some(Shading::Flat)),
        ("reflectance", |e, _| insert(e, Reflectance::Phong), |t| t.reflectance = Some(Reflectance::Phong)),
        ("faces", |e, _| insert(e, Faces::Back), |t| t.faces = Some(Faces::Back)),
        (
            "back material",
            |e, _| insert(e, (Faces::Both, BackMaterial(other_material()))),
            |t| (t.faces, t.back) = (Some(Faces::Both), Some(other_material())),
        ),
        ("place", |e, _| insert(e, MOVED), |t| t.frames = vec![MOVED]),
        ("mesh", |e, mesh| insert(e, Mesh3d(mesh)), |t| t.mesh = Cuboid::default().into()),
        (
            "terms",
            |e, _| insert(e, Shading::Terms(Terms { diffuse: Frequency::Vertex, specular: Frequency::Never })),
            |t| *t = t.clone().terms(Frequency::Vertex, Frequency::Never),
        ),
    ];
    let mut stage = Stage::new(24, 24);
    for (row, change, told) in changes {
        let mut scene = one(hemisphere(10, 6));
        scene.things[0].frames[0].rotation = Quat::from_rotation_x(-0.7);
        let things = stage.set(&scene);
        let before = stage.float();
        let cuboid = stage.handle(&Cuboid::default().into());
        change(&mut stage.world().entity_mut(things[0]), cuboid);
        let after = stage.float();
        told(&mut scene.things[0]);
        let expected = stage.draw(&scene);
        assert_identical(row, &after, &expected);
        assert!(difference(&before, &after) > 1e-3, "{row} changes nothing");
    }
}

/// A sheet, a square with an image, one with vertex colours and one seen from behind, under more lights than are
/// compiled in.
fn every_kind() -> Scene {
    let mut scene = Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO).ambient(0.1);
    let mut sheet = Thing::new(Plane { size: 1.8, divisions: 24 }).with_material(material()).shaded(Shading::Phong);
    sheet.frames[0] = Transform::from_xyz(-0.8, 0.2, 0.0).with_rotation(Quat::from_rotation_x(1.1));
    let behind =
        Thing::square(Vec3::new(-0.8, -1.1, 0.0), Vec3::NEG_Z, 0.6).with_material(material()).faces(Faces::Both);
    let mut imaged = Thing::square(Vec3::new(0.8, 0.7, 0.0), Vec3::Z, 1.0).with_material(material());
    imaged.maps.push((MapKind::Color, Map::new(image(0.2))));
    let mut colored = Thing::square(Vec3::new(0.8, -0.7, 0.0), Vec3::Z, 1.0).with_material(material());
    let colors = vec![Vec4::new(0.3, 0.6, 0.9, 1.0); colored.mesh.positions().len()];
    colored.mesh = colored.mesh.with_colors(colors).expect("a colour a vertex");
    scene.things = vec![sheet, imaged, colored, behind];
    for number in 0..12 {
        let angle = number as f32 * 0.5;
        scene = scene.lit(Lamp::point(point_light(), Vec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 2.5)));
    }
    scene
}

fn image(least: f32) -> TexelImage {
    TexelImage::from_fn(4, 4, |x, y| [least, x as f32 / 4.0, y as f32 / 4.0, 0.7]).expect("a small image")
}

/// Replaces the scene of a stage.
fn set(stage: &mut Stage) -> Vec<Entity> {
    let world = stage.world();
    world.insert_resource(ViewTolerance(Tolerance::steps(4.0)));
    stage.target_size(40, 30);
    stage.set(&every_kind())
}

/// A change of a scene.
struct Change {
    name: &'static str,
    make: fn(&mut Stage, &[Entity]),
    /// Whether it changes the picture.
    shows: bool,
}

fn change(name: &'static str, make: fn(&mut Stage, &[Entity])) -> Change {
    Change { name, make, shows: true }
}

/// Changes the frame by less than can be told.
fn hidden_change(name: &'static str, make: fn(&mut Stage, &[Entity])) -> Change {
    Change { name, make, shows: false }
}

fn insert_on(stage: &mut Stage, entity: Entity, bundle: impl Bundle) {
    stage.world().entity_mut(entity).insert(bundle);
}

/// The first entity with such a component.
fn first<C: Component>(stage: &mut Stage) -> Entity {
    let world = stage.world();
    world.query_filtered::<Entity, With<C>>().iter(world).min().expect("there is one")
}

/// The light farthest to the right.
fn light(stage: &mut Stage) -> Entity {
    let world = stage.world();
    let mut lights = world.query_filtered::<(Entity, &Transform), With<PointLight>>();
    let right = lights.iter(world).max_by(|(_, a), (_, b)| a.translation.x.total_cmp(&b.translation.x));
    right.expect("there is one").0
}

fn changed<C: Component<Mutability = bevy_ecs::component::Mutable>>(stage: &mut Stage, change: impl FnOnce(&mut C)) {
    let entity = first::<C>(stage);
    change(&mut stage.world().get_mut::<C>(entity).expect("it is there"));
}

fn changes_of_objects() -> Vec<Change> {
    vec![
        change("a material", |stage, things| insert_on(stage, things[0], other_material())),
        change("a back material", |stage, things| insert_on(stage, things[3], BackMaterial(other_material()))),
        change("faces", |stage, things| insert_on(stage, things[0], Faces::Back)),
        change("a reflectance", |stage, things| insert_on(stage, things[0], Reflectance::Phong)),
        change("a shading", |stage, things| insert_on(stage, things[0], Shading::Flat)),
        change("terms", |stage, things| {
            let terms = Terms { diffuse: Frequency::Vertex, specular: Frequency::Never };
            insert_on(stage, things[0], Shading::Terms(terms));
        }),
        hidden_change("a tolerance", |stage, things| insert_on(stage, things[0], Tolerance::steps(30.0))),
        hidden_change("blending", |stage, things| insert_on(stage, things[0], AlphaMode::Blend)),
        change("a mask", |stage, things| insert_on(stage, things[1], AlphaMode::Mask(0.9))),
        change("images that go", |stage, things| {
            stage.world().entity_mut(things[1]).remove::<Maps>();
        }),
        change("how an image is looked up", |stage, things| {
            let mut maps = stage.world().get::<Maps>(things[1]).expect("it has images").clone();
            let mut map = maps.get(MapKind::Color).expect("it has one").clone();
            map.sampling.magnify = TexelFilter::Nearest;
            maps.set(MapKind::Color, Some(map));
            insert_on(stage, things[1], maps);
        }),
        change("where an image lies", |stage, things| {
            let mut maps = stage.world().get::<Maps>(things[1]).expect("it has images").clone();
            let mut map = maps.get(MapKind::Color).expect("it has one").clone();
            map.transform.offset = [0.3, 0.1];
            maps.set(MapKind::Color, Some(map));
            insert_on(stage, things[1], maps);
        }),
        change("an image", |stage, things| {
            let maps = stage.world().get::<Maps>(things[1]).expect("it has images");
            let id = maps.get(MapKind::Color).expect("it has one").texture.id();
            let mut textures = stage.world().resource_mut::<Assets<Texture>>();
            textures.insert(id, Texture::from(image(0.9))).expect("the handle is alive");
        }),
        change("colours that are ignored", |stage, things| insert_on(stage, things[2], VertexColors::Ignore)),
        change("a solid", |stage, things| insert_on(stage, things[2], SolidTexture::default())),
        change("another mesh", |stage, things| {
            let mesh = stage.handle(&Cuboid::default().into());
            insert_on(stage, things[0], Mesh3d(mesh));
        }),
        change("a transform", |stage, things| insert_on(stage, things[0], Transform::from_xyz(0.3, 0.2, 0.1))),
        change("an object that is hidden", |stage, things| insert_on(stage, things[0], Visibility::Hidden)),
        change("an object that goes", |stage, things| {
            stage.world().entity_mut(things[0]).despawn();
        }),
        change("an object that comes", |stage, _| {
            let mesh = stage.handle(&Cuboid::default().into());
            stage.spawn((Mesh3d(mesh), Transform::from_xyz(0.0, 0.0, 0.5)));
        }),
    ]
}

fn changes_around() -> Vec<Change> {
    vec![
        change("the near plane", |stage, _| {
            changed::<Camera>(stage, |camera| camera.projection = camera.projection.with_near(3.9));
        }),
        change("the camera's angle", |stage, _| {
            changed::<Camera>(stage, |camera| camera.projection = Projection::perspective(0.94).with_near(3.9));
        }),
        change("the view's shading", |stage, _| {
            let camera = first::<Camera>(stage);
            insert_on(stage, camera, Shading::Flat);
        }),
        change("the view's reflectance", |stage, _| {
            let camera = first::<Camera>(stage);
            insert_on(stage, camera, Reflectance::Phong);
        }),
        change("the viewer", |stage, _| changed::<Camera>(stage, |camera| camera.viewer = Viewer::Infinite)),
        change("where the camera stands", |stage, _| {
            let camera = first::<Camera>(stage);
            stage.world().get_mut::<Transform>(camera).expect("it has one").translation.x += 0.2;
        }),
        change("a light", |stage, _| {
            let light = light(stage);
            stage.world().get_mut::<PointLight>(light).expect("it is one").diffuse = LinearRgba::rgb(1.0, 0.2, 0.1);
        }),
        change("where a light stands", |stage, _| {
            let light = light(stage);
            stage.world().get_mut::<Transform>(light).expect("it has one").translation.z += 1.0;
        }),
        change("a light that is hidden", |stage, _| {
            let light = light(stage);
            insert_on(stage, light, Visibility::Hidden);
        }),
        change("a light that goes", |stage, _| {
            let light = light(stage);
            stage.world().entity_mut(light).despawn();
        }),
        change("a light that comes", |stage, _| {
            stage.spawn((point_light(), Transform::from_xyz(0.0, 0.0, 2.0)));
        }),
        change("the ambient light", |stage, _| {
            stage.world().insert_resource(GlobalAmbient(LinearRgba::rgb(0.3, 0.2, 0.1)));
        }),
        hidden_change("the view's tolerance", |stage, _| {
            stage.world().insert_resource(ViewTolerance(Tolerance::steps(30.0)));
        }),
        hidden_change("the picture's size", |stage, _| stage.target_size(33, 35)),
    ]
}

#[test]
fn every_change_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    for Change { name, make, shows } in changes_of_objects().into_iter().chain(changes_around()) {
        let things = set(&mut stage);
        let before = [(); 4].map(|()| stage.float());
        assert_identical(name, &before[2], &before[3]);
        make(&mut stage, &things);
        let after = stage.float();
        assert!(!shows || difference(&before[3], &after) > 1e-3, "{name}: changes nothing");
        // Everything is rebuilt after another scene.
        let mesh = stage.handle(&Cuboid::default().into());
        let other = stage.spawn((Mesh3d(mesh), Transform::default()));
        stage.float();
        stage.world().entity_mut(other).despawn();
        let anew = stage.float();
        assert_identical(name, &after, &anew);
    }
    // Generic ones shade a few terms that may be left out.
    assert!(stage.report().pipelines_live <= 128, "more pipelines than are kept");
}

#[test]
fn an_environment_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    // Not every adapter draws images in an environment.
    stage.world().entity_mut(things[1]).remove::<Maps>();
    let before = [(); 4].map(|()| stage.float());
    let Around { map, strength, rotation, sky } = around(0.5);
    let map = stage.world().resource_mut::<Assets<EnvironmentMap>>().add(map);
    stage.spawn(EnvironmentLight { map, strength, rotation, sky });
    let after = stage.float();
    assert!(difference(&before[3], &after) > 1e-2);
}

#[test]
fn a_sky_shows_where_nothing_was() {
    let mut scene = one(Cuboid::new(0.2, 0.2, 0.2));
    scene.environment = Some(Around { sky: true, ..around(0.5) });
    // Large enough that some tiles hold nothing.
    let expected = Stage::new(96, 96).draw(&scene);
    let mut stage = Stage::new(96, 96);
    scene.environment = Some(around(0.5));
    let before = stage.draw(&scene);
    assert!(difference(&before, &expected) > 1e-2);
    let world = stage.world();
    world.query::<&mut EnvironmentLight>().single_mut(world).expect("there is one").sky = true;
    assert_identical("a sky", &expected, &stage.float());
}

#[test]
fn a_mesh_that_is_written_anew_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    let before = [(); 4].map(|()| stage.float());
    let handle = stage.world().get::<Mesh3d>(things[0]).expect("it has a mesh").0.clone();
    let mut meshes = stage.world().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&handle).expect("it is there") = hemisphere(7, 5);
    let after = stage.float();
    assert!(difference(&before[3], &after) > 1e-2);
}

#[test]
fn a_hidden_light_that_is_shown_again_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    let light = light(&mut stage);
    for hidden in [things[3], light] {
        insert_on(&mut stage, hidden, Visibility::Hidden);
    }
    let before = [(); 4].map(|()| stage.float());
    insert_on(&mut stage, light, Visibility::Inherited);
    let after = stage.float();
    assert!(difference(&before[3], &after) > 1e-3, "a light that shows again");
}

#[test]
fn a_light_that_is_disabled_as_another_is_enabled_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    set(&mut stage);
    let other = stage.spawn((point_light(), Transform::from_xyz(0.0, 0.0, 2.0), Disabled));
    let before = [(); 4].map(|()| stage.float());
    let light = light(&mut stage);
    stage.world().entity_mut(light).insert(Disabled);
    stage.world().entity_mut(other).remove::<Disabled>();
    let after = stage.float();
    assert!(difference(&before[3], &after) > 1e-3);
}

#[test]
fn an_invalid_entity_is_an_error_in_each_still_frame() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    insert_on(&mut stage, things[0], Material { shininess: -1.0, ..material() });
    for _ in 0..4 {
        let report = stage.frame();
        assert_eq!(report.errors.len(), 1);
    }
}

/// A change of the world, given its objects and the camera.
type Step = fn(&mut World, &[Entity], Entity);

fn edit<C: Component<Mutability = bevy_ecs::component::Mutable>>(
    world: &mut World,
    of: Entity,
    to: impl FnOnce(&mut C),
) {
    to(&mut world.get_mut::<C>(of).expect("it has one"));
}

fn remove<C: Component>(world: &mut World, from: Entity) {
    world.entity_mut(from).remove::<C>();
}

/// Changes that follow one another. Much of a frame is kept for the next one, and each of these makes something of it
/// stale.
const STEPS: [(&str, Step); 33] = [
    ("nothing", |_, _, _| ()),
    ("a material", |world, of, _| edit::<Material>(world, of[0], |m| m.diffuse.red = 0.9)),
    ("nothing again", |_, _, _| ()),
    ("an object moves", |world, of, _| edit::<Transform>(world, of[1], |t| t.translation.y += 0.3)),
    ("a back of its own", |world, of, _| insert(&mut world.entity_mut(of[2]), BackMaterial(other_material()))),
    ("both sides", |world, of, _| insert(&mut world.entity_mut(of[2]), Faces::Both)),
    ("the back goes", |world, of, _| remove::<BackMaterial>(world, of[2])),
    ("flat", |world, of, _| insert(&mut world.entity_mut(of[3]), Shading::Flat)),
    ("no longer flat", |world, of, _| remove::<Shading>(world, of[3])),
    ("mirrored", |world, of, _| edit::<Transform>(world, of[4], |t| t.scale.x = -1.0)),
    ("the camera shades", |world, _, camera| insert(&mut world.entity_mut(camera), Shading::Gouraud)),
    ("the camera reflects", |world, _, camera| insert(&mut world.entity_mut(camera), Reflectance::Phong)),
    ("the camera moves", |world, _, camera| edit::<Transform>(world, camera, |t| t.translation.x += 0.2)),
    ("the camera zooms", |world, _, camera| {
        edit::<Camera>(world, camera, |c| c.projection = Camera::perspective(0.5).projection);
    }),
    ("hidden", |world, of, _| insert(&mut world.entity_mut(of[5]), Visibility::Hidden)),
    ("another moves meanwhile", |world, of, _| edit::<Transform>(world, of[6], |t| t.translation.z += 0.5)),
    ("shown", |world, of, _| remove::<Visibility>(world, of[5])),
    ("disabled", |world, of, _| insert(&mut world.entity_mut(of[7]), Disabled)),
    ("it changes meanwhile", |world, of, _| edit::<Material>(world, of[7], |m| m.diffuse = LinearRgba::GREEN)),
    ("enabled", |world, of, _| remove::<Disabled>(world, of[7])),
    ("despawned", |world, of, _| world.entity_mut(of[8]).despawn()),
    ("one more", |world, _, _| {
        let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::new(0.5, 0.7, 0.9));
        world.spawn((Mesh3d(mesh), other_material(), Transform::from_xyz(0.2, -0.8, 0.4)));
    }),
    ("ambient light", |world, _, _| world.resource_mut::<GlobalAmbient>().0 = LinearRgba::rgb(0.3, 0.2, 0.1)),
    ("a light", |world, _, _| {
        world.spawn((point_light(), Transform::from_xyz(-2.0, 1.0, 2.0)));
    }),
    ("an environment", |world, _, _| {
        let map = world.resource_mut::<Assets<EnvironmentMap>>().add(around(0.5).map);
        world.spawn(EnvironmentLight { map, strength: 0.5, rotation: 0.0, sky: false });
    }),
    ("colors that do not count", |world, of, _| insert(&mut world.entity_mut(of[9]), VertexColors::Ignore)),
    ("another mesh", |world, of, _| {
        let mesh = world.resource_mut::<Assets<Mesh>>().add(UvSphere::new(0.3, 7, 5));
        insert(&mut world.entity_mut(of[10]), Mesh3d(mesh));
    }),
    ("blended", |world, of, _| {
        edit::<Material>(world, of[11], |m| m.opacity = 0.5);
        insert(&mut world.entity_mut(of[11]), AlphaMode::Blend);
    }),
    ("blended no more", |world, of, _| remove::<AlphaMode>(world, of[11])),
    ("where another is", |world, of, _| {
        let at = *world.get::<Transform>(of[0]).expect("it has one");
        insert(&mut world.entity_mut(of[1]), at);
    }),
    ("edges alone", |world, of, _| {
        insert(&mut world.entity_mut(of[2]), Edges { surface: false, ..Edges::default() });
    }),
    ("with its surface", |world, of, _| edit::<Edges>(world, of[2], |edges| edges.surface = true)),
    ("a mesh changes", |world, of, _| {
        let handle = world.get::<Mesh3d>(of[0]).expect("it has one").0.clone();
        *world.resource_mut::<Assets<Mesh>>().get_mut(&handle).expect("it is there") = Cuboid::default().into();
    }),
];

#[test]
fn a_frame_after_any_change_is_as_if_it_were_the_first() {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 1.5, 5.0), Vec3::ZERO)
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 2.0, 3.0)));
    for i in 0..12_u8 {
        let at = Vec3::new(f32::from(i % 4) - 1.5, 0.0, f32::from(i / 4) - 1.0);
        let mesh = if i % 2 == 0 { Mesh::from(UvSphere::new(0.4, 9, 6)) } else { Cuboid::new(0.6, 0.5, 0.4).into() };
        let look = [material(), other_material()][usize::from(i % 3 == 0)];
        scene = scene.with(Thing::new(mesh).with_material(look).at(Transform::from_translation(at)));
    }
    let camera = |world: &mut World| world.query_filtered::<Entity, With<Camera>>().single(world).expect("one camera");
    let counts = |report: &FrameReport| {
        let FrameReport { objects, visible, lights, triangles_in, draws, triangles, materials, .. } = *report;
        (objects, visible, lights, triangles_in, draws, triangles, materials, report.passes.clone())
    };
    let mut stage = Stage::new(40, 30);
    let things = stage.set(&scene);
    for (last, (row, step)) in STEPS.iter().enumerate() {
        let of = camera(stage.world());
        step(stage.world(), &things, of);
        let picture = stage.float();
        let report = counts(stage.report());
        let mut fresh = Stage::new(40, 30);
        let things = fresh.set(&scene);
        let of = camera(fresh.world());
        STEPS[..=last].iter().for_each(|(_, step)| step(fresh.world(), &things, of));
        assert_identical(row, &fresh.float(), &picture);
        assert_eq!(counts(fresh.report()), report, "{row}");
    }
}

//! Where nothing changes, the draws of the frame before are drawn again; and whatever changes, they are made anew.

use crate::render::compare::{assert_identical, difference};
use crate::render::conformance::environment::around;
use crate::render::scene::{Around, Lamp, Map, Scene, Thing, material, other_material, point_light};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use bevy_ecs::entity_disabling::Disabled;
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::render::{Choosing, FalseColors, VertexPrices};
use halfway::texture::environment::{EnvironmentLight, EnvironmentMap};
use halfway::texture::{TexelFilter, TexelImage};

/// A sheet that is shaded wherever the tolerance lets it, a square with an image, one with colours of its own and one
/// that is seen from behind, under more lights than are compiled in.
fn scene() -> Scene {
    let mut scene = Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO).ambient(0.1);
    let mut sheet = Thing::new(Plane { size: 1.8, divisions: 24 }).of(material()).shaded(Shading::Auto);
    sheet.frames[0] = Transform::from_xyz(-0.8, 0.2, 0.0).with_rotation(Quat::from_rotation_x(1.1));
    let behind = Thing::square(Vec3::new(-0.8, -1.1, 0.0), Vec3::NEG_Z, 0.6).of(material()).faces(Faces::Both);
    let mut imaged = Thing::square(Vec3::new(0.8, 0.7, 0.0), Vec3::Z, 1.0).of(material());
    imaged.maps.push((MapKind::Color, Map::new(image(0.2))));
    let mut colored = Thing::square(Vec3::new(0.8, -0.7, 0.0), Vec3::Z, 1.0).of(material());
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

/// Puts the scene on a stage, whatever was there before.
fn set(stage: &mut Stage) -> Vec<Entity> {
    let world = stage.world();
    world.insert_resource(VertexPrices::FREE);
    world.insert_resource(ViewTolerance(Tolerance::steps(4.0)));
    world.insert_resource(FalseColors(false));
    world.remove_resource::<Choosing>();
    stage.target_size(40, 30);
    stage.set(&scene())
}

/// What happens to a scene.
struct Change {
    name: &'static str,
    make: fn(&mut Stage, &[Entity]),
    /// It shows.
    shows: bool,
}

fn change(name: &'static str, make: fn(&mut Stage, &[Entity])) -> Change {
    Change { name, make, shows: true }
}

/// Changes what is chosen within the tolerance, or only how.
fn hidden_change(name: &'static str, make: fn(&mut Stage, &[Entity])) -> Change {
    Change { name, make, shows: false }
}

fn insert(stage: &mut Stage, entity: Entity, bundle: impl Bundle) {
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
        change("a material", |stage, things| insert(stage, things[0], other_material())),
        change("a back material", |stage, things| insert(stage, things[3], BackMaterial(other_material()))),
        change("faces", |stage, things| insert(stage, things[0], Faces::Back)),
        change("a reflectance", |stage, things| insert(stage, things[0], Reflectance::Phong)),
        change("a shading", |stage, things| insert(stage, things[0], Shading::Flat)),
        change("terms", |stage, things| {
            insert(stage, things[0], Terms { diffuse: Frequency::Vertex, specular: Frequency::Never });
        }),
        hidden_change("a tolerance", |stage, things| insert(stage, things[0], Tolerance::steps(30.0))),
        hidden_change("blending", |stage, things| insert(stage, things[0], Blend)),
        change("a mask", |stage, things| insert(stage, things[1], Mask(0.9))),
        change("images that go", |stage, things| {
            stage.world().entity_mut(things[1]).remove::<Maps>();
        }),
        change("how an image is looked up", |stage, things| {
            let mut maps = stage.world().get::<Maps>(things[1]).expect("it has images").clone();
            let mut map = maps.get(MapKind::Color).expect("it has one").clone();
            map.sampling.magnify = TexelFilter::Nearest;
            maps.set(MapKind::Color, Some(map));
            insert(stage, things[1], maps);
        }),
        change("where an image lies", |stage, things| {
            let mut maps = stage.world().get::<Maps>(things[1]).expect("it has images").clone();
            let mut map = maps.get(MapKind::Color).expect("it has one").clone();
            map.transform.offset = [0.3, 0.1];
            maps.set(MapKind::Color, Some(map));
            insert(stage, things[1], maps);
        }),
        change("an image", |stage, things| {
            let maps = stage.world().get::<Maps>(things[1]).expect("it has images");
            let id = maps.get(MapKind::Color).expect("it has one").texture.id();
            let mut textures = stage.world().resource_mut::<Assets<Texture>>();
            textures.insert(id, Texture::from(image(0.9))).expect("the handle is alive");
        }),
        change("colours that are ignored", |stage, things| insert(stage, things[2], VertexColors::Ignore)),
        change("a solid", |stage, things| insert(stage, things[2], SolidTexture::default())),
        change("another mesh", |stage, things| {
            let mesh = stage.handle(&Cuboid::default().into());
            insert(stage, things[0], Mesh3d(mesh));
        }),
        change("a transform", |stage, things| insert(stage, things[0], Transform::from_xyz(0.3, 0.2, 0.1))),
        change("an object that is hidden", |stage, things| insert(stage, things[0], Visibility::Hidden)),
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
        change("the near plane", |stage, _| changed::<Camera>(stage, |camera| camera.near = 3.9)),
        change("the camera's angle", |stage, _| changed::<Camera>(stage, |camera| camera.fov_y *= 1.2)),
        change("the view's shading", |stage, _| {
            let camera = first::<Camera>(stage);
            insert(stage, camera, Shading::Flat);
        }),
        change("the view's reflectance", |stage, _| {
            let camera = first::<Camera>(stage);
            insert(stage, camera, Reflectance::Phong);
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
            insert(stage, light, Visibility::Hidden);
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
        change("false colours", |stage, _| stage.world().insert_resource(FalseColors(true))),
        hidden_change("the view's tolerance", |stage, _| {
            stage.world().insert_resource(ViewTolerance(Tolerance::steps(30.0)));
        }),
        hidden_change("prices", |stage, _| stage.world().insert_resource(VertexPrices::NEVER)),
        hidden_change("the way of choosing", |stage, _| stage.world().insert_resource(Choosing::Steadily)),
        hidden_change("the picture's size", |stage, _| stage.target_size(33, 35)),
    ]
}

#[test]
fn what_stands_still_is_chosen_once() {
    let mut stage = Stage::new(1, 1);
    set(&mut stage);
    let pictures: Vec<_> = (0..4).map(|_| (stage.float(), stage.report().clone())).collect();
    // In the first frame all has moved, and only from then on is anything compared.
    assert_eq!([0, 1, 2, 3].map(|i: usize| pictures[i].1.kept), [false, false, true, true]);
    let (made, kept) = (&pictures[1].1, &pictures[3].1);
    assert_eq!(*kept, FrameReport { kept: true, ..made.clone() }, "what is kept is told as it was");
    assert!(kept.terms_at_vertices > 0 && kept.draws > 0, "{kept:?}");
    for (picture, _) in &pictures[1..] {
        assert_identical("kept", &pictures[0].0, picture);
    }
}

#[test]
fn whatever_changes_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    for Change { name, make, shows } in changes_of_objects().into_iter().chain(changes_around()) {
        let things = set(&mut stage);
        let before = [(); 4].map(|()| stage.float());
        assert!(stage.report().kept, "{name}: nothing has changed yet");
        make(&mut stage, &things);
        let after = stage.float();
        assert!(!stage.report().kept, "{name}: kept");
        assert!(!shows || difference(&before[3], &after) > 1e-3, "{name}: changes nothing");
        // All is made anew once something else was there.
        let mesh = stage.handle(&Cuboid::default().into());
        let other = stage.spawn((Mesh3d(mesh), Transform::default()));
        stage.float();
        stage.world().entity_mut(other).despawn();
        let anew = stage.float();
        assert!(!stage.report().kept, "{name}: kept after another object was there");
        assert_identical(name, &after, &anew);
    }
    // Generic ones shade a little more of what may be left out.
    assert!(stage.report().pipelines_live <= 128, "more pipelines than are kept");
}

#[test]
fn an_environment_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    // Not every adapter draws images in an environment.
    stage.world().entity_mut(things[1]).remove::<Maps>();
    let before = [(); 4].map(|()| stage.float());
    assert!(stage.report().kept);
    let Around { map, strength, rotation, sky } = around(0.5);
    let map = stage.world().resource_mut::<Assets<EnvironmentMap>>().add(map);
    stage.spawn(EnvironmentLight { map, strength, rotation, sky });
    let after = stage.float();
    assert!(!stage.report().kept && difference(&before[3], &after) > 1e-2);
}

#[test]
fn a_mesh_that_is_written_anew_is_not_kept() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    let before = [(); 4].map(|()| stage.float());
    assert!(stage.report().kept);
    let handle = stage.world().get::<Mesh3d>(things[0]).expect("it has a mesh").0.clone();
    let mut meshes = stage.world().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&handle).expect("it is there") = hemisphere(7, 5);
    let after = stage.float();
    assert!(!stage.report().kept && difference(&before[3], &after) > 1e-2);
}

#[test]
fn what_is_hidden_is_not_compared_in_vain() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    let light = light(&mut stage);
    for hidden in [things[3], light] {
        insert(&mut stage, hidden, Visibility::Hidden);
    }
    let before = [(); 4].map(|()| stage.float());
    assert!(stage.report().kept, "a hidden object and a hidden light");
    insert(&mut stage, light, Visibility::Inherited);
    let after = stage.float();
    assert!(!stage.report().kept && difference(&before[3], &after) > 1e-3, "a light that shows again");
}

#[test]
fn a_light_that_is_disabled_as_another_is_enabled_shows_at_once() {
    let mut stage = Stage::new(1, 1);
    set(&mut stage);
    let other = stage.spawn((point_light(), Transform::from_xyz(0.0, 0.0, 2.0), Disabled));
    let before = [(); 4].map(|()| stage.float());
    assert!(stage.report().kept);
    let light = light(&mut stage);
    stage.world().entity_mut(light).insert(Disabled);
    stage.world().entity_mut(other).remove::<Disabled>();
    let after = stage.float();
    assert!(!stage.report().kept && difference(&before[3], &after) > 1e-3);
}

#[test]
fn what_is_refused_is_told_in_each_frame() {
    let mut stage = Stage::new(1, 1);
    let things = set(&mut stage);
    insert(&mut stage, things[0], Material { shininess: -1.0, ..material() });
    for _ in 0..4 {
        let report = stage.frame();
        assert_eq!((report.errors.len(), report.kept), (1, false));
    }
}

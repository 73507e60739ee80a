//! Scenes that change between frames: each frame shows what is there now.

use crate::render::compare::{assert_identical, difference};
use crate::render::scene::{Lamp, Scene, Thing, material, other_material, point_light};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;

fn one(mesh: impl Into<Mesh>) -> Scene {
    Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO)
        .with(Thing::new(mesh).of(material()))
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
fn what_is_despawned_is_gone_from_the_next_frame() {
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
            |e, _| insert(e, Terms { diffuse: Frequency::Vertex, specular: Frequency::Never }),
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

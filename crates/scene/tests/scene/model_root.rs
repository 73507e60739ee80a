//! Model files as one entity.

use std::path::PathBuf;

use crate::spawned::app;
use halfway_asset::Assets;
use halfway_lighting::PointLight;
use halfway_mesh::{Mesh, Mesh3d};
use halfway_scene::{ModelFailed, ModelParts, ModelRoot, spawn_model};

fn asset(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

#[test]
fn a_model_is_one_entity_with_named_children() {
    let mut app = app();
    let root = app.world_mut().spawn(ModelRoot::new(asset("lantern.glb"))).id();
    app.update();
    let world = app.world_mut();
    let parts = world.get::<ModelParts>(root).expect("parts").clone();
    assert!(world.query::<&PointLight>().iter(world).next().is_some(), "the lantern has a light");
    let (name, entity) = parts.iter().next().expect("a part");
    let mesh = parts.mesh(name).expect("its mesh");
    assert!(world.get::<Mesh3d>(entity).is_some_and(|shown| shown.0 == *mesh));
    assert!(world.resource::<Assets<Mesh>>().contains(mesh));
    assert_eq!((parts.entity(name), parts.entity("no such part")), (Some(entity), None));

    world.entity_mut(root).insert(ModelRoot::new(asset("cube.smf")));
    world.flush();
    assert!(world.get_entity(entity).is_err(), "another model replaces the children");
    assert_eq!(world.query::<&Mesh3d>().iter(world).count(), 1);
    world.despawn(root);
    assert_eq!(world.query::<&Mesh3d>().iter(world).count(), 0);
}

#[test]
fn a_missing_model_is_an_error_on_its_entity() {
    let mut app = app();
    let world = app.world_mut();
    let root = world.spawn(ModelRoot::new("no/such.obj")).id();
    world.flush();
    let failed = world.get::<ModelFailed>(root).expect("an error");
    assert!(failed.0.contains("no/such.obj"), "{}", failed.0);
    world.despawn(root);

    let entities = world.query::<&ModelRoot>().iter(world).count();
    let error = spawn_model("no/such.obj", world).unwrap_err();
    assert!(error.to_string().contains("no/such.obj"), "{error}");
    assert_eq!(world.query::<&ModelRoot>().iter(world).count(), entities);
    assert!(spawn_model(asset("cube.smf"), world).is_ok());
}

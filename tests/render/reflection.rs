//! Components and resources can be found, read and changed by their names, as editors and scene files of others do it.

use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent, ReflectResource};
use bevy_reflect::{GetPath, PartialReflect, Reflect};
use halfway::prelude::*;
use std::collections::BTreeSet;
use std::path::Path;

/// The crates with components and resources.
const ROOMS: &[&str] = &[
    "lighting",
    "mesh",
    "render",
    "texture",
    #[cfg(feature = "window")]
    "window",
];

/// Public components and resources that are not reflected, and why.
const NOT_REFLECTED: &[(&str, &str)] = &[
    ("Gpu", "holds the adapter and the device"),
    ("Cpu", "holds threads and their memory"),
    ("Canvas", "has no public field"),
    ("GpuTimer", "holds queries on the device"),
    ("SurfaceTarget", "holds the surface of a window"),
    ("SurfaceLost", "a message to the owner of the window"),
    ("TextureTarget", "holds a view of a texture"),
    ("Lights", "has no public field"),
    ("FrameTimes", "has no public field"),
    #[cfg(feature = "window")]
    ("WinitWindow", "holds the window"),
];

fn app() -> App {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(UVec2::new(8, 8)));
    #[cfg(feature = "window")]
    app.add_plugins(WindowPlugin::default());
    app
}

/// The public types under `folder` that derive `Component` or `Resource`, by their names.
fn declared(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the sources") {
        let path = entry.expect("an entry of it").path();
        if path.is_dir() {
            declared(&path, found);
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a source file");
        let mut is_one = false;
        for line in text.lines() {
            if line.starts_with("#[derive(") {
                is_one = line.contains("Component") || line.contains("Resource");
            } else if let Some(rest) = line.strip_prefix("pub struct ").or(line.strip_prefix("pub enum ")) {
                if is_one {
                    found.insert(rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().into());
                }
                is_one = false;
            } else if !line.starts_with("#[") {
                is_one = false;
            }
        }
    }
}

#[test]
fn every_public_component_and_resource_is_registered() {
    let mut declared_types = BTreeSet::new();
    for room in ROOMS {
        let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates").join(room).join("src");
        declared(&sources, &mut declared_types);
    }
    for &(name, why) in NOT_REFLECTED {
        assert!(declared_types.remove(name), "{name}, which {why}, is not there any more");
    }

    let app = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let registered: BTreeSet<String> = registry
        .iter()
        .filter(|registration| registration.type_info().type_path().starts_with("halfway_"))
        .filter(|registration| {
            registration.data::<ReflectComponent>().is_some() || registration.data::<ReflectResource>().is_some()
        })
        .map(|registration| registration.type_info().type_path_table().short_path().into())
        .collect();
    assert_eq!(registered, declared_types);
    for name in ["PointLight", "Material", "BackMaterial", "Camera", "Shading", "Mesh3d", "Headless", "Visibility"] {
        assert!(registered.contains(name), "{name} is not found, so that this test finds nothing");
    }
}

/// Puts `before` on an entity, changes the field at `path`, both by reflection alone; returns the component.
fn changed<T: Component + Reflect + Clone>(before: &T, path: &str, value: &dyn PartialReflect) -> T {
    let mut app = app();
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let name = before.reflect_type_path();
    let component = registry
        .get_with_type_path(name)
        .and_then(|registration| registration.data::<ReflectComponent>())
        .unwrap_or_else(|| panic!("{name} is not registered as a component"));
    let mut entity = app.world_mut().spawn_empty();
    component.insert(&mut entity, before.as_partial_reflect(), &registry);
    let mut reflected = component.reflect_mut(&mut entity).expect("it was inserted");
    reflected.reflect_path_mut(path).unwrap_or_else(|error| panic!("{name}{path}: {error}")).apply(value);
    entity.get::<T>().expect("it was inserted").clone()
}

#[test]
fn fields_are_changed_through_the_registry() {
    let red = LinearRgba::rgb(1.0, 0.0, 0.0);
    let light = PointLight::white();
    assert_eq!(changed(&light, ".diffuse", &red), PointLight { diffuse: red, ..light });
    assert_eq!(changed(&light, ".range", &Some(2.0f32)).range, Some(2.0));
    assert_eq!(
        changed(&light, ".attenuation.linear", &0.5f32).attenuation,
        Attenuation { linear: 0.5, ..light.attenuation }
    );
    let spot = SpotLight::default();
    assert_eq!(changed(&spot, ".cone.cutoff", &0.25f32).cone, Cone { cutoff: 0.25, ..spot.cone });
    assert_eq!(changed(&DirectionalLight::white(), ".specular", &red).specular, red);
    assert_eq!(changed(&Material::BRASS, ".shininess", &7.0f32), Material { shininess: 7.0, ..Material::BRASS });
    assert_eq!(changed(&BackMaterial::default(), ".0.opacity", &0.5f32).0.opacity, 0.5);
    assert_eq!(changed(&Camera::default(), ".samples", &Samples::Four).samples, Samples::Four);
    assert_eq!(changed(&Camera::default(), ".viewer", &Viewer::Infinite).viewer, Viewer::Infinite);
    assert_eq!(changed(&Shading::Phong, "", &Shading::Flat), Shading::Flat);
    assert_eq!(changed(&Reflectance::Phong, "", &Reflectance::BlinnPhong), Reflectance::BlinnPhong);
    assert_eq!(changed(&Faces::Front, "", &Faces::Both), Faces::Both);
    assert_eq!(changed(&Visibility::Visible, "", &Visibility::Hidden), Visibility::Hidden);
    let terms = Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment };
    let never = Terms { diffuse: Frequency::Never, ..terms };
    assert_eq!(changed(&terms, ".diffuse", &Frequency::Never), never);
    let mut app = app();
    let handle = app.world_mut().resource_mut::<Assets<Mesh>>().add(UvSphere::default());
    assert_eq!(changed(&Mesh3d::default(), ".0", &handle), Mesh3d(handle.clone()));
}

#[test]
fn resources_are_changed_through_the_registry() {
    let mut app = app();
    app.insert_resource(Compile::Now);
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let rows: [(&str, &str, &dyn PartialReflect); 4] = [
        ("GlobalAmbient", ".0.red", &0.75f32),
        ("Headless", ".size.x", &40u32),
        ("ViewTolerance", ".0.pixels", &0.0f32),
        ("Compile", "", &Compile::Beside),
    ];
    for (name, path, value) in rows {
        let registry = registry.read();
        let registration =
            registry.get_with_short_type_path(name).unwrap_or_else(|| panic!("{name} is not registered"));
        assert!(registration.data::<ReflectResource>().is_some(), "{name} is no resource");
        let component = registration.data::<ReflectComponent>().expect("resources are components of an entity");
        let world = app.world_mut();
        let id = world.components().get_id(registration.type_id()).expect("the resource is there");
        let entity = world.resource_entities().get(id).expect("the resource is there");
        let mut reflected = component.reflect_mut(world.entity_mut(entity)).expect("the resource is there");
        reflected.reflect_path_mut(path).unwrap_or_else(|error| panic!("{name}{path}: {error}")).apply(value);
    }
    let world = app.world();
    assert_eq!(world.resource::<GlobalAmbient>().0.red, 0.75);
    assert_eq!(world.resource::<Headless>().size, UVec2::new(40, 8));
    assert_eq!(world.resource::<ViewTolerance>().0.pixels, 0.0);
    assert_eq!(*world.resource::<Compile>(), Compile::Beside);
}

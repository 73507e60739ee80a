//! Unlit objects: the base colour, whatever the lights.

use crate::render::compare::{FLOAT, assert_identical, judge};
use crate::render::conformance::colors::colored;
use crate::render::conformance::environment::around;
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, material, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;

/// A ball and a square of other materials, in light of every kind.
fn lit() -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.3, 0.5, 3.0), Vec3::ZERO)
        .ambient(0.3)
        .with(Thing::new(UvSphere::new(0.9, 12, 6)).with_material(material()))
        .with(Thing::square(Vec3::new(0.0, 0.0, -1.5), Vec3::Z, 1.6).with_material(other_material()))
        .lit(Lamp::directional(directional_light(), Vec3::new(-1.0, -0.7, -0.8)))
        .lit(Lamp::point(PointLight { attenuate_ambient: true, ..point_light() }, Vec3::new(1.0, 1.5, 1.5)));
    scene.environment = Some(around(0.7));
    scene
}

fn unlit(mut scene: Scene) -> Scene {
    scene.view_shading = Some(Shading::Unlit);
    scene
}

/// The same objects, which glow in their diffuse colours and reflect nothing.
fn glowing_as_diffuse(mut scene: Scene) -> Scene {
    for thing in &mut scene.things {
        let LinearRgba { red, green, blue, .. } = thing.material.diffuse;
        thing.material = glowing(red, green, blue);
    }
    scene.environment = None;
    scene
}

#[test]
fn an_unlit_object_shows_its_diffuse_colour() {
    let mut stage = Stage::new(48, 48);
    let (shown, glowing) = (stage.draw(&unlit(lit())), stage.draw(&glowing_as_diffuse(lit())));
    assert_identical("unlit", &shown, &glowing);
    // An object that says so itself, before a lit one.
    let mut one = lit();
    one.things[0].shading = Some(Shading::Unlit);
    let [one, lit] = [one, lit()].map(|scene| stage.draw(&scene));
    assert_eq!(one.get_pixel(24, 24), shown.get_pixel(24, 24));
    assert_eq!(one.get_pixel(2, 24), lit.get_pixel(2, 24));
    assert_ne!(one.get_pixel(24, 24), lit.get_pixel(24, 24));
}

#[test]
fn faults_in_unlit_objects_are_found() {
    let mut stage = Stage::new(48, 48);
    let scene = || {
        let mut scene = unlit(lit());
        scene.things.iter_mut().for_each(|thing| thing.mesh = colored(thing.mesh.clone()));
        scene
    };
    let faults: [(&str, fn(&mut Scene)); 5] = [
        ("lights shine on it", |scene| scene.view_shading = None),
        ("ambient light does", |scene| scene.view_shading = Some(Shading::Terms(Terms::NONE))),
        ("it has not the colours of its vertices", |scene| scene.things = lit().things),
        ("it is as bright as its ambient reflectance", |scene| {
            scene.things.iter_mut().for_each(|thing| thing.material.diffuse = thing.material.ambient);
        }),
        ("a hundredth too bright", |scene| {
            let brighter = |LinearRgba { red, green, blue, .. }| LinearRgba::rgb(1.01 * red, 1.01 * green, 1.01 * blue);
            scene.things.iter_mut().for_each(|thing| thing.material.diffuse = brighter(thing.material.diffuse));
        }),
    ];
    for (fault, plant) in faults {
        let mut wrong = scene();
        plant(&mut wrong);
        let wrong = Image::from_float(&stage.draw(&wrong));
        let right = stage.draw(&scene());
        assert!(judge(&mut stage, &Image::from_float(&right), FLOAT).0.is_within(), "{fault}: the right picture");
        assert!(!judge(&mut stage, &wrong, FLOAT).0.is_within(), "{fault}");
    }
}

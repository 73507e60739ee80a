//! The rows of the conformance suite beside its axes: features that a scene may have, once or several times.

use super::Row;
use crate::render::edges::screen;
use crate::render::scene::{
    Kind, Lamp, On, Scene, Thing, directional_light, glowing, material, other_material, point_light, rotated, scaled,
    shining,
};
use crate::render::sides::hemisphere;
use halfway::lighting::lights::LightKind as _;
use halfway::lighting::{Frequency, Term};
use halfway::prelude::*;

/// A coarse sphere on a floor, whose triangles face all directions.
pub(super) fn still_life() -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.4, 1.4, 3.2), Vec3::new(0.0, -0.1, 0.0))
        .ambient(0.15)
        .with(Thing::new(UvSphere::new(0.8, 12, 6)))
        .with(
            Thing::new(Plane { size: 4.0, divisions: 4 })
                .at(Transform::from_xyz(0.0, -0.8, 0.0))
                .with_material(other_material()),
        );
    scene.camera.background = LinearRgba::rgb(0.1, 0.2, 0.3);
    scene
}

pub(super) fn point(at: Vec3) -> Lamp {
    Lamp::point(point_light(), at)
}

fn spot(at: Vec3) -> Lamp {
    Lamp::spot(SpotLight { light: point_light(), cone: Cone { cutoff: 0.5, inner: Some(0.2), exponent: 2.0 } }, at, -at)
}

fn outside() -> Lamp {
    let light = HemisphereLight::new(LinearRgba::rgb(0.4, 0.5, 0.7), LinearRgba::rgb(0.3, 0.2, 0.1));
    Lamp::hemisphere(light, Vec3::new(0.3, 1.0, 0.5))
}

fn sun(along: Vec3) -> Lamp {
    Lamp::directional(directional_light(), along)
}

/// `count` lights of all kinds around the scene, which share its brightness.
pub(super) fn lights(count: usize) -> Scene {
    let mut scene = still_life();
    let share = 2.0 / count as f32;
    let dim = |colour: LinearRgba| LinearRgba::rgb(colour.red * share, colour.green * share, colour.blue * share);
    for i in 0..count {
        let angle = i as f32 * 2.4;
        let at = Vec3::new(2.0 * angle.cos(), 1.0 + 0.5 * (i % 4) as f32, 2.0 * angle.sin());
        let light =
            PointLight { ambient: dim(point_light().ambient), diffuse: dim(point_light().diffuse), ..point_light() };
        let light = PointLight { specular: dim(light.specular), ..light };
        let PointLight { ambient, diffuse, specular, .. } = light;
        scene.lamps.push(match i % 3 {
            0 => Lamp::point(light, at),
            1 => Lamp::spot(SpotLight { light, cone: Cone { cutoff: 0.7, inner: Some(0.1), exponent: 1.0 } }, at, -at),
            _ => Lamp::directional(DirectionalLight { ambient, diffuse, specular }, -at),
        });
    }
    scene
}

/// The still life under one light, changed.
fn with(change: fn(&mut Scene)) -> Scene {
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    change(&mut scene);
    scene
}

fn of_materials(scene: &mut Scene, change: fn(&mut Material)) {
    scene.things.iter_mut().for_each(|thing| change(&mut thing.material));
}

/// Lights of each kind and their materials as a scene has them that draws one term alone.
fn term_alone(term: Term) -> Scene {
    let mut scene = lights(6);
    scene.camera.background = LinearRgba::BLACK;
    for thing in &mut scene.things {
        thing.material.emission = LinearRgba::rgb(0.1, 0.05, 0.2);
        thing.material = term.of_material(thing.material);
    }
    for lamp in &mut scene.lamps {
        if term == Term::Ambient {
            lamp.kind = match &lamp.kind {
                Kind::Directional(light) => Kind::Directional(light.ambient_alone()),
                Kind::Point(light) => Kind::Point(light.ambient_alone()),
                Kind::Spot(light) => Kind::Spot(light.ambient_alone()),
                Kind::Hemisphere(light) => Kind::Hemisphere(light.ambient_alone()),
            };
        }
    }
    scene
}

fn of_light(scene: &mut Scene, light: PointLight) {
    scene.lamps = vec![Lamp::point(light, Vec3::new(1.2, 1.6, 1.8))];
}

fn materials_and_lights() -> Vec<(&'static str, Scene)> {
    vec![
        ("no lights", still_life()),
        ("emission alone", with(|scene| of_materials(scene, |m| *m = glowing(0.31, 0.52, 0.22)))),
        ("without ambient", with(|scene| scene.ambient = LinearRgba::BLACK)),
        ("without a specular colour", with(|scene| of_materials(scene, |m| m.specular = LinearRgba::BLACK))),
        ("without a diffuse colour", with(|scene| of_materials(scene, |m| m.diffuse = LinearRgba::BLACK))),
        ("a shininess of 0", with(|scene| of_materials(scene, |m| m.shininess = 0.0))),
        ("a shininess of 16", with(|scene| of_materials(scene, |m| m.shininess = 16.0))),
        (
            "a shininess of 16 under Phong's reflectance",
            with(|scene| {
                of_materials(scene, |m| m.shininess = 16.0);
                scene.view_reflectance = Some(Reflectance::Phong);
            }),
        ),
        (
            "ambient that attenuates",
            with(|scene| {
                of_light(scene, PointLight { attenuate_ambient: true, ..point_light() });
            }),
        ),
        (
            "ambient that attenuates with a cone and a range",
            with(|scene| {
                let light = PointLight { attenuate_ambient: true, range: Some(4.0), ..point_light() };
                let cone = Cone { cutoff: 0.5, inner: Some(0.1), exponent: 1.0 };
                let at = Vec3::new(1.2, 1.6, 1.8);
                scene.lamps = vec![Lamp::spot(SpotLight { light, cone }, at, -at)];
            }),
        ),
        (
            "one colour for diffuse and specular",
            with(|scene| {
                of_light(scene, PointLight::new(LinearRgba::rgb(0.9, 0.7, 0.8)));
            }),
        ),
        (
            "brighter than 1",
            with(|scene| {
                of_light(scene, PointLight::new(LinearRgba::rgb(9.0, 4.0, 2.0)));
            }),
        ),
        ("the ambient term alone", term_alone(Term::Ambient)),
        ("the diffuse term alone", term_alone(Term::Diffuse)),
        ("the specular term alone", term_alone(Term::Specular)),
        ("the emission alone", term_alone(Term::Emission)),
        ("two lights of each kind", lights(6)),
        ("a hemisphere alone", still_life().lit(outside())),
        ("a hemisphere beside a lamp", with(|scene| scene.lamps.push(outside()))),
        ("a hemisphere among nine lights", lights(9).lit(outside())),
        ("nine lights", lights(9)),
        ("130 lights", lights(130)),
        ("an orthographic camera and 20 lights", {
            let mut scene = lights(20);
            scene.camera.projection = Projection::orthographic(3.0);
            scene
        }),
    ]
}

fn places_views_and_meshes() -> Vec<(&'static str, Scene)> {
    vec![
        ("a light on the camera", still_life().lit(point(Vec3::new(0.3, 0.2, 0.1)).on(On::Camera))),
        ("a spot on an object", {
            let mut scene = still_life();
            scene.things[0].frames = vec![scaled(0.9, 0.7, 1.1), rotated(0.3, 0.4, 0.2)];
            scene.lit(Lamp { at: shining(Vec3::Y * 2.0, Vec3::NEG_Y), ..spot(Vec3::Y) }.on(On::Thing(0)))
        }),
        ("all terms per vertex and per fragment", {
            let mut scene = with(|scene| scene.lamps.push(sun(Vec3::new(0.7, -1.0, -0.2))));
            let all = [Frequency::Never, Frequency::Vertex, Frequency::Fragment];
            let pairs = all.iter().flat_map(|diffuse| all.iter().map(move |specular| (*diffuse, *specular)));
            scene.things = pairs
                .enumerate()
                .map(|(i, (diffuse, specular))| {
                    let at = Vec3::new((i % 3) as f32 - 1.0, 0.8 - 0.8 * (i / 3) as f32, 0.0);
                    Thing::new(UvSphere::new(0.4, 8, 5)).at(Transform::from_translation(at)).terms(diffuse, specular)
                })
                .collect();
            scene
        }),
        (
            "the view's shading and reflectance",
            with(|scene| {
                scene.view_shading = Some(Shading::Gouraud);
                scene.view_reflectance = Some(Reflectance::Phong);
            }),
        ),
        (
            "an object's own shading and reflectance",
            with(|scene| {
                scene.view_shading = Some(Shading::Flat);
                scene.things[0].shading = Some(Shading::Phong);
                scene.things[0].reflectance = Some(Reflectance::BlinnPhongMatched);
            }),
        ),
        (
            "a rolled camera with a wide view",
            with(|scene| {
                scene.eye.rotation *= Quat::from_rotation_z(0.8);
                scene.camera.projection = Projection::perspective(1.6);
            }),
        ),
        ("cut by the near plane", with(|scene| scene.camera.projection = scene.camera.projection.with_near(2.9))),
        (
            "an orthographic camera amid the objects",
            with(|scene| {
                scene.camera.projection = Projection::orthographic(3.0).with_near(-4.0);
                scene.eye.translation *= 0.1;
            }),
        ),
        (
            "an orthographic camera far away",
            with(|scene| {
                scene.camera.projection = Projection::orthographic(3.0);
                scene.eye.translation -= 30.0 * scene.eye.forward();
            }),
        ),
        (
            "an orthographic plan",
            with(|scene| {
                let (camera, eye) = Camera::orthographic(4.0).framing((Vec3::ZERO, 1.6), Vec3::NEG_Y);
                (scene.camera.projection, scene.eye) = (camera.projection, eye);
            }),
        ),
        ("normals that cancel", {
            let (left, right) = ([1.0, 0.0, 0.1], [-1.0, 0.0, 0.1]);
            Scene::in_eye_space()
                .with(Thing::new(screen([left, right, right, left])))
                .lit(sun(Vec3::new(0.2, -0.1, -1.0)))
        }),
        (
            "objects through each other",
            with(|scene| {
                let cube = Thing::new(Cuboid::new(1.3, 0.5, 1.9)).at(rotated(0.3, 0.5, 0.2));
                scene.things.push(cube.with_material(other_material()).shaded(Shading::Flat));
            }),
        ),
        (
            "the teapot",
            with(|scene| {
                let pot =
                    Thing::new(Teapot::new(5)).at(Transform::from_xyz(-0.1, -0.6, 0.0).with_scale(Vec3::splat(0.42)));
                scene.things[0] = pot.with_material(material()).faces(Faces::Both);
            }),
        ),
        (
            "a bowl through a bowl",
            with(|scene| {
                let bowl = |x: f32| {
                    let at = rotated(2.6, 0.0, 0.3).with_translation(Vec3::new(x, 0.1, -0.6 * x));
                    Thing::new(hemisphere(12, 6)).at(at).faces(Faces::Both).blended(0.5)
                };
                scene.things = vec![bowl(-1.2), bowl(1.0).back(Material { opacity: 0.8, ..other_material() })];
            }),
        ),
    ]
}

pub(super) fn rows() -> Vec<Row> {
    materials_and_lights()
        .into_iter()
        .chain(places_views_and_meshes())
        .map(|(name, scene)| Row::new(name, scene))
        .collect()
}

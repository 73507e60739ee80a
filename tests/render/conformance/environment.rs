//! The rows of objects in an environment.

use super::Row;
use super::colors::{Change, SHADINGS, colored};
use super::features::{lights, point, still_life};
use super::maps;
use crate::render::compare::BLENDED;
use crate::render::scene::{Around, Scene, other_material};
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::texture::environment::{Environment, EnvironmentMap, EnvironmentShape};
use halfway::texture::{FarNormals, Sampling, UvTransform};
use std::sync::OnceLock;

/// An environment of 16 texels a face, in which no two directions and no two channels are alike.
pub(crate) fn map() -> EnvironmentMap {
    static MAP: OnceLock<EnvironmentMap> = OnceLock::new();
    let color = |[x, y, z]: [f64; 3]| {
        let sun = (0.5 * (0.48 * x + 0.6 * y + 0.64 * z) + 0.5).powi(24);
        let wave = |x: f64| 0.3 + 0.2 * (4.0 * x).sin();
        [wave(x + y) + sun, wave(y - 0.5 * z) + 0.8 * sun, wave(z + 0.3) + 0.5 * sun, 1.0].map(|number| number as f32)
    };
    MAP.get_or_init(|| {
        let cube = Environment::from_fn(EnvironmentShape::Cube, 16, color).expect("a small environment");
        EnvironmentMap::new(&cube).expect("a small environment")
    })
    .clone()
}

pub(crate) fn around(strength: f32) -> Around {
    Around { map: map(), strength, rotation: 0.0, sky: false }
}

fn surrounded() -> Scene {
    let mut scene = still_life();
    scene.ambient = LinearRgba::BLACK;
    for thing in &mut scene.things {
        thing.material.specular = LinearRgba::rgb(0.5, 0.45, 0.4);
        thing.material.diffuse = LinearRgba::rgb(0.5, 0.4, 0.3);
    }
    scene.environment = Some(around(0.8));
    scene
}

fn each_material(scene: &mut Scene, change: impl Fn(&mut Material)) {
    scene.things.iter_mut().for_each(|thing| change(&mut thing.material));
}

/// Settings that make no difference to its shading.
const CHANGES: [Change; 17] = [
    ("all", |_| ()),
    ("harmonics alone", |scene| each_material(scene, |material| material.specular = LinearRgba::BLACK)),
    ("mirrored alone", |scene| each_material(scene, |material| material.diffuse = LinearRgba::BLACK)),
    ("a mirror", |scene| each_material(scene, |material| material.shininess = 1e5)),
    ("exponent 0", |scene| each_material(scene, |material| material.shininess = 0.0)),
    ("turned", |scene| scene.environment.as_mut().expect("one").rotation = 2.1),
    ("sky", |scene| scene.environment.as_mut().expect("one").sky = true),
    ("sky behind what blends", |scene| {
        scene.environment.as_mut().expect("one").sky = true;
        for thing in &mut scene.things {
            *thing = thing.clone().faces(Faces::Both).back(other_material()).blended(0.7);
        }
    }),
    ("infinite viewer", |scene| scene.camera.viewer = Viewer::Infinite),
    ("one light", |scene| scene.lamps = vec![point(Vec3::new(1.2, 1.6, 1.8))]),
    ("20 lights", |scene| scene.lamps = lights(20).lamps),
    ("colours", |scene| scene.things.iter_mut().for_each(|thing| thing.mesh = colored(thing.mesh.clone()))),
    ("backs", |scene| {
        scene.things.iter_mut().for_each(|thing| {
            thing.faces = Some(Faces::Back);
            thing.frames.push(Transform::from_scale(Vec3::new(-0.9, 1.2, 0.7)));
        });
    }),
    ("through the near plane", |scene| scene.camera.projection = scene.camera.projection.with_near(2.6)),
    ("orthographic", |scene| scene.camera.projection = Projection::orthographic(2.7)),
    ("off-centre sky", |scene| {
        let film = Film { shift: [0.2, -0.15], aspect: None, pixel_aspect: 0.8 };
        scene.camera.projection = scene.camera.projection.with_film(film);
        scene.environment.as_mut().expect("one").sky = true;
    }),
    ("orthographic sky", |scene| {
        scene.camera.projection = Projection::orthographic(2.7);
        scene.environment.as_mut().expect("one").sky = true;
    }),
];

const REFLECTANCES: [(&str, Reflectance); 3] = [
    ("phong reflectance", Reflectance::Phong),
    ("blinn-phong", Reflectance::BlinnPhong),
    ("matched", Reflectance::BlinnPhongMatched),
];

pub(super) fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for (shading, shade) in SHADINGS {
        for (what, change) in CHANGES {
            let mut scene = surrounded();
            change(&mut scene);
            shade(&mut scene);
            rows.push(Row::new(format!("environment, {shading}, {what}"), scene));
        }
        for (name, reflectance) in REFLECTANCES {
            let mut scene = surrounded();
            scene.view_reflectance = Some(reflectance);
            shade(&mut scene);
            rows.push(Row::new(format!("environment, {shading}, {name}"), scene));
        }
    }
    // The environment is drawn whatever the lights' terms.
    let mut scene = surrounded();
    scene.things.iter_mut().for_each(|thing| thing.shading = Some(Shading::Terms(Terms::both(Frequency::Never))));
    rows.push(Row::new("environment, no terms", scene));
    let mut empty = Scene { things: Vec::new(), ..surrounded() };
    empty.things.push(crate::render::scene::Thing::new(UvSphere::new(0.8, 12, 6)));
    empty.environment.as_mut().expect("one").sky = true;
    rows.push(Row::new("environment, next to nothing but sky", empty));
    rows
}

/// Four samples a pixel, with the sky evaluated at its center: the sharpest mirrors, and surfaces over edges.
pub(super) fn rows_of_four() -> Vec<Row> {
    let kept = ["all", "harmonics alone", "a mirror", "sky", "sky behind what blends", "one light", "backs"];
    let changes = || CHANGES.into_iter().filter(|(what, _)| kept.contains(what));
    let mut rows = Vec::new();
    for (shading, shade) in SHADINGS.into_iter().take(3) {
        for (what, change) in changes() {
            let mut scene = surrounded();
            change(&mut scene);
            shade(&mut scene);
            scene.camera.samples = Samples::Four;
            // The number of equal bytes depends on the positions of the samples.
            rows.push(Row { raw: BLENDED, ..Row::new(format!("environment, four samples, {shading}, {what}"), scene) });
        }
    }
    rows
}

/// The environment with images on the objects.
pub(super) fn rows_of_maps() -> Vec<Row> {
    let kinds = [
        (MapKind::Color, 0.9),
        (MapKind::Specular, 1.0),
        (MapKind::Occlusion, 0.7),
        (MapKind::Shininess, 0.9),
        (MapKind::Normal, 0.6),
        (MapKind::Height, 0.04),
    ];
    let mut rows = Vec::new();
    for (shading, shade) in SHADINGS.into_iter().take(3) {
        for (kind, amount) in kinds {
            let mut scene = surrounded().lit(point(Vec3::new(1.2, 1.6, 1.8)));
            let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale: [1.3, 0.9] };
            for thing in &mut scene.things {
                let map = crate::render::scene::Map { amount, ..maps::map(Sampling::default(), transform) };
                thing.maps = vec![(kind, map)];
            }
            shade(&mut scene);
            rows.push(Row::new(format!("environment, {}, {shading}", kind.name()), scene.clone()));
            if kind == MapKind::Normal {
                for far in [FarNormals::Toksvig, FarNormals::Lean] {
                    let mut scene = scene.clone();
                    scene.things.iter_mut().for_each(|thing| thing.maps[0].1.far_normals = far);
                    rows.push(Row::new(format!("environment, {far:?}, {shading}"), scene));
                }
            }
        }
    }
    rows
}

//! The rows of objects with an image.

use super::Row;
use super::colors::colored;
use super::features::{lights, point, still_life};
use crate::render::scene::{Map, Scene, Thing, other_material, point_light};
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::texture::{LevelFilter, Sampling, TexelFilter, TexelImage, UvTransform, Wrap};

/// An image of an odd size that changes smoothly, in which no two channels are alike.
fn image() -> TexelImage {
    let wave = |x: f32| 0.5 + 0.45 * (std::f32::consts::TAU * x).sin();
    TexelImage::from_fn(21, 14, |x, y| {
        let (u, v) = (x as f32 / 21.0, y as f32 / 14.0);
        [wave(u), wave(v + 0.2), wave(u + v), 0.75 + 0.2 * wave(2.0 * v)]
    })
    .expect("a small image")
}

pub(crate) fn map(sampling: Sampling, transform: UvTransform) -> Map {
    Map { image: image(), sampling, transform }
}

fn mapped(sampling: Sampling, scale: f32) -> Scene {
    let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale: [scale, 0.8 * scale] };
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    for thing in &mut scene.things {
        thing.map = Some(map(sampling, transform));
    }
    scene
}

type Change = (&'static str, fn(&mut Scene));

const SHADINGS: [Change; 6] = [
    ("flat", |scene| scene.view_shading = Some(Shading::Flat)),
    ("gouraud", |scene| scene.view_shading = Some(Shading::Gouraud)),
    ("phong", |scene| scene.view_shading = Some(Shading::Phong)),
    ("automatic", |scene| scene.view_shading = Some(Shading::Auto)),
    ("diffuse at vertices", |scene| terms(scene, Frequency::Vertex, Frequency::Fragment)),
    ("specular at vertices", |scene| terms(scene, Frequency::Fragment, Frequency::Vertex)),
];

fn terms(scene: &mut Scene, diffuse: Frequency, specular: Frequency) {
    scene.things.iter_mut().for_each(|thing| thing.terms = Some(Terms { diffuse, specular }));
}

const CHANGES: [Change; 7] = [
    ("one light", |_| ()),
    ("no lights", |scene| scene.lamps.clear()),
    ("20 lights", |scene| scene.lamps = lights(20).lamps),
    ("colours, ambient that attenuates", |scene| {
        let light = PointLight { attenuate_ambient: true, ..point_light() };
        scene.lamps = vec![crate::render::scene::Lamp::point(light, Vec3::new(1.2, 1.6, 1.8))];
        scene.things.iter_mut().for_each(|thing| thing.mesh = colored(thing.mesh.clone()));
    }),
    ("both sides, blended", |scene| {
        for thing in &mut scene.things {
            *thing = thing.clone().faces(Faces::Both).back(other_material()).blended(0.8);
        }
    }),
    ("through the near plane", |scene| scene.camera.near = 2.6),
    ("beside what has none, instanced", |scene| {
        for x in [-1.2, 1.2] {
            let at = Transform::from_xyz(x, 0.3, 0.0).with_scale(Vec3::splat(0.4));
            scene.things.push(Thing { frames: vec![at], ..scene.things[0].clone() });
        }
        scene.things.push(Thing::new(UvSphere::new(0.3, 12, 6)).at(Transform::from_xyz(0.0, 0.9, 0.2)));
    }),
];

/// Every filter that is continuous, reducing and enlarging, and every way to wrap.
fn filters() -> Vec<(String, Sampling, f32)> {
    let mut rows = Vec::new();
    for filter in [TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom] {
        for (levels, scale) in [(LevelFilter::None, 0.3), (LevelFilter::None, 1.0), (LevelFilter::Linear, 4.0)] {
            let sampling = Sampling { magnify: filter, minify: filter, levels, ..Sampling::default() };
            rows.push((format!("{filter:?}, {levels:?} levels, {scale} times"), sampling, scale));
        }
    }
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for filter in [TexelFilter::Bilinear, TexelFilter::CatmullRom] {
            let sampling = Sampling { wrap: [wrap, Wrap::Mirror], magnify: filter, ..Sampling::default() };
            rows.push((format!("{filter:?}, {wrap:?}"), sampling, 1.7));
        }
    }
    rows
}

pub(super) fn rows() -> Vec<Row> {
    let pairs = SHADINGS.iter().flat_map(|shading| CHANGES.iter().map(move |change| (shading, change)));
    let shaded = pairs.map(|((shading, shade), (what, change))| {
        let mut scene = mapped(Sampling::default(), 1.3);
        change(&mut scene);
        shade(&mut scene);
        Row::new(format!("image, {shading}, {what}"), scene)
    });
    let filtered = filters()
        .into_iter()
        .map(|(name, sampling, scale)| Row::new(format!("image, {name}"), mapped(sampling, scale)));
    shaded.chain(filtered).collect()
}

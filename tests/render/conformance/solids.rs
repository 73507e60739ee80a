//! The rows of objects that are cut from a solid.

use super::Row;
use super::colors::{Change, SHADINGS, colored};
use super::environment::around;
use super::features::{lights, point, still_life};
use super::maps;
use crate::render::scene::{Map, Scene, Thing, other_material, point_light};
use halfway::prelude::*;
use halfway::texture::UvTransform;

/// One of a kind whose colors share no channel, askew in the object, stretched, and with its cells larger and smaller
/// than pixels in the still life.
pub(crate) fn solid(kind: SolidKind) -> SolidTexture {
    let rotation = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, -0.4);
    let place = Mat4::from_scale_rotation_translation(Vec3::new(2.9, 2.3, 3.4), rotation, Vec3::new(0.31, -0.17, 0.23));
    SolidTexture::new(kind, [[0.15, 0.3, 0.9], [0.95, 0.75, 0.2]]).placed(place.to_cols_array_2d()).with_octaves(4)
}

fn cut_from(solid: SolidTexture) -> Scene {
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    scene.things.iter_mut().for_each(|thing| thing.solid = Some(solid));
    scene
}

const CHANGES: [Change; 12] = [
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
    ("mirrored and stretched", |scene| {
        scene.things.iter_mut().for_each(|thing| thing.frames.push(Transform::from_scale(Vec3::new(0.8, -1.1, 1.3))));
    }),
    ("through the near plane", |scene| scene.camera.projection = scene.camera.projection.with_near(2.6)),
    ("orthographic", |scene| scene.camera.projection = Projection::orthographic(2.7)),
    ("beside what has none, instanced", |scene| {
        for x in [-1.2, 1.2] {
            let at = Transform::from_xyz(x, 0.3, 0.0).with_scale(Vec3::splat(0.4));
            scene.things.push(Thing { frames: vec![at], ..scene.things[0].clone() });
        }
        scene.things.push(Thing::new(UvSphere::new(0.3, 12, 6)).at(Transform::from_xyz(0.0, 0.9, 0.2)));
    }),
    ("much finer than pixels", |scene| each_solid(scene, |solid| solid.scaled(9.0))),
    ("with images, masked", |scene| {
        let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale: [1.3, 0.9] };
        let map = maps::map(Sampling::default(), transform);
        for thing in &mut scene.things {
            let relief = Map { amount: 0.6, ..map.clone() };
            thing.maps = vec![(MapKind::Color, map.clone()), (MapKind::Normal, relief)];
            thing.mask = Some(0.7);
        }
    }),
    ("one octave", |scene| each_solid(scene, |solid| solid.with_octaves(1))),
    ("flattened in one direction", |scene| {
        each_solid(scene, |solid| solid.placed(Mat4::from_scale(Vec3::new(3.1, 0.0, 2.7)).to_cols_array_2d()));
    }),
];

fn each_solid(scene: &mut Scene, change: impl Fn(SolidTexture) -> SolidTexture) {
    scene.things.iter_mut().for_each(|thing| thing.solid = thing.solid.map(&change));
}

/// Every kind under every shading, and each further feature under every shading, with the kinds in turn.
pub(super) fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for (number, (shading, shade)) in SHADINGS.into_iter().enumerate() {
        for kind in SolidKind::ALL {
            let mut scene = cut_from(solid(kind));
            shade(&mut scene);
            rows.push(Row::new(format!("{kind:?}, {shading}"), scene));
        }
        for (turn, (what, change)) in CHANGES.into_iter().enumerate() {
            let kind = SolidKind::ALL[(number + turn) % SolidKind::ALL.len()];
            let mut scene = cut_from(solid(kind));
            change(&mut scene);
            shade(&mut scene);
            rows.push(Row::new(format!("{kind:?}, {shading}, {what}"), scene));
        }
    }
    rows
}

/// The same in an environment.
pub(super) fn rows_in_environments() -> Vec<Row> {
    let mut rows = Vec::new();
    for (shading, shade) in SHADINGS.into_iter().take(3) {
        for kind in SolidKind::ALL {
            let mut scene = cut_from(solid(kind));
            scene.environment = Some(around(0.8));
            shade(&mut scene);
            rows.push(Row::new(format!("environment, {kind:?}, {shading}"), scene));
        }
    }
    rows
}

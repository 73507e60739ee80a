//! The rows of meshes with colours at their vertices.

use super::Row;
use super::features::{lights, point, still_life};
use crate::render::scene::{Scene, Thing, other_material, point_light};
use halfway::lighting::Frequency;
use halfway::prelude::*;

/// The mesh with colours that change along every axis, some outside of 0 to 1, and opacities.
pub(crate) fn colored(mesh: impl Into<Mesh>) -> Mesh {
    let mesh = mesh.into();
    let wave = |x: f32| 0.5 + 0.6 * x.sin();
    let colors =
        mesh.positions().iter().map(|p| Vec4::new(wave(3.0 * p.x), wave(4.0 * p.y), wave(5.0 * p.z), wave(p.x)));
    let colors = colors.collect();
    mesh.with_colors(colors).expect("a colour a vertex")
}

/// The scene with colours at the vertices of all its meshes.
fn with_colors(mut scene: Scene) -> Scene {
    for thing in &mut scene.things {
        thing.mesh = colored(thing.mesh.clone());
    }
    scene
}

fn lit() -> Scene {
    with_colors(still_life().lit(point(Vec3::new(1.2, 1.6, 1.8))))
}

/// The change of a scene in a row.
pub(super) type Change = (&'static str, fn(&mut Scene));

/// Shadings and mixtures of terms.
pub(super) const SHADINGS: [Change; 6] = [
    ("flat", |scene| scene.view_shading = Some(Shading::Flat)),
    ("gouraud", |scene| scene.view_shading = Some(Shading::Gouraud)),
    ("phong", |scene| scene.view_shading = Some(Shading::Phong)),
    ("unlit", unlit),
    ("diffuse at vertices", |scene| terms(scene, Frequency::Vertex, Frequency::Fragment)),
    ("specular at vertices", |scene| terms(scene, Frequency::Fragment, Frequency::Vertex)),
];

fn unlit(scene: &mut Scene) {
    scene.view_shading = Some(Shading::Unlit);
    for thing in &mut scene.things {
        [Some(&mut thing.material), thing.back.as_mut()].into_iter().flatten().for_each(off_ties);
    }
}

/// 0.1, 0.3 and 0.7 of 255 lie in the middle between two bytes, and an unlit object shows them as they are.
pub(super) fn off_ties(material: &mut Material) {
    let LinearRgba { red, green, blue, .. } = material.diffuse;
    material.diffuse = LinearRgba::rgb(0.97 * red, 0.97 * green, 0.97 * blue);
}

fn terms(scene: &mut Scene, diffuse: Frequency, specular: Frequency) {
    scene.things.iter_mut().for_each(|thing| thing.shading = Some(Shading::Terms(Terms { diffuse, specular })));
}

const CHANGES: [Change; 10] = [
    ("one light", |_| ()),
    ("no lights", |scene| scene.lamps.clear()),
    ("130 lights", |scene| scene.lamps = lights(130).lamps),
    ("20 lights", |scene| scene.lamps = lights(20).lamps),
    ("ambient that attenuates", |scene| {
        let light = PointLight { attenuate_ambient: true, ..point_light() };
        scene.lamps = vec![crate::render::scene::Lamp::point(light, Vec3::new(1.2, 1.6, 1.8))];
    }),
    ("both sides, blended", |scene| {
        for thing in &mut scene.things {
            *thing = thing.clone().faces(Faces::Both).back(other_material()).blended(0.8);
        }
    }),
    ("the back", |scene| {
        // Brighter: the curve of sRGB is steep in the dark, and a facet turns over as a whole.
        scene.ambient = LinearRgba::rgb(0.5, 0.5, 0.5);
        scene.things.iter_mut().for_each(|thing| thing.faces = Some(Faces::Back));
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
];

pub(super) fn rows() -> Vec<Row> {
    let pairs = SHADINGS.iter().flat_map(|shading| CHANGES.iter().map(move |change| (shading, change)));
    pairs
        .map(|((shading, shade), (what, change))| {
            let mut scene = lit();
            change(&mut scene);
            shade(&mut scene);
            Row::new(format!("colours, {shading}, {what}"), scene)
        })
        .collect()
}

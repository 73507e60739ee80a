//! Flat triangles seen edge-on, for which the rasteriser and the shader may disagree on the visible side.

use std::f32::consts::TAU;

use crate::render::scene::{Lamp, Scene, Thing, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// Emission and ambient of [`material`] under this ambient light.
const AMBIENT: f32 = 0.8;

fn least() -> [f32; 3] {
    let Material { ambient, emission, .. } = material();
    [(ambient.red, emission.red), (ambient.green, emission.green), (ambient.blue, emission.blue)]
        .map(|(ka, ke)| ke + AMBIENT * ka)
}

/// Triangles around the z axis like the sectors of a disc, each turned out of it so far that some are seen edge-on.
fn blades(count: u16) -> Mesh {
    let mut positions = Vec::new();
    for i in 0..count {
        let share = f32::from(i) / f32::from(count);
        let (sine, cosine) = (TAU * share).sin_cos();
        let [along, across] = [Vec3::new(cosine, sine, 0.0), Vec3::new(-sine, cosine, 0.0)];
        // Edge-on from anywhere on the z axis, give or take a thousandth of the width: a hundredth of a pixel.
        let tilt = (share - 0.5) * 4e-3;
        let width = 0.05 * (across * tilt + Vec3::Z);
        positions.extend([0.1 * along, along + width, along - width]);
    }
    let indices = (0..3 * u32::from(count)).collect();
    Mesh::from_parts(positions, None, None, indices).expect("triangles")
}

/// Something that turns before a camera.
struct Turning {
    mesh: Mesh,
    eye: Vec3,
    turned: fn(f32) -> Quat,
    frames: u8,
}

/// How many pixels are darker than emission and ambient, over a whole turn, and how many show the object.
fn darker(stage: &mut Stage, seen: &Turning, faces: Faces, blend: bool) -> [usize; 2] {
    let &Turning { eye, turned, frames, .. } = seen;
    let mut found = [0; 2];
    for frame in 0..frames {
        let turn = TAU * f32::from(frame) / f32::from(frames);
        let mut thing = Thing::new(seen.mesh.clone()).shaded(Shading::Flat).faces(faces);
        thing.frames = vec![Transform::from_rotation(turned(turn))];
        let light = PointLight { ambient: LinearRgba::BLACK, ..point_light() };
        let mut scene = Scene::seen_from(eye, Vec3::ZERO)
            .ambient(AMBIENT)
            .with(if blend { thing.blended(1.0) } else { thing })
            .lit(Lamp::point(light, Vec3::new(2.0, 3.0, 2.0)));
        // Nothing behind is darker.
        scene.camera.background = LinearRgba::rgb(9.0, 9.0, 9.0);
        let picture = stage.draw(&scene);
        // A few roundings.
        let is_dark = |pixel: &[f32; 4]| (0..3).any(|k| pixel[k] < least()[k] * (1.0 - 1e-6));
        found[0] += picture.pixels().filter(|pixel| is_dark(&pixel.0)).count();
        found[1] += picture.pixels().filter(|pixel| pixel.0[0] < 9.0).count();
    }
    found
}

/// A triangle that the rasteriser drew although n·p made it face away was once black.
#[test]
fn no_flat_pixel_is_darker_than_emission_and_ambient() {
    let mut stage = Stage::new(160, 120);
    let all_around = |mesh: Mesh, frames| {
        let turned = |turn| Quat::from_euler(EulerRot::YXZ, turn, 0.3 * turn, 0.0);
        Turning { mesh, eye: Vec3::new(0.0, 0.2, 3.0), turned, frames }
    };
    let about_the_axis = Turning { mesh: blades(2000), eye: 3.0 * Vec3::Z, turned: Quat::from_rotation_z, frames: 24 };
    for (name, seen) in [
        ("a teapot", all_around(Teapot::default().into(), 30)),
        ("a sphere of triangles smaller than the grid", all_around(UvSphere::new(1.0, 700, 350).into(), 4)),
        ("blades", about_the_axis),
    ] {
        for faces in [Faces::Front, Faces::Back, Faces::Both] {
            for blend in [false, true] {
                let [dark, shown] = darker(&mut stage, &seen, faces, blend);
                let row = format!("{name}, {faces:?}, blended {blend}");
                assert!(shown > 1000, "{row}: {shown} pixels show it");
                assert_eq!(dark, 0, "{row}: of {shown} pixels");
            }
        }
    }
}

//! The scenes of the homework. They were fixed before the marking was tried on them; the last one
//! was added for two mistakes that show in none of the others.

use std::f32::consts::FRAC_PI_4;

use bevy_math::{Mat4, Quat, Vec3};
use halfway_lighting::{Encoding, Faces, Reflectance, Shading, Viewer};
use halfway_mesh::{Cuboid, Cylinder, Mesh, ParametricSurface, Plane, Tessellation, Torus, UvSphere};

use crate::task::{Lamp, LampKind, Look, Task, Thing};

const BLACK: [f32; 3] = [0.0; 3];
const WHITE: [f32; 3] = [1.0; 3];

fn look(kd: [f32; 3], ks: f32, shininess: f32) -> Look {
    Look { ka: kd.map(|k| 0.5 * k + 0.1), kd, ks: [ks; 3], ke: BLACK, shininess }
}

fn thing(mesh: impl Into<Mesh>, place: Mat4, front: Look, shading: Shading) -> Thing {
    Thing {
        mesh: mesh.into(),
        place,
        front,
        back: None,
        shading,
        reflectance: Reflectance::BlinnPhong,
        faces: Faces::Front,
    }
}

fn lamp(kind: LampKind, color: [f32; 3]) -> Lamp {
    Lamp { kind, la: BLACK, ld: color, ls: color, attenuation: [1.0, 0.0, 0.0], range: None, attenuates_ambient: false }
}

fn task(name: &'static str, eye: Vec3, things: Vec<Thing>, lamps: Vec<Lamp>) -> Task {
    Task {
        name,
        eye,
        target: Vec3::ZERO,
        fov: FRAC_PI_4,
        viewer: Viewer::Local,
        encoding: Encoding::Srgb,
        background: [0.02, 0.03, 0.05],
        ambient: [0.15; 3],
        things,
        lamps,
    }
}

fn at(x: f32, y: f32, z: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, y, z))
}

fn sun(x: f32, y: f32, z: f32) -> LampKind {
    LampKind::Sun(Vec3::new(x, y, z).normalize())
}

fn bulb(x: f32, y: f32, z: f32) -> LampKind {
    LampKind::Bulb(Vec3::new(x, y, z))
}

pub(crate) fn all() -> Vec<Task> {
    vec![ball(), eggs(), doughnut(), facets(), stage(), bowl(), glare(), crowd(), lanterns(), road(), pipe()]
}

/// One ball under a bulb and a sun.
fn ball() -> Task {
    let bulb = Lamp { attenuation: [1.0, 0.1, 0.05], ..lamp(bulb(2.0, 2.5, 2.0), [1.0, 0.9, 0.7]) };
    let sun = Lamp { ls: [0.2, 0.3, 0.9], ..lamp(sun(1.0, -0.6, -0.4), [0.3, 0.35, 0.5]) };
    let ball = thing(UvSphere::new(1.0, 24, 12), Mat4::IDENTITY, look([0.7, 0.25, 0.2], 0.5, 24.0), Shading::Phong);
    task("ball", Vec3::new(1.5, 1.0, 3.0), vec![ball], vec![bulb, sun])
}

/// Stretched spheres by Phong's reflectance, in raw intensities.
fn eggs() -> Task {
    let turned = |x: f32, angle: f32, scale: Vec3| {
        Mat4::from_scale_rotation_translation(scale, Quat::from_rotation_z(angle), Vec3::new(x, 0.0, 0.0))
    };
    let egg = |place: Mat4, kd: [f32; 3]| Thing {
        reflectance: Reflectance::Phong,
        ..thing(UvSphere::new(0.8, 20, 10), place, look(kd, 0.6, 12.0), Shading::Phong)
    };
    let eggs = vec![
        egg(turned(-0.9, 0.6, Vec3::new(1.5, 0.5, 0.8)), [0.2, 0.5, 0.7]),
        egg(turned(0.9, -0.3, Vec3::new(0.5, 1.3, 1.0)), [0.6, 0.6, 0.2]),
    ];
    let lamps = vec![
        Lamp { attenuation: [0.5, 0.2, 0.02], ..lamp(bulb(-2.0, 2.0, 3.0), [1.0, 1.0, 0.9]) },
        Lamp { attenuation: [0.3, 0.0, 0.1], ..lamp(bulb(3.0, -1.0, 1.5), [0.8, 0.4, 0.4]) },
    ];
    Task { encoding: Encoding::Raw, ..task("eggs", Vec3::new(-1.0, 1.5, 3.5), eggs, lamps) }
}

/// Gouraud shading on a coarse torus.
fn doughnut() -> Task {
    let place = Mat4::from_rotation_x(0.9) * Mat4::from_rotation_y(0.4);
    let ring = Torus { radius: 1.0, tube: 0.4 }.mesh(Tessellation::Count { rows: 8, columns: 14 });
    let ring = thing(ring.expect("a valid torus"), place, look([0.3, 0.6, 0.3], 0.7, 10.0), Shading::Gouraud);
    let lamps = vec![
        Lamp { la: [0.1, 0.05, 0.0], ..lamp(bulb(1.5, 2.5, 2.5), [0.9, 0.9, 0.8]) },
        lamp(sun(0.5, -0.3, -1.0), [0.2, 0.2, 0.5]),
    ];
    task("doughnut", Vec3::new(0.5, 0.8, 3.6), vec![ring], lamps)
}

/// Flat shading on a coarse sphere and a box.
fn facets() -> Task {
    let place = Mat4::from_rotation_translation(Quat::from_rotation_y(0.7), Vec3::new(1.1, -0.3, -0.3));
    let things = vec![
        thing(UvSphere::new(0.9, 12, 6), at(-0.7, 0.0, 0.0), look([0.8, 0.5, 0.2], 0.4, 8.0), Shading::Flat),
        thing(Cuboid::new(0.9, 1.2, 0.9), place, look([0.3, 0.4, 0.8], 0.3, 16.0), Shading::Flat),
    ];
    let lamps = vec![
        lamp(sun(-0.6, -1.0, -0.8), [0.7, 0.7, 0.6]),
        Lamp { attenuation: [0.6, 0.1, 0.1], ..lamp(bulb(0.5, 1.5, 2.0), [0.6, 0.7, 0.9]) },
    ];
    task("facets", Vec3::new(0.6, 1.2, 3.4), things, lamps)
}

/// A floor and a ball under two spots.
fn stage() -> Task {
    let things = vec![
        thing(Plane { size: 6.0, divisions: 8 }, at(0.0, -0.6, 0.0), look([0.6, 0.6, 0.55], 0.3, 20.0), Shading::Phong),
        thing(UvSphere::new(0.6, 20, 10), at(0.6, 0.0, 0.2), look([0.7, 0.3, 0.3], 0.6, 30.0), Shading::Phong),
    ];
    let spot = |at: Vec3, target: Vec3, cutoff: f32, inner: Option<f32>, exponent: f32| LampKind::Spot {
        at,
        toward: (target - at).normalize(),
        cutoff: cutoff.to_radians(),
        inner: inner.map(f32::to_radians),
        exponent,
    };
    let first = spot(Vec3::new(-2.0, 2.5, 1.5), Vec3::new(-0.4, -0.6, 0.0), 22.0, Some(12.0), 0.0);
    let second = spot(Vec3::new(2.2, 2.0, 1.0), Vec3::new(0.6, -0.3, 0.0), 35.0, None, 24.0);
    let lamps = vec![
        Lamp { attenuation: [1.0, 0.05, 0.01], ..lamp(first, [1.0, 0.9, 0.6]) },
        Lamp { attenuation: [0.8, 0.1, 0.0], la: [0.0, 0.1, 0.15], ..lamp(second, [0.6, 0.8, 1.0]) },
    ];
    task("stage", Vec3::new(-0.5, 2.2, 4.2), things, lamps)
}

/// An open, two-sided cylinder, with another material inside.
fn bowl() -> Task {
    let place = Mat4::from_rotation_x(0.8) * Mat4::from_rotation_z(0.5);
    let outside = look([0.7, 0.4, 0.15], 0.5, 16.0);
    let inside = Look { ke: [0.05, 0.0, 0.05], ..look([0.2, 0.5, 0.6], 0.6, 40.0) };
    let pipe = Cylinder { radius: 0.9, height: 1.6, capped: false };
    let pipe = pipe.mesh(Tessellation::Count { rows: 4, columns: 18 }).expect("a valid cylinder");
    let pipe = Thing { faces: Faces::Both, back: Some(inside), ..thing(pipe, place, outside, Shading::Phong) };
    let lamps = vec![
        Lamp { attenuation: [1.0, 0.05, 0.05], ..lamp(bulb(1.0, 3.0, 2.5), WHITE) },
        lamp(sun(0.8, -0.5, -0.6), [0.4, 0.3, 0.3]),
    ];
    task("bowl", Vec3::new(0.4, 1.4, 3.4), vec![pipe], lamps)
}

/// Intensities above 1, and lights with ambient colours of their own.
fn glare() -> Task {
    let place = Mat4::from_scale_rotation_translation(
        Vec3::new(1.0, 1.4, 0.7),
        Quat::from_rotation_y(0.5),
        Vec3::new(0.3, 0.0, 0.0),
    );
    let glossy = Look { ke: [0.06, 0.02, 0.1], ..look([0.8, 0.75, 0.6], 0.9, 18.0) };
    let body = thing(UvSphere::new(0.9, 24, 12), place, glossy, Shading::Phong);
    let lamps = vec![
        Lamp { la: [0.12, 0.1, 0.02], ..lamp(sun(-1.0, -0.8, -0.5), [1.1, 1.0, 0.8]) },
        Lamp {
            la: [0.0, 0.2, 0.3],
            attenuation: [0.7, 0.1, 0.05],
            range: Some(6.0),
            attenuates_ambient: true,
            ..lamp(bulb(-1.5, 1.5, 2.5), [0.9, 0.9, 1.0])
        },
    ];
    Task { ambient: [0.2, 0.15, 0.1], ..task("glare", Vec3::new(1.0, 0.6, 3.4), vec![body], lamps) }
}

/// Things before and inside each other, seen by a viewer at infinity, with matched exponents.
fn crowd() -> Task {
    let matched = |thing: Thing| Thing { reflectance: Reflectance::BlinnPhongMatched, ..thing };
    let things = vec![
        matched(thing(UvSphere::new(0.6, 16, 8), at(-0.6, 0.1, 0.8), look([0.7, 0.2, 0.5], 0.5, 6.0), Shading::Phong)),
        matched(thing(Cuboid::new(1.0, 1.0, 1.0), at(0.3, 0.0, -0.2), look([0.3, 0.6, 0.4], 0.4, 5.0), Shading::Phong)),
        matched(thing(
            UvSphere::new(0.7, 16, 8),
            at(1.1, -0.1, -0.6),
            look([0.6, 0.6, 0.3], 0.6, 8.0),
            Shading::Gouraud,
        )),
    ];
    let lamps = vec![
        lamp(sun(-0.4, -0.8, -0.9), [0.6, 0.6, 0.6]),
        Lamp { attenuation: [1.0, 0.0, 0.08], ..lamp(bulb(-1.0, 2.0, 2.5), [0.7, 0.6, 0.5]) },
        lamp(sun(0.9, 0.1, -0.5), [0.1, 0.15, 0.3]),
    ];
    Task { viewer: Viewer::Infinite, ..task("crowd", Vec3::new(0.9, 1.1, 3.6), things, lamps) }
}

/// Bulbs with ranges among balls on a floor.
fn lanterns() -> Task {
    let things = vec![
        thing(
            Plane { size: 5.0, divisions: 5 },
            at(0.0, -0.7, 0.0),
            look([0.5, 0.55, 0.6], 0.2, 12.0),
            Shading::Gouraud,
        ),
        thing(UvSphere::new(0.5, 18, 9), at(-0.8, -0.2, 0.3), look([0.8, 0.6, 0.2], 0.5, 20.0), Shading::Phong),
        thing(
            UvSphere::new(0.5, 18, 9),
            at(0.8, -0.2, -0.2) * Mat4::from_scale(Vec3::new(0.7, 1.5, 0.7)),
            look([0.3, 0.3, 0.8], 0.4, 32.0),
            Shading::Phong,
        ),
    ];
    let glowing = |kind: LampKind, color: [f32; 3]| Lamp {
        attenuation: [0.4, 0.2, 0.2],
        range: Some(3.0),
        la: color.map(|channel| 0.1 * channel),
        ..lamp(kind, color)
    };
    let lamps = vec![
        glowing(bulb(-1.2, 0.9, 1.2), [1.0, 0.6, 0.3]),
        glowing(bulb(1.4, 0.7, 0.9), [0.3, 0.6, 1.0]),
        glowing(bulb(0.0, 1.1, -0.8), [0.6, 1.0, 0.6]),
    ];
    Task { ambient: [0.08, 0.08, 0.12], ..task("lanterns", Vec3::new(0.3, 1.8, 4.0), things, lamps) }
}

/// A long road of few large triangles in steep perspective, by Gouraud.
fn road() -> Task {
    let place = at(0.0, -0.5, -3.0) * Mat4::from_scale(Vec3::new(0.5, 1.0, 2.0));
    let things = vec![
        thing(Plane { size: 6.0, divisions: 2 }, place, look([0.6, 0.5, 0.4], 0.4, 4.0), Shading::Gouraud),
        thing(Cuboid::new(0.8, 0.8, 0.8), at(0.5, 0.0, -1.0), look([0.3, 0.6, 0.7], 0.5, 10.0), Shading::Gouraud),
    ];
    let lamps = vec![
        Lamp { attenuation: [0.3, 0.05, 0.03], ..lamp(bulb(-0.8, 1.2, -0.5), [1.0, 0.95, 0.8]) },
        lamp(sun(0.3, -1.0, -0.6), [0.2, 0.2, 0.3]),
    ];
    Task { target: Vec3::new(0.0, -0.3, -2.0), fov: 1.0, ..task("road", Vec3::new(0.2, 0.6, 1.8), things, lamps) }
}

/// A pipe whose inside is not shown, with broad highlights of lights beside and behind it.
fn pipe() -> Task {
    let place = Mat4::from_rotation_x(0.9) * Mat4::from_rotation_z(0.4);
    let pipe = Cylinder { radius: 0.8, height: 1.8, capped: false };
    let pipe = pipe.mesh(Tessellation::Count { rows: 4, columns: 18 }).expect("a valid cylinder");
    let things = vec![
        thing(pipe, place, look([0.5, 0.4, 0.6], 0.8, 3.0), Shading::Phong),
        thing(UvSphere::new(0.5, 16, 8), at(1.2, 0.6, 0.0), look([0.5, 0.5, 0.3], 0.7, 2.0), Shading::Gouraud),
    ];
    let lamps = vec![
        lamp(bulb(2.5, 0.5, -1.5), [0.9, 0.9, 0.8]),
        Lamp { attenuation: [0.8, 0.1, 0.0], ..lamp(bulb(-2.0, 2.5, 0.5), [0.5, 0.6, 0.8]) },
    ];
    task("pipe", Vec3::new(0.5, 1.5, 3.4), things, lamps)
}

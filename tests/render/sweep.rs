//! Random scenes: ordinary ones against the evaluator, wild ones for numbers that are not numbers.

use std::f32::consts::{FRAC_PI_2, PI};

use crate::render::compare::{Bars, FLOAT, Failures};
use crate::render::random::Random;
use crate::render::scene::{Lamp, Scene, Thing};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
const REFLECTANCES: [Reflectance; 3] = [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];
const FACES: [Faces; 3] = [Faces::Front, Faces::Back, Faces::Both];

fn colour(mut channel: impl FnMut() -> f32) -> LinearRgba {
    LinearRgba::rgb(channel(), channel(), channel())
}

/// A scene as one would make it: colours to 1, distances of a few units.
fn ordinary(random: &mut Random) -> Scene {
    let mut scene = Scene::seen_from(random.direction() * random.between(3.0, 5.0), Vec3::ZERO);
    scene.ambient = colour(|| random.between(0.0, 0.3));
    scene.camera.background = colour(|| random.between(0.0, 0.3));
    scene.camera.viewer = random.pick(&[Viewer::Local, Viewer::Infinite]);
    scene.view_shading = Some(random.pick(&SHADINGS));
    for _ in 0..=random.below(3) {
        scene.things.push(ordinary_thing(random));
    }
    for _ in 0..random.below(5) {
        scene.lamps.push(ordinary_lamp(random));
    }
    scene
}

fn ordinary_material(random: &mut Random) -> Material {
    Material {
        ambient: colour(|| random.unit()),
        diffuse: colour(|| random.unit()),
        specular: colour(|| random.unit()),
        emission: colour(|| random.between(0.0, 0.1)),
        shininess: if random.chance(0.3) { 16.0 } else { random.between(0.5, 60.0) },
        opacity: random.unit(),
    }
}

fn ordinary_thing(random: &mut Random) -> Thing {
    let mesh = match random.below(4) {
        0 => Mesh::from(UvSphere::new(1.0, 10, 6)),
        1 => Mesh::from(Cuboid::new(1.5, 1.0, 0.7)),
        2 => Mesh::from(Plane { size: 3.0, divisions: 3 }),
        _ => hemisphere(10, 6),
    };
    let scale = Vec3::new(random.between(0.4, 1.3), random.between(0.4, 1.3), random.between(0.4, 1.3));
    let mirror = Vec3::new(random.pick(&[1.0, -1.0]), random.pick(&[1.0, -1.0]), 1.0);
    let transform = Transform::from_translation(random.direction() * random.between(0.0, 1.0))
        .with_rotation(Quat::from_rotation_arc(Vec3::Y, random.direction()))
        .with_scale(scale * mirror);
    let mut thing = Thing::new(mesh).at(transform).of(ordinary_material(random)).faces(random.pick(&FACES));
    thing.back = random.chance(0.5).then(|| ordinary_material(random));
    thing.reflectance = Some(random.pick(&REFLECTANCES));
    let frequencies = [Frequency::Never, Frequency::Vertex, Frequency::Fragment];
    match random.below(4) {
        0 => thing.shaded(random.pick(&SHADINGS)),
        1 => thing.terms(random.pick(&frequencies), random.pick(&frequencies)),
        // The view's shading.
        _ => thing,
    }
}

fn ordinary_lamp(random: &mut Random) -> Lamp {
    let light = PointLight {
        ambient: colour(|| random.between(0.0, 0.1)),
        diffuse: colour(|| random.unit()),
        specular: colour(|| random.unit()),
        attenuation: Attenuation::new(random.unit() + 0.1, random.between(0.0, 0.3), random.between(0.0, 0.1)),
        range: random.chance(0.3).then(|| random.between(4.0, 9.0)),
        attenuate_ambient: random.chance(0.4),
    };
    // Outside of everything, so that no surface is in its steep vicinity.
    let at = random.direction() * random.between(2.5, 4.0);
    match random.below(3) {
        0 => Lamp::directional(
            DirectionalLight { ambient: light.ambient, diffuse: light.diffuse, specular: light.specular },
            -at,
        ),
        1 => Lamp::point(light, at),
        _ => {
            let cutoff = random.between(0.3, FRAC_PI_2);
            let inner = random.chance(0.5).then(|| cutoff * random.unit());
            Lamp::spot(SpotLight { light, cone: Cone { cutoff, inner, exponent: random.between(0.0, 8.0) } }, at, -at)
        }
    }
}

#[test]
fn random_ordinary_scenes_are_what_the_equations_say() {
    let mut stage = Stage::new(24, 24);
    let mut failures = Failures::default();
    let mut shown = 0;
    for seed in 0..48 {
        let scene = ordinary(&mut Random(seed));
        let picture = stage.draw(&scene);
        // A scene of which only its back is seen may be empty; few are.
        shown += usize::from(picture.pixels().any(|pixel| pixel.0[0] != picture.get_pixel(0, 0).0[0]));
        failures.compare_any(&format!("seed {seed}"), &scene, &picture, FLOAT);
    }
    failures.finish();
    assert!(shown > 36, "only {shown} of 48 scenes show anything");
}

/// 0, or 10^x with x in −8 … 8, as colours, constants, exponents and lengths may be.
fn wild(random: &mut Random) -> f32 {
    if random.chance(0.1) { 0.0 } else { random.magnitude() }
}

fn wild_material(random: &mut Random) -> Material {
    Material {
        ambient: colour(|| wild(random)),
        diffuse: colour(|| wild(random)),
        specular: colour(|| wild(random)),
        emission: colour(|| wild(random)),
        shininess: wild(random),
        opacity: random.unit(),
    }
}

/// The largest number that a field may hold, at times.
fn extreme(random: &mut Random, largest: f32) -> f32 {
    if random.chance(0.1) { largest } else { wild(random) }
}

fn wild_lamp(random: &mut Random, size: f32) -> Lamp {
    let light = PointLight {
        ambient: colour(|| extreme(random, 1e12)),
        diffuse: colour(|| extreme(random, 1e12)),
        specular: colour(|| extreme(random, 1e12)),
        attenuation: Attenuation::new(wild(random), wild(random), wild(random) + 1e-8),
        range: random.chance(0.3).then(|| random.magnitude()),
        attenuate_ambient: random.chance(0.3),
    };
    let at = random.direction() * if random.chance(0.5) { size } else { wild(random) };
    let along = random.direction();
    match random.below(3) {
        0 => Lamp::directional(
            DirectionalLight { ambient: light.ambient, diffuse: light.diffuse, specular: light.specular },
            along,
        ),
        1 => Lamp::point(light, at),
        _ => {
            let cutoff = random.pick(&[0.0, 1e-4, 0.1, 0.7, FRAC_PI_2, PI]);
            let inner = random.chance(0.5).then(|| cutoff * random.pick(&[0.0, 0.5, 1.0]));
            Lamp::spot(SpotLight { light, cone: Cone { cutoff, inner, exponent: wild(random) } }, at, along)
        }
    }
}

/// A grid of objects of one size in the world, each with its own wild material and transform.
fn wild_scene(random: &mut Random) -> Scene {
    let size = random.magnitude();
    let mut scene = Scene::seen_from(Vec3::Z * 4.0 * size, Vec3::ZERO);
    scene.camera.near = 0.1 * size;
    scene.ambient = colour(|| wild(random));
    scene.camera.viewer = random.pick(&[Viewer::Local, Viewer::Infinite]);
    let (faces, reflectance) = (random.pick(&FACES), random.pick(&REFLECTANCES));
    let shading = random.pick(&SHADINGS);
    for i in 0..9 {
        let at = Vec3::new((i % 3) as f32 - 1.0, (i / 3) as f32 - 1.0, random.between(-1.0, 1.0));
        let mut axis = || 0.4 * size * if random.chance(0.3) { random.magnitude().min(2.0) } else { 1.0 };
        let scale = Vec3::new(axis(), axis(), -axis());
        let mesh = if random.chance(0.5) { hemisphere(6, 4) } else { Mesh::from(Plane { size: 2.0, divisions: 1 }) };
        let transform = Transform::from_translation(at * size)
            .with_rotation(Quat::from_rotation_arc(Vec3::Y, random.direction()))
            .with_scale(scale);
        let thing = Thing::new(mesh).at(transform).of(wild_material(random)).faces(faces).shaded(shading);
        scene.things.push(thing.reflecting(reflectance));
    }
    // More than eight, which share their pipelines: this sweeps numbers, not variants.
    for _ in 0..9 + random.below(4) {
        scene.lamps.push(wild_lamp(random, size));
    }
    scene
}

#[test]
fn no_wild_scene_holds_anything_but_numbers() {
    let mut stage = Stage::new(24, 24);
    let mut failures = Failures::default();
    let mut shown = 0;
    // Each scene is a pipeline or more of its own, which a software adapter takes seconds to compile the first time.
    for seed in 0..48 {
        let scene = wild_scene(&mut Random(1_000_000 + seed));
        let picture = stage.draw(&scene);
        shown += usize::from(picture.pixels().any(|pixel| pixel.0[0] > 0.0));
        if let Some((x, y, pixel)) =
            picture.enumerate_pixels().find(|(.., pixel)| !pixel.0.iter().all(|v| v.is_finite() && *v >= 0.0))
        {
            failures.unless(false, || format!("seed {seed}: pixel ({x}, {y}) is {:?}", pixel.0));
        }
    }
    failures.finish();
    assert!(shown > 32, "only {shown} of 48 scenes show anything");
}

#[test]
fn wild_scenes_of_gentle_exponents_are_what_the_equations_say() {
    // Colours and sizes over sixteen orders of magnitude, but exponents that do not multiply rounding.
    let mut stage = Stage::new(16, 16);
    let mut failures = Failures::default();
    for seed in 0..40 {
        let random = &mut Random(2_000_000 + seed);
        let size = random.magnitude();
        let light = |random: &mut Random| PointLight {
            attenuation: Attenuation::new(0.3, 0.5 / size, 0.2 / size / size),
            ..PointLight::from_color(colour(|| random.magnitude()))
        };
        let mut scene = Scene::seen_from(random.direction() * 3.0 * size, Vec3::ZERO);
        scene.camera.near = 0.1 * size;
        let material = Material { shininess: random.between(1.0, 30.0), ..wild_material(random) };
        let sphere = Thing::new(UvSphere::new(1.0, 10, 6)).at(Transform::from_scale(Vec3::splat(size)));
        let scene = scene
            .with(sphere.of(material).shaded(random.pick(&SHADINGS)).reflecting(random.pick(&REFLECTANCES)))
            .lit(Lamp::point(light(random), random.direction() * 3.0 * size))
            .lit(Lamp::point(light(random), random.direction() * 2.0 * size));
        let bars = Bars { most: 5e-4, worst: FLOAT.worst };
        failures.compare_any(&format!("seed {seed}"), &scene, &stage.draw(&scene), bars);
    }
    failures.finish();
}

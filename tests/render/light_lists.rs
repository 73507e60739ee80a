//! Lists of many lights: each patch gets those that reach it, and omitted light does not show.

use crate::render::compare::{FLOAT, Failures, SELECTED, SRGB, difference};
use crate::render::random::between;
use crate::render::scene::{Lamp, Scene, Thing, material, other_material, rotated};
use crate::render::stage::Stage;
use fastrand::Rng;
use halfway::lighting::Frequency;
use halfway::lighting::bounds::{STEP, linear_tolerance};
use halfway::prelude::*;

/// The most that the stage leaves out.
const HALF_A_STEP: f64 = 0.5 * STEP;

/// A camera straight above, so that every patch of a floor about the origin with this edge shows.
fn above(size: f32) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, size, 0.01 * size), Vec3::ZERO);
    scene.camera.projection = Projection::perspective(1.2);
    scene
}

/// A light of this brightness with a range.
fn ranged(brightness: f32, range: f32) -> PointLight {
    let colour = LinearRgba::rgb(brightness, 0.8 * brightness, 0.6 * brightness);
    PointLight { range: Some(range), attenuation: Attenuation::new(1.0, 0.1, 0.3), ..PointLight::new(colour) }
}

/// A rough floor with balls on it, and `count` lights of all kinds over it.
fn hall(count: usize, shading: Shading) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 9.0, 16.0), Vec3::new(0.0, 0.0, -1.0)).ambient(0.05);
    scene.view_shading = Some(shading);
    scene = scene.with(Thing::new(Plane { size: 24.0, divisions: 48 }));
    for i in 0..6 {
        let at = Vec3::new((i % 3) as f32 * 6.0 - 6.0, 1.0, (i / 3) as f32 * 7.0 - 5.0);
        let turned = rotated(0.2 * i as f32, 0.5, 0.0).with_translation(at);
        scene = scene.with(Thing::new(UvSphere::new(1.0, 32, 24)).at(turned));
    }
    let mut random = Rng::with_seed(count as u64);
    for i in 0..count {
        let at = Vec3::new(
            between(&mut random, -12.0, 12.0),
            between(&mut random, 0.5, 3.0),
            between(&mut random, -12.0, 12.0),
        );
        let down = Vec3::new(between(&mut random, -0.5, 0.5), -1.0, between(&mut random, -0.5, 0.5));
        let light = ranged(between(&mut random, 0.2, 0.8), between(&mut random, 2.0, 6.0));
        scene.lamps.push(match i % 4 {
            0 | 1 => Lamp::point(light, at),
            2 => Lamp::spot(SpotLight { light, cone: Cone { cutoff: 0.9, inner: Some(0.3), exponent: 1.0 } }, at, down),
            _ => {
                // Without a range: dim, and everywhere.
                let share = 2.0 / count as f32;
                Lamp::point(PointLight { range: None, ..ranged(share, 1.0) }, at)
            }
        });
    }
    let share = 0.5 / count as f32;
    let sky = DirectionalLight::new(LinearRgba::rgb(share, share, share));
    scene.lit(Lamp::directional(sky, Vec3::new(0.2, -1.0, 0.1)))
}

#[test]
fn lists_change_no_picture_by_more_than_a_step() {
    let mut stage = Stage::new(72, 48);
    let mut failures = Failures::default();
    for count in [12, 60, 200] {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            let row = format!("{count} lights, {shading:?}");
            let scene = hall(count, shading);
            let of_floats = failures.draw(&row, &mut stage, &scene, FLOAT);
            failures.unless(stage.report().left_out == 0.0, || format!("{row}: left out of floats"));
            println!("{row}: {of_floats}; {} terms assigned", stage.report().lights_assigned);
            for (encoding, bars) in [(Encoding::Raw, SELECTED), (Encoding::Srgb, SRGB)] {
                stage.encode(encoding);
                let row = format!("{row}, {encoding:?} bytes");
                let picture = stage.bytes();
                let FrameReport { left_out, lights_assigned, .. } = *stage.report();
                let verdict = failures.compare_bytes(&row, &mut stage, &picture, bars);
                println!("{row}: {verdict}; {lights_assigned} terms assigned, {left_out:.1e} left out");
                // The omitted light is added to the dimmest material's ambient at least, and to white at most.
                let ambient = &scene.things[0].material.ambient;
                let known = [ambient.red, ambient.green, ambient.blue].map(|ka| 0.05 * f64::from(ka) + 0.03);
                let most = known.map(|known| linear_tolerance(encoding, HALF_A_STEP, known));
                let most = most.into_iter().fold(0.0, f64::max);
                failures.unless(left_out <= most, || format!("{row}: {left_out} left out, over {most}"));
            }
        }
    }
    failures.finish();
}

/// A light for each sixteen units of a square floor, the floor in cells of one unit. Its edge is a power of two, so
/// that all patches are four by eight cells whatever its size.
fn field(size: u32, material: Material) -> Scene {
    let floor = Thing::new(Plane { size: size as f32, divisions: size }).with_material(material).shaded(Shading::Phong);
    let mut scene = above(size as f32).with(floor);
    let mut random = Rng::with_seed(7);
    for _ in 0..size * size / 16 {
        let half = 0.5 * size as f32;
        let at = Vec3::new(between(&mut random, -half, half), 1.0, between(&mut random, -half, half));
        scene.lamps.push(Lamp::point(ranged(0.5, 3.0), at));
    }
    scene
}

#[test]
fn lists_grow_with_the_patches_in_reach_of_lights() {
    let mut stage = Stage::new(32, 32);
    let matte = Material::matte(LinearRgba::rgb(0.7, 0.6, 0.5));
    let mut of_each = |size: u32, pixels| {
        stage.set(&field(size, matte));
        stage.pixels(pixels);
        let FrameReport { errors, lights, lights_assigned, light_pairs, patches, patches_culled, left_out, .. } =
            stage.frame().clone();
        assert_eq!((errors, patches, patches_culled, lights), (vec![], size * size / 32, 0, size * size / 16));
        let of_each = lights_assigned as f64 / f64::from(lights);
        println!("{lights} lights, {pixels:?}: {of_each:.2} terms each in {patches} patches, {left_out:.1e} left out");
        let most = linear_tolerance(Encoding::Srgb, HALF_A_STEP, 0.0);
        assert!(left_out <= if pixels == Pixels::Float { 0.0 } else { most }, "{lights}: {left_out} left out");
        // Of each light those patches that lie in a square with one that it reaches, of 32 or, where the curve
        // turns, 64.
        let looked_at = light_pairs as f64 / f64::from(lights);
        println!("{looked_at:.1} pairs each are looked at");
        assert!(looked_at < 200.0, "{looked_at} pairs each are looked at");
        of_each
    };
    for pixels in [Pixels::Float, Pixels::Byte] {
        // 1,024 lights and 16,384, and half as many patches.
        let [few, many] = [128, 512].map(|size| of_each(size, pixels));
        // Of the smaller floor a share of 4·3/128 is within a range of the border, where a light loses up to half of
        // what it would touch, of the larger one 4·3/512: 3.5 % more at most, and as much again for chance.
        assert!((0.93..1.07).contains(&(many / few)), "{pixels:?}: {few} terms a light, then {many}");
        // A light one unit above the floor reaches a disk of radius √(3² − 1²) in it, and with the spheres around
        // patches, of radius √20, one of √8 + √20: (√8 + √20)²π of area, a patch each 32.
        let reached = (8f64.sqrt() + 20f64.sqrt()).powi(2) * std::f64::consts::PI / 32.0;
        assert!(many < reached * 1.05, "{pixels:?}: {many} terms a light");
    }
}

#[test]
fn highlights_are_listed_where_they_can_be_seen() {
    // Each patch covers enough pixels to have a list of its own.
    let mut stage = Stage::new(512, 512);
    let glossy = Material { shininess: 200.0, ..Material::matte(LinearRgba::rgb(0.5, 0.5, 0.5)) };
    let glossy = Material { specular: LinearRgba::rgb(0.5, 0.5, 0.5), ..glossy };
    for (mesh, row) in
        [(Plane { size: 40.0, divisions: 64 }, "in patches"), (Plane { size: 1.0, divisions: 1 }, "whole")]
    {
        let mut scene = above(40.0).with(Thing::new(mesh).with_material(glossy).shaded(Shading::Phong));
        let mut random = Rng::with_seed(3);
        for _ in 0..100 {
            // Low and far out: halfway vectors lean by 30° and more over the most of the floor.
            let around = between(&mut random, 0.0, std::f32::consts::TAU);
            let at = Vec3::new(60.0 * around.cos(), 8.0, 60.0 * around.sin());
            let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::new(LinearRgba::gray(0.1)) };
            scene.lamps.push(Lamp::point(light, at));
        }
        stage.draw_bytes(&scene);
        let FrameReport { patches, lights_assigned, left_out, .. } = *stage.report();
        let all = 100 * u64::from(patches.max(1));
        println!("{row}: {lights_assigned} terms, {all} pairs of lights and patches, {left_out:.1e} left out");
        // The diffuse terms are all there, and hardly a specular one.
        assert!((0.9..1.1).contains(&(lights_assigned as f64 / all as f64)), "{row}: {lights_assigned} of {all}");
    }
}

/// A small floor in one piece, seen from straight above. Of the low lamps far around it no highlight can be seen, of
/// those overhead every highlight.
fn small_floor(low: impl Iterator<Item = Lamp>, overhead: impl Iterator<Item = Lamp>, shininess: f32) -> Scene {
    let grey = LinearRgba::gray(0.5);
    let glossy = Material { specular: grey, shininess, ..Material::matte(grey) };
    let floor = Thing::new(Plane { size: 1.0, divisions: 1 }).with_material(glossy).reflecting(Reflectance::BlinnPhong);
    let mut scene = above(40.0).with(floor);
    scene.lamps.extend(low.chain(overhead));
    scene
}

/// This many positions, low and far out.
fn around(count: usize) -> impl Iterator<Item = Vec3> {
    let turn = move |i| i as f32 / count as f32 * std::f32::consts::TAU;
    (0..count).map(turn).map(|angle| Vec3::new(60.0 * angle.cos(), 8.0, 60.0 * angle.sin()))
}

const fn mixed(diffuse: Frequency, specular: Frequency) -> Shading {
    Shading::Terms(Terms { diffuse, specular })
}

/// A light that all of a floor gets.
fn dim() -> PointLight {
    PointLight { attenuation: Attenuation::NONE, ..PointLight::new(LinearRgba::gray(0.1)) }
}

#[test]
fn highlights_that_cannot_be_seen_are_not_shaded() {
    let point: fn(Vec3) -> Lamp = |at| Lamp::point(dim(), at);
    let spot: fn(Vec3) -> Lamp = |at| Lamp::spot(SpotLight { light: dim(), cone: Cone::new(0.5) }, at, -at);
    let rows = [
        ("none", (24, point), (0, point), 200.0),
        ("a few", (22, point), (2, point), 200.0),
        ("half", (12, point), (12, point), 200.0),
        ("over half", (13, point), (16, point), 200.0),
        ("a few of the spots", (12, spot), (4, spot), 200.0),
        ("all of the spots, none of the points", (16, point), (2, spot), 200.0),
        ("a power of two", (24, point), (0, point), 256.0),
    ];
    let frequencies = [
        ("flat", Shading::Flat),
        ("at vertices", Shading::Gouraud),
        ("at fragments", Shading::Phong),
        ("highlights at fragments", mixed(Frequency::Vertex, Frequency::Fragment)),
        ("highlights at vertices", mixed(Frequency::Fragment, Frequency::Vertex)),
    ];
    let mut stage = Stage::new(32, 32);
    for (row, (low, low_kind), (overhead, overhead_kind), shininess) in rows {
        for (frequency, shading) in frequencies {
            let overhead_places = (0..overhead).map(|i| Vec3::new(0.1 * i as f32, 20.0, 0.0));
            let mut scene = small_floor(around(low).map(low_kind), overhead_places.map(overhead_kind), shininess);
            let floor = &mut scene.things[0];
            floor.shading = Some(shading);
            stage.draw_bytes(&scene);
            let needed = (low + 2 * overhead) as u64;
            assert_eq!(stage.report().lights_assigned, needed, "{row}, {frequency}");
        }
    }
}

#[test]
fn highlights_left_out_change_no_picture() {
    let mut failures = Failures::default();
    let rows = [
        ("at vertices", Shading::Gouraud, 0.0),
        ("at fragments", Shading::Phong, 0.0),
        ("highlights at fragments", mixed(Frequency::Vertex, Frequency::Fragment), 0.0),
        ("highlights at vertices", mixed(Frequency::Fragment, Frequency::Vertex), 0.0),
        ("the back of the floor", Shading::Phong, std::f32::consts::PI),
    ];
    for (row, shading, turn) in rows {
        // A stage for all would run out of pipelines of their own.
        let mut stage = Stage::new(72, 48);
        let mut scene = hall(24, shading);
        scene.lamps.extend(around(12).map(|at| Lamp::point(dim(), at)));
        for thing in &mut scene.things {
            *thing = thing.clone().with_material(Material { shininess: 120.5, ..material() });
            *thing = thing.clone().back(Material { shininess: 120.5, ..other_material() }).faces(Faces::Both);
            thing.shading = Some(shading);
        }
        scene.things[0].frames = vec![rotated(turn, 0.0, 0.0)];
        failures.draw(row, &mut stage, &scene, FLOAT);
        for (encoding, bars) in [(Encoding::Raw, SELECTED), (Encoding::Srgb, SRGB)] {
            stage.encode(encoding);
            let picture = stage.bytes();
            let verdict = failures.compare_bytes(&format!("{row}, {encoding:?} bytes"), &mut stage, &picture, bars);
            println!("{row}, {encoding:?} bytes: {verdict}; {} terms listed", stage.report().lights_assigned);
        }
    }
    failures.finish();
}

#[test]
fn lights_that_cannot_reach_are_not_assigned() {
    let mut stage = Stage::new(32, 32);
    for divisions in [1, 64] {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            let floor = Plane { size: 20.0, divisions };
            let mut scene = above(20.0).with(Thing::new(floor).shaded(shading));
            let mut random = Rng::with_seed(11);
            let mut places = || {
                let mut place = || {
                    Vec3::new(
                        between(&mut random, -8.0, 8.0),
                        between(&mut random, 4.0, 6.0),
                        between(&mut random, -8.0, 8.0),
                    )
                };
                [(); 12].map(|()| place())
            };
            scene.lamps.extend(places().map(|at| Lamp::point(ranged(0.4, 30.0), at)));
            let picture = stage.draw(&scene);
            let FrameReport { lights_assigned: assigned, light_pairs: pairs, .. } = *stage.report();
            assert!(assigned > 0);
            let aside: [(&str, fn(Vec3) -> Lamp); 4] = [
                ("lights behind the plane", |at| Lamp::point(ranged(0.4, 30.0), at.with_y(-at.y))),
                ("suns from below", |at| Lamp::directional(DirectionalLight::white(), at)),
                ("lights out of range", |at| Lamp::point(ranged(0.4, 3.0), at)),
                ("spots that point away", |at| {
                    Lamp::spot(SpotLight { light: ranged(0.4, 30.0), cone: Cone::new(0.6) }, at, Vec3::Y)
                }),
            ];
            // The bounding sphere of an undivided floor contains these lights, and lights inside it may reach any
            // point.
            for (row, lamp) in &aside[..if divisions == 1 { 3 } else { 4 }] {
                let mut more = scene.clone();
                more.lamps.extend(places().map(lamp));
                let with = stage.draw(&more);
                let report = stage.report();
                let named = format!("{row}, {} patches, {shading:?}", report.patches);
                assert_eq!((report.lights, report.lights_assigned), (24, assigned), "{named}");
                // Few lights out of range are evaluated, except for an undivided floor: boxes contain the spheres
                // around patches, which some of these lights reach.
                if *row == "lights out of range" && divisions > 1 {
                    assert!(report.light_pairs < pairs + pairs / 8, "{named}: {} of {pairs}", report.light_pairs);
                }
                // A scene with suns has shaders of its own, which round otherwise.
                let most = difference(&picture, &with);
                assert!(most < 1e-6, "{named}: {most}");
            }
        }
    }
}

#[test]
fn lights_beyond_the_reach_of_squares_keep_their_direction() {
    let mut stage = Stage::new(48, 48);
    let mut scene = Scene::seen_from(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO).with(Thing::new(UvSphere::new(1.0, 32, 16)));
    let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::new(LinearRgba::rgb(0.1, 0.08, 0.06)) };
    // More than are compiled in.
    for _ in 0..9 {
        scene = scene.lit(Lamp::point(light, Vec3::new(0.3, 0.5, 0.8) * 1e38));
    }
    let mut failures = Failures::default();
    failures.draw("far lights", &mut stage, &scene, FLOAT);
    failures.finish();
}

#[test]
fn lights_are_kept_from_frame_to_frame_until_something_changes() {
    let mut stage = Stage::new(48, 32);
    stage.set(&hall(12, Shading::Phong));
    let mut before = stage.float();
    let first = |world: &mut World| {
        let mut lights = world.query_filtered::<Entity, With<PointLight>>();
        lights.iter(world).min().expect("there are some")
    };
    let changes: [(&str, fn(&mut World, Entity)); 10] = [
        ("the camera moves", |world, _| {
            let mut cameras = world.query_filtered::<&mut Transform, With<Camera>>();
            cameras.single_mut(world).expect("one").translation.x += 1.0;
        }),
        ("one moves", |world, light| world.get_mut::<Transform>(light).expect("it has one").translation.y += 0.5),
        ("one shines brighter", |world, light| {
            world.get_mut::<PointLight>(light).expect("it is one").diffuse = LinearRgba::WHITE;
        }),
        ("one is hidden", |world, light| {
            world.entity_mut(light).insert(Visibility::Hidden);
        }),
        ("it is shown again", |world, light| {
            world.entity_mut(light).insert(Visibility::Visible);
        }),
        ("more ambient light", |world, _| world.resource_mut::<GlobalAmbient>().0 = LinearRgba::gray(0.2)),
        ("one is gone, and another comes", |world, light| {
            world.despawn(light);
            world.spawn((PointLight::white(), Transform::from_xyz(1.0, 2.0, 3.0)));
        }),
        ("one is no light any more", |world, light| {
            world.entity_mut(light).remove::<PointLight>();
        }),
        ("all spots open", |world, _| {
            let mut spots = world.query::<&mut SpotLight>();
            spots.iter_mut(world).for_each(|mut spot| spot.cone = Cone::new(std::f32::consts::PI));
        }),
        ("one is gone", |world, light| {
            world.despawn(light);
        }),
    ];
    for (row, change) in changes {
        let light = first(stage.world());
        change(stage.world(), light);
        let kept = stage.float();
        assert!(difference(&before, &kept) > 0.0, "{row}: nothing changes");
        let world = stage.world();
        let mut lights = world.query_filtered::<&mut GlobalTransform, Or<(With<PointLight>, With<SpotLight>)>>();
        lights.iter_mut(world).for_each(|mut at| at.set_changed());
        assert_eq!(difference(&kept, &stage.float()), 0.0, "{row}: taken up again they are others");
        before = kept;
    }
}

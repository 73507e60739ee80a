//! Every variant of the shader builds and draws.

use crate::render::compare::{FLOAT, Failures};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use fastrand::Rng;
use halfway::lighting::Frequency;
use halfway::prelude::*;
use std::ops::Range;

/// The choices that decide a pipeline, each by its number of choices.
const FACTORS: [(&str, usize); 12] = [
    ("shading", 5),
    ("reflectance", 3),
    ("specular", 3),
    ("viewer", 2),
    ("faces", 3),
    ("blend", 2),
    ("mirrored", 2),
    ("samples", 2),
    ("target", 3),
    ("lights", 7),
    ("attenuated ambient", 2),
    ("mesh", 2),
];

type Choice = [usize; FACTORS.len()];

/// Every set of three factors with every combination of their choices, in as few rows as a greedy search finds.
fn covering_triples() -> Vec<Choice> {
    let count = FACTORS.len();
    let triples: Vec<[usize; 3]> =
        (0..count).flat_map(|a| (a + 1..count).flat_map(move |b| (b + 1..count).map(move |c| [a, b, c]))).collect();
    let code = |row: &Choice, [a, b, c]: [usize; 3]| row[a] + 8 * row[b] + 64 * row[c];
    let mut open: Vec<Vec<bool>> = triples.iter().map(|_| vec![false; 512]).collect();
    let mut left = 0;
    for (triple, open) in triples.iter().zip(&mut open) {
        let [a, b, c] = triple.map(|factor| FACTORS[factor].1);
        for (i, j, k) in (0..a).flat_map(|i| (0..b).flat_map(move |j| (0..c).map(move |k| (i, j, k)))) {
            open[i + 8 * j + 64 * k] = true;
            left += 1;
        }
    }
    let mut random = Rng::with_seed(7);
    let mut rows = Vec::new();
    while left > 0 {
        // The best of a few random rows that cover at least one open combination.
        let seed =
            triples.iter().zip(&open).find_map(|(t, open)| open.iter().position(|open| *open).map(|at| (*t, at)));
        let Some((triple, at)) = seed else { break };
        let gain = |row: &Choice| triples.iter().zip(&open).filter(|(triple, open)| open[code(row, **triple)]).count();
        let candidate = |random: &mut Rng| {
            let mut row: Choice = FACTORS.map(|(_, choices)| random.usize(..choices));
            (row[triple[0]], row[triple[1]], row[triple[2]]) = (at % 8, at / 8 % 8, at / 64);
            row
        };
        let best = (0..24).map(|_| candidate(&mut random)).max_by_key(gain).expect("there are candidates");
        for (triple, open) in triples.iter().zip(&mut open) {
            left -= usize::from(std::mem::take(&mut open[code(&best, *triple)]));
        }
        rows.push(best);
    }
    rows
}

fn describe(choice: &Choice) -> String {
    let parts = FACTORS.iter().zip(choice).map(|((name, _), choice)| format!("{name} {choice}"));
    parts.collect::<Vec<_>>().join(", ")
}

fn thing(choice: &Choice) -> Thing {
    let [shading, reflectance, specular, _, faces, blend, mirrored, .., mesh] = *choice;
    let mut material = material();
    match specular {
        0 => material.specular = LinearRgba::BLACK,
        1 => material.shininess = 20.5,
        _ => material.shininess = 16.0,
    }
    // Normals that may cancel under interpolation need another variant.
    let (left, right) =
        if mesh == 0 { (Vec3::Z, Vec3::Z) } else { (Vec3::new(0.95, 0.0, 0.3), Vec3::new(-0.95, 0.0, 0.3)) };
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]].map(Vec3::from_array);
    let normals = Some(vec![left, right, right, left]);
    let mesh = Mesh::from_parts(corners.to_vec(), normals, None, vec![0, 1, 2, 0, 2, 3]).expect("a square");
    let faces = [Faces::Front, Faces::Back, Faces::Both][faces];
    // Turned to the camera by the side that is shown.
    let turn = if faces == Faces::Back { std::f32::consts::PI } else { 0.0 };
    let scale = Vec3::new(if mirrored == 1 { -2.0 } else { 2.0 }, 2.0, 1.0);
    let mut thing = Thing::new(mesh)
        .at(Transform::from_xyz(0.0, 0.0, -3.0).with_rotation(Quat::from_rotation_y(turn)).with_scale(scale))
        .with_material(material)
        .back(Material { specular: material.specular, shininess: material.shininess, ..other_material() })
        .faces(faces)
        .reflecting([Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched][reflectance]);
    thing.blend = blend == 1;
    thing.material.opacity = 0.75;
    match shading {
        0 => thing.shaded(Shading::Flat),
        1 => thing.shaded(Shading::Gouraud),
        2 => thing.shaded(Shading::Phong),
        3 => thing.terms(Frequency::Vertex, Frequency::Fragment),
        _ => thing.terms(Frequency::Fragment, Frequency::Vertex),
    }
}

fn scene(choice: &Choice) -> Scene {
    let [.., viewer, _, _, _, samples, target, lights, attenuated, _] =
        [choice[3], choice[4], choice[5], choice[6], choice[7], choice[8], choice[9], choice[10], choice[11]];
    let mut scene = Scene::in_eye_space().ambient(0.3).with(thing(choice));
    scene.camera.viewer = [Viewer::Local, Viewer::Infinite][viewer];
    scene.camera.samples = [Samples::One, Samples::Four][samples];
    scene.camera.encoding = [Encoding::Srgb, Encoding::Raw, Encoding::Srgb][target];
    let light = PointLight { attenuate_ambient: attenuated == 1, ..point_light() };
    let directional = Lamp::directional(directional_light(), Vec3::new(0.2, 0.1, -1.0));
    let point = Lamp::point(light, Vec3::X);
    let ranged = Lamp::point(PointLight { range: Some(20.0), ..light }, Vec3::Y);
    let spot = Lamp::spot(
        SpotLight { light, cone: Cone { cutoff: 0.8, inner: Some(0.3), exponent: 1.0 } },
        Vec3::Y * 0.5,
        Vec3::new(0.0, -0.1, -1.0),
    );
    let mixed = [directional.clone(), point.clone(), ranged.clone(), spot.clone()];
    scene.lamps = match lights {
        0 => vec![],
        1 => vec![directional],
        2 => vec![point],
        3 => vec![ranged],
        4 => vec![spot],
        5 => mixed.into_iter().cycle().take(9).collect(),
        _ => mixed.into_iter().cycle().take(129).collect(),
    };
    scene
}

#[test]
fn every_three_choices_that_decide_a_pipeline_build_and_draw() {
    let rows = covering_triples();
    let mut stage = Stage::new(8, 8);
    let mut wrong = Vec::new();
    for choice in &rows {
        stage.set(&scene(choice));
        let target = choice[8];
        stage.pixels(if target == 2 { Pixels::Float } else { Pixels::Byte });
        let shows = match stage.try_draw() {
            Ok(Picture::Byte(image)) => image.get_pixel(4, 4).0[..3].iter().all(|channel| *channel > 0),
            Ok(Picture::Float(image)) => image.get_pixel(4, 4).0[..3].iter().all(|v| v.is_finite() && *v > 0.0),
            Err(error) => {
                wrong.push(format!("{}: {error}", describe(choice)));
                continue;
            }
        };
        if !shows {
            wrong.push(format!("{}: shows nothing", describe(choice)));
        }
    }
    println!("{} rows cover every triple; {} pipelines", rows.len(), stage.report().pipelines);
    assert!(wrong.is_empty(), "{} of {} wrong:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
    assert!(stage.report().pipelines > 80, "only {} pipelines were built", stage.report().pipelines);
}

#[test]
fn a_bounded_cache_of_pipelines_draws_every_shading() {
    // 3 shadings, 2 reflectances, 2 viewers and 17 exponents of their own: 204 keys beside the other scenes'.
    let mut stage = Stage::new(12, 12);
    let mut failures = Failures::default();
    for exponent in 0..17 {
        for (shading, reflectance, viewer) in
            [Shading::Flat, Shading::Gouraud, Shading::Phong].into_iter().flat_map(|shading| {
                [Reflectance::Phong, Reflectance::BlinnPhong].into_iter().flat_map(move |reflectance| {
                    [Viewer::Local, Viewer::Infinite].map(|viewer| (shading, reflectance, viewer))
                })
            })
        {
            let shininess = f32::from(2_u16.saturating_pow(exponent)).max(1.0);
            let mut scene = Scene::in_eye_space()
                .ambient(0.2)
                .with(
                    Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 3.0)
                        .with_material(Material { shininess, ..material() })
                        .shaded(shading)
                        .reflecting(reflectance),
                )
                .lit(Lamp::point(point_light(), Vec3::new(0.3, 0.2, 0.0)))
                .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
            scene.camera.viewer = viewer;
            let row = format!("{shading:?}, {reflectance:?}, {viewer:?}, exponent {shininess}");
            failures.draw(&row, &mut stage, &scene, FLOAT);
            stage.frame();
        }
    }
    failures.finish();
    // Each got a specialised one: the first 128 at once, the others in their second frame, after the oldest were
    // evicted. Generic ones, for each of 12 stages, reflectances and viewers, drew their first frames.
    assert_eq!((stage.report().pipelines, stage.report().pipelines_live), (204 + 12, 128 + 12));
}

/// Squares side by side, each with a pipeline of its own.
fn squares(numbers: Range<u16>) -> Scene {
    let square = |i: u16| {
        let (x, y) = (f32::from(i % 16) - 7.5, f32::from(i / 16) - 4.5);
        let shininess = 2_f32.powi(i32::from(i / 12));
        Thing::square(Vec3::new(x, y, -20.0), Vec3::Z, 0.9)
            .with_material(Material { shininess, ..material() })
            .shaded([Shading::Flat, Shading::Gouraud, Shading::Phong][usize::from(i % 3)])
            .reflecting([Reflectance::Phong, Reflectance::BlinnPhong][usize::from(i / 3 % 2)])
            .faces([Faces::Front, Faces::Both][usize::from(i / 6 % 2)])
    };
    let mut scene = Scene::in_eye_space().ambient(0.2).lit(Lamp::point(point_light(), Vec3::new(0.3, 0.2, 0.0)));
    scene.things.extend(numbers.map(square));
    scene
}

/// The bound, as it is documented.
const MOST: u16 = 128;

/// A pipeline that N frames have not used makes room for another.
const KEPT: u32 = 60;

#[test]
fn a_frame_that_needs_more_than_the_bound_builds_them_once() {
    for compile in [Compile::Now, Compile::Beside] {
        let mut stage = Stage::new(96, 96);
        stage.world().insert_resource(compile);
        let row = format!("{compile:?}");
        let mut failures = Failures::default();
        failures.draw(&row, &mut stage, &squares(0..MOST + 22), FLOAT);
        failures.finish();
        // The last 22 are of all 12 kinds that generic ones are for.
        assert_eq!((stage.report().pipelines, stage.report().pipelines_live), (128 + 12, 128 + 12), "{row}");
        // Generic ones of the other kinds are built in advance too. 10 kinds have two squares, whose materials are
        // looked up: in the first frame only if it waits for these pipelines.
        stage.compile();
        let looking_up = if compile == Compile::Beside { 10 } else { 0 };
        for _ in 0..2 * KEPT {
            let report = stage.frame();
            let counts = (report.pipelines, report.pipelines_live, report.pipelines_pending, report.pipelines_awaited);
            assert_eq!(counts, (128 + 12 + looking_up, 128 + 12 + looking_up, 0, 0), "{row}");
        }
    }
}

#[test]
fn unused_pipelines_are_evicted_in_time() {
    let mut stage = Stage::new(96, 96);
    stage.draw(&squares(0..MOST));
    let mut failures = Failures::default();
    let others = squares(MOST..MOST + 22);
    for frame in 1..=KEPT {
        if frame == 1 {
            failures.draw("by generic ones", &mut stage, &others, FLOAT);
        } else {
            stage.frame();
        }
        let counts = (stage.report().pipelines, stage.report().pipelines_live);
        assert_eq!(counts, (128 + 12, 128 + 12), "frame {frame}");
    }
    let by_generic = stage.report().lights_assigned;
    assert!(by_generic > 0, "generic ones read lists");
    let picture = stage.float();
    failures.compare("by their own", &mut stage, &picture, FLOAT);
    failures.finish();
    let report = stage.report();
    assert_eq!((report.pipelines, report.pipelines_live, report.lights_assigned), (128 + 12 + 22, 128 + 12, 0));
    // Of those before, what has been given up has no other given up in its turn. Generic ones draw in its place, which
    // may look up records for other kinds now.
    stage.set(&squares(0..MOST));
    let first = stage.frame().clone();
    assert_eq!(first.pipelines - first.pipelines_live, 22);
    assert!((128..=128 + 2 * 12).contains(&first.pipelines_live), "{} pipelines", first.pipelines_live);
    for _ in 0..3 {
        let report = stage.frame();
        assert_eq!((report.pipelines, report.pipelines_live), (first.pipelines, first.pipelines_live));
    }
}

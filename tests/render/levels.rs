//! Levels of detail: fewer triangles where they do not show, and a picture that stays within the stated bounds.

use crate::render::compare::{Failures, assert_identical, difference};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, material, point_light, rotated};
use crate::render::stage::{FULL, Stage};
use halfway::mesh::{HeightField, Tessellation, Torus, tessellate};
use halfway::prelude::*;
use halfway::reference::{Image, Oracle};

fn sphere(segments: u32) -> Mesh {
    UvSphere::new(1.0, segments, segments / 2).into()
}

/// One thing at the origin, lit from two sides.
fn one(thing: Thing, distance: f32) -> Scene {
    Scene::seen_from(Vec3::new(0.2, 0.35, 0.9).normalize() * distance, Vec3::ZERO)
        .ambient(0.1)
        .with(thing)
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.6, -0.7, -1.0)))
        .lit(Lamp::point(point_light(), Vec3::new(-3.0, 2.0, 4.0)))
}

/// Triangles drawn of those that were modelled, once the levels are made.
fn triangles(stage: &mut Stage, scene: &Scene, levels: Tolerance) -> (u64, u64) {
    stage.set(scene);
    stage.levels(levels);
    (stage.report().triangles, stage.report().triangles_in)
}

#[test]
fn farther_spheres_are_drawn_with_fewer_triangles() {
    let mut stage = Stage::new(64, 64);
    for shading in [Shading::Gouraud, Shading::Phong, Shading::Auto] {
        let mut before = u64::MAX;
        for distance in [4.0, 16.0, 64.0] {
            let thing = Thing::new(sphere(256)).shaded(shading).faces(Faces::Both);
            let (drawn, modelled) = triangles(&mut stage, &one(thing, distance), Tolerance::DEFAULT);
            println!("{shading:?}, distance {distance}: {drawn} of {modelled} triangles");
            assert_eq!(modelled, 256 * 127 * 2);
            // A level of half the triangles is twice as far off: at four times the distance two levels more will do.
            assert!(drawn < before && drawn < modelled, "{shading:?}, distance {distance}: {drawn} after {before}");
            before = drawn;
        }
    }
}

/// Where no edge is longer than what is allowed, Phong shading has its terms at the corners as automatic shading does;
/// not with colors, and not of a mesh of one patch.
#[test]
fn phong_shading_goes_by_edges_as_automatic_shading_does() {
    let mut stage = Stage::new(64, 64);
    let mut drawn = |mesh: &Mesh, shading| {
        let scene = one(Thing::new(mesh.clone()).shaded(shading), 64.0);
        triangles(&mut stage, &scene, Tolerance { steps: 0.01, pixels: 0.5 }).0
    };
    let large = sphere(256);
    let colors = large.clone().with_colors(vec![Vec4::ONE; large.positions().len()]).expect("a color a vertex");
    let rows = [("large", large, true), ("colored", colors, false), ("of one patch", sphere(64), false)];
    for (row, mesh, goes) in rows {
        let [phong, auto] = [Shading::Phong, Shading::Auto].map(|shading| drawn(&mesh, shading));
        println!("{row}: {phong} and {auto} of {} triangles", mesh.triangle_count());
        assert_eq!(phong < mesh.triangle_count() as u64 / 8, goes, "{row}: {phong}");
        assert!(!goes || phong == auto, "{row}: {phong} and {auto}");
    }
}

#[test]
fn smaller_tolerances_keep_more_triangles() {
    let mut stage = Stage::new(64, 64);
    let scene = one(Thing::new(sphere(256)).shaded(Shading::Phong).faces(Faces::Both), 6.0);
    let mut drawn = |pixels, steps| triangles(&mut stage, &scene, Tolerance { steps, pixels }).0;
    let by_pixels = [4.0, 0.5, 0.05, 0.005, 0.0].map(|pixels| drawn(pixels, 255.0));
    println!("by pixels: {by_pixels:?}");
    assert!(by_pixels.is_sorted() && by_pixels[0] < by_pixels[2] && by_pixels[2] < by_pixels[4], "{by_pixels:?}");
    assert_eq!(by_pixels[4], 256 * 127 * 2, "a tolerance of 0");
    let by_shading = [255.0, 64.0, 16.0, 1.0, 0.0].map(|steps| drawn(4.0, steps));
    println!("by shading: {by_shading:?}");
    assert!(by_shading.is_sorted() && by_shading[0] < by_shading[4], "{by_shading:?}");
}

#[test]
fn switched_off_every_mesh_is_drawn_as_it_is() {
    let mut stage = Stage::new(64, 64);
    let scene = one(Thing::new(sphere(128)).shaded(Shading::Auto).faces(Faces::Both), 40.0);
    let plain = stage.draw(&scene);
    let (drawn, modelled) = triangles(&mut stage, &scene, Tolerance::DEFAULT);
    assert!(drawn < modelled / 4, "{drawn} of {modelled}");
    // Levels that have been made stay unused.
    let (drawn, modelled) = triangles(&mut stage, &scene, FULL);
    assert_eq!(drawn, modelled);
    assert_identical("off again", &plain, &stage.float());
}

#[test]
fn blended_and_stretched_objects_keep_all_triangles() {
    let rows: [(&str, Thing, bool); 5] = [
        ("plain", Thing::new(sphere(128)), false),
        ("scaled alike", Thing::new(sphere(128)).at(rotated(0.3, 0.4, 0.5).with_scale(Vec3::splat(1.7))), false),
        ("mirrored", Thing::new(sphere(128)).at(Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0))), false),
        ("blended", Thing::new(sphere(128)).blended(0.5), true),
        ("stretched", Thing::new(sphere(128)).at(Transform::from_scale(Vec3::new(1.0, 1.5, 1.0))), true),
    ];
    for (row, thing, all) in rows {
        let mut stage = Stage::new(48, 48);
        let blend = thing.blend;
        let (drawn, modelled) =
            triangles(&mut stage, &one(thing.faces(Faces::Both).shaded(Shading::Auto), 40.0), Tolerance::DEFAULT);
        // Blended ones are drawn twice, far sides first.
        let whole = if blend { 2 * modelled } else { modelled };
        assert!(if all { drawn == whole } else { drawn < modelled / 4 }, "{row}: {drawn} of {modelled}");
    }
}

#[test]
fn an_object_has_a_tolerance_of_its_own() {
    let mut stage = Stage::new(48, 48);
    stage.set(&one(Thing::new(sphere(128)).shaded(Shading::Auto).faces(Faces::Both), 40.0));
    stage.levels(Tolerance::DEFAULT);
    let (drawn, modelled) = (stage.report().triangles, stage.report().triangles_in);
    assert!(drawn < modelled / 4, "{drawn} of {modelled}");
    let world = stage.world();
    let object = world.query_filtered::<Entity, With<Mesh3d>>().single(world).expect("one object");
    world.entity_mut(object).insert(FULL);
    stage.frame();
    assert_eq!(stage.report().triangles, modelled);
    stage.world().entity_mut(object).remove::<Tolerance>();
    stage.frame();
    assert_eq!(stage.report().triangles, drawn);
}

#[test]
fn a_static_scene_uploads_nothing_once_its_levels_are_there() {
    let mut stage = Stage::new(48, 48);
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong, Shading::Auto] {
        stage.set(&one(Thing::new(sphere(128)).shaded(shading), 30.0));
        stage.levels(Tolerance::DEFAULT);
        let first = stage.float();
        for frame in 0..3 {
            let again = stage.float();
            let report = stage.report();
            assert_eq!((report.bytes_uploaded, report.levels_pending), (0, 0), "{shading:?}, frame {frame}");
            assert_identical(&format!("{shading:?}, frame {frame}"), &first, &again);
        }
    }
}

#[test]
fn a_changed_mesh_gets_levels_of_its_own() {
    let mut stage = Stage::new(48, 48);
    let (ball, teapot) = (sphere(128), Mesh::from(Teapot::new(16)));
    let scene = one(Thing::new(ball.clone()).shaded(Shading::Auto).faces(Faces::Both), 40.0);
    stage.set(&scene);
    stage.levels(Tolerance::DEFAULT);
    let of_ball = stage.float();
    let handle = stage.handle(&ball);
    stage.world().resource_mut::<Assets<Mesh>>().insert(handle.id(), teapot.clone()).expect("the handle is alive");
    // At once it is the new mesh as it is, and never the old one's level.
    let first = stage.float();
    assert_eq!(stage.report().triangles, teapot.triangle_count() as u64);
    assert!(stage.report().levels_pending > 0);
    assert!(difference(&of_ball, &first) > 0.1);
    stage.levels(Tolerance::DEFAULT);
    let (drawn, modelled) = (stage.report().triangles, stage.report().triangles_in);
    assert_eq!(modelled, teapot.triangle_count() as u64);
    assert!(drawn < modelled, "{drawn} of {modelled}");
    let changed = stage.float();
    let mut fresh = Stage::new(48, 48);
    fresh.set(&one(Thing::new(teapot).shaded(Shading::Auto).faces(Faces::Both), 40.0));
    fresh.levels(Tolerance::DEFAULT);
    assert_identical("as if it had always been the other mesh", &fresh.float(), &changed);
}

#[test]
fn a_picture_of_one_frame_never_waits() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let scene = one(Thing::new(sphere(128)).shaded(shading), 30.0);
        let plain = Stage::new(48, 48).draw(&scene);
        let mut stage = Stage::new(48, 48);
        stage.world().insert_resource(ViewTolerance::default());
        let picture = stage.draw(&scene);
        assert_identical(&format!("{shading:?}"), &plain, &picture);
    }
}

#[test]
fn the_second_frame_that_sees_a_mesh_has_its_levels() {
    let mut stage = Stage::new(48, 48);
    stage.world().insert_resource(ViewTolerance::default());
    let (scene, other) =
        (one(Thing::new(sphere(64)).shaded(Shading::Auto), 40.0), one(Thing::new(Cuboid::default()), 40.0));
    stage.set(&scene);
    stage.frame();
    let whole = stage.report().triangles_in;
    assert_eq!((stage.report().triangles, stage.report().levels_pending), (whole, 1));
    stage.set(&other);
    stage.frame();
    assert_eq!(stage.report().levels_pending, 0, "nobody waits for what is not seen");
    // Without a window, whatever the machine: recordings repeat.
    for _ in 0..2 {
        stage.set(&scene);
        stage.frame();
        assert!(stage.report().triangles < whole / 2, "{} of {whole} triangles", stage.report().triangles);
        assert_eq!(stage.report().levels_pending, 0);
    }
}

/// Objects that follow each other are looked at once where they are alike; which of them wants levels comes first.
#[test]
fn an_object_has_levels_beside_one_of_the_same_mesh_that_wants_none() {
    for exact in [0, 1] {
        let mut stage = Stage::new(48, 48);
        let thing = || Thing::new(sphere(64)).shaded(Shading::Auto);
        let scene = one(thing(), 40.0).with(thing().at(Transform::from_xyz(2.5, 0.0, 0.0)));
        let things = stage.set(&scene);
        stage.world().entity_mut(things[exact]).insert(FULL);
        stage.levels(Tolerance::DEFAULT);
        let (drawn, modelled) = (stage.report().triangles, stage.report().triangles_in);
        assert!(drawn > modelled / 2 && drawn < modelled * 3 / 4, "{exact}: {drawn} of {modelled}");
    }
}

#[test]
fn what_is_gone_is_not_waited_for() {
    let mut stage = Stage::new(48, 48);
    stage.world().insert_resource(ViewTolerance::default());
    stage.set(&one(Thing::new(sphere(64)), 4.0));
    stage.frame();
    // Its asset lives on, as the stage keeps its handle. It was seen in one frame, so that no levels are being made.
    stage.set(&one(Thing::new(Cuboid::default()), 4.0));
    stage.frame();
    assert_eq!(stage.report().levels_pending, 0);
}

/// Samples of the oracle along an edge of a pixel; odd, so that one is the pixel's centre.
const SAMPLES: u32 = 3;
const SIZE: u32 = 128;
/// What arithmetic in single precision may add.
const FLOAT_SLACK: f64 = 2e-4;
/// No colour that a lit object has.
const BACKGROUND: [f32; 3] = [0.0, 8.0, 0.0];

fn meshes() -> [(&'static str, Mesh, f32); 4] {
    let torus = Torus { radius: 0.75, tube: 0.25 };
    let torus = tessellate(&[&torus], Tessellation::Count { rows: 64, columns: 192 }).expect("a torus");
    let heights = |i: u32| {
        let [x, z] = [i % 129, i / 129].map(|k| k as f32 / 128.0 * 9.0);
        0.12 * (x.sin() * (1.3 * z).cos() + 0.4 * (2.1 * x + z).sin())
    };
    let field = HeightField::new(2.0, 2.0, 129, (0..129 * 129).map(heights).collect()).expect("a field");
    let field = tessellate(&[&field], Tessellation::Count { rows: 128, columns: 128 }).expect("a field");
    [
        ("sphere", UvSphere::new(1.0, 256, 128).into(), 1.0),
        ("teapot", Teapot::new(24).into(), 2.3),
        ("torus", torus, 1.0),
        ("height field", field, 1.1),
    ]
}

/// The default, and two that coarser patches meet of what is curved here more and there less.
const TOLERANCES: [Tolerance; 3] =
    [Tolerance::DEFAULT, Tolerance { steps: 16.0, pixels: 0.5 }, Tolerance { steps: 64.0, pixels: 0.5 }];

/// What the oracle shows near a pixel.
struct Near {
    low: [f64; 3],
    high: [f64; 3],
    covered: bool,
    bare: bool,
}

/// What the oracle shows within `reach` samples of the centre of a pixel.
fn near(fine: &Image, x: u32, y: u32, reach: i64) -> Near {
    let mut near = Near { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3], covered: true, bare: true };
    let covered = fine.covered().expect("the oracle knows what it covers");
    let edge = i64::from(SIZE * SAMPLES);
    let [x, y] = [x, y].map(|at| i64::from(SAMPLES * at + SAMPLES / 2));
    for (x, y) in (y - reach..=y + reach).flat_map(|y| (x - reach..=x + reach).map(move |x| (x, y))) {
        if x < 0 || y < 0 || x >= edge || y >= edge {
            // Who knows what is beyond the picture?
            (near.covered, near.bare) = (false, false);
            continue;
        }
        let is_covered = covered[(y * edge + x) as usize];
        near.covered &= is_covered;
        near.bare &= !is_covered;
        let pixel = fine.pixel(x as u32, y as u32);
        near.low = [0, 1, 2].map(|k| near.low[k].min(pixel[k]));
        near.high = [0, 1, 2].map(|k| near.high[k].max(pixel[k]));
    }
    near
}

/// Figures of one picture.
#[derive(Default)]
struct Figures {
    /// Differences from the oracle, in units of what is allowed without the surface's moving.
    plain: Vec<f64>,
    /// How far outside of what the oracle shows within two thirds of a pixel, and within one, in the same unit.
    excess: [Vec<f64>; 2],
    /// Background where the oracle is covered all about, and the other way round.
    holes: usize,
    specks: usize,
}

fn worst_and_most(errors: &mut [f64]) -> (f64, f64) {
    errors.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| errors.get(((errors.len() as f64 * share) as usize).min(errors.len().saturating_sub(1)));
    (at(1.0).copied().unwrap_or(0.0), at(0.999).copied().unwrap_or(0.0))
}

fn figures(picture: &Image, fine: &Image, allowed: [f64; 3]) -> Figures {
    let mut figures = Figures::default();
    let background = BACKGROUND.map(f64::from);
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let actual = picture.pixel(x, y);
        let within_one = near(fine, x, y, i64::from(SAMPLES));
        let is_bare = actual == background;
        figures.holes += usize::from(within_one.covered && is_bare);
        figures.specks += usize::from(within_one.bare && !is_bare);
        if !within_one.covered || is_bare {
            continue;
        }
        let centre = near(fine, x, y, 0);
        for k in 0..3 {
            figures.plain.push((actual[k] - centre.low[k]).abs() / allowed[k]);
            for (reach, excess) in [2, i64::from(SAMPLES)].into_iter().zip(&mut figures.excess) {
                let within = near(fine, x, y, reach);
                let outside = (within.low[k] - actual[k]).max(actual[k] - within.high[k]).max(0.0);
                excess.push(outside / allowed[k]);
            }
        }
    }
    figures
}

/// The promise of [`Tolerance`]: no point moves by more than `pixels`, half a pixel, so that what is shown is what the
/// whole mesh shows within that distance and the half pixel of sampling, but for `steps`, of which coarser triangles
/// take half and what is shaded at the vertices the rest. The oracle is asked at every third of a pixel. What has a
/// constant colour moves only by the half pixel, for which two thirds stand; a few pixels at outlines of one part
/// before another may show what it has not been asked for, the last before the horizon, which is within a pixel. Where
/// a pixel and all within one about it is covered there is no hole, and where nothing is there is no speck.
fn pictures_keep_within_the_bounds(tolerance: Tolerance, shadings: &[(&str, Option<Shading>, Reflectance)]) {
    let mut stage = Stage::new(SIZE, SIZE);
    let mut failures = Failures::default();
    for (name, mesh, radius) in meshes() {
        for (shown, shading, reflectance) in shadings {
            for distance in [2.4, 4.5, 8.0, 14.0].map(|distance| distance * radius) {
                let row = format!("{name}, {shown}, from {distance:.1}, {} steps", tolerance.steps);
                let mut thing = Thing::new(mesh.clone()).reflecting(*reflectance);
                match shading {
                    Some(shading) => thing = thing.of(material()).shaded(*shading),
                    None => thing = thing.of(glowing(0.3, 0.5, 0.7)),
                }
                let mut scene = one(thing, distance);
                scene.camera.background = LinearRgba::rgb(BACKGROUND[0], BACKGROUND[1], BACKGROUND[2]);
                stage.set(&scene);
                stage.levels(tolerance);
                let picture = stage.float();
                let drawn = stage.report().triangles;
                stage.levels(FULL);
                if stage.report().triangles == drawn {
                    // No level will do; what the whole mesh shows is other tests' affair.
                    println!("{row}: as it is");
                    assert_identical(&row, &stage.float(), &picture);
                    continue;
                }
                let picture = Image::from_float(&picture);
                let fine = Oracle::new(stage.world(), UVec2::splat(SIZE * SAMPLES)).expect("a scene").draw();
                // Constant colours move, but do not change; the float bar stays.
                let steps = if shading.is_some() { f64::from(tolerance.steps) } else { 0.0 };
                let allowed = [steps / 255.0 + FLOAT_SLACK; 3];
                let Figures { mut plain, excess: [mut two_thirds, mut one], holes, specks } =
                    figures(&picture, &fine, allowed);
                let inside = plain.len() / 3;
                let [plain, two_thirds, one] = [&mut plain, &mut two_thirds, &mut one].map(|e| worst_and_most(e));
                let whole = stage.report().triangles;
                println!(
                    "{row}: {drawn} of {whole} triangles, {inside} pixels inside; of what is allowed (worst, \
                     99.9 %): plain {:.2} {:.2}, beyond ⅔ pixel {:.2} {:.2}, beyond 1 pixel {:.2} {:.2}; {holes} holes, \
                     {specks} specks",
                    plain.0, plain.1, two_thirds.0, two_thirds.1, one.0, one.1
                );
                failures.unless(inside > 20, || format!("{row}: {inside} pixels inside"));
                failures.unless(one.0 <= 1.0, || format!("{row}: {:.2} of what is allowed", one.0));
                failures.unless(shading.is_some() || two_thirds.1 <= 1.0, || {
                    format!("{row}: 99.9 % in {:.2} of it", two_thirds.1)
                });
                failures.unless(holes == 0 && specks == 0, || format!("{row}: {holes} holes, {specks} specks"));
            }
        }
    }
    failures.finish();
}

#[test]
fn pictures_that_are_too_coarse_are_found_out() {
    let mut stage = Stage::new(SIZE, SIZE);
    let mut scene = one(Thing::new(sphere(256)).of(material()).shaded(Shading::Gouraud), 2.4);
    scene.camera.background = LinearRgba::rgb(BACKGROUND[0], BACKGROUND[1], BACKGROUND[2]);
    stage.set(&scene);
    // Far beyond half a pixel and four steps.
    stage.levels(Tolerance { steps: 2550.0, pixels: 12.0 });
    let picture = Image::from_float(&stage.float());
    let fine = Oracle::new(stage.world(), UVec2::splat(SIZE * SAMPLES)).expect("a scene").draw();
    let allowed = [4.0 / 255.0 + FLOAT_SLACK; 3];
    let Figures { excess: [_, mut excess], .. } = figures(&picture, &fine, allowed);
    let (worst, most) = worst_and_most(&mut excess);
    println!("{} triangles: {worst:.2} {most:.2} of what is allowed", stage.report().triangles);
    assert!(worst > 1.5 && most > 1.0, "{worst:.2} and {most:.2} of what is allowed");
}

#[test]
fn pictures_of_constant_colour_keep_their_outlines() {
    let rows = [("constant", None, Reflectance::BlinnPhong)];
    pictures_keep_within_the_bounds(Tolerance::DEFAULT, &rows);
}

#[test]
fn flat_pictures_show_every_triangle() {
    let mut stage = Stage::new(48, 48);
    let flat = Thing::new(sphere(128)).shaded(Shading::Flat).faces(Faces::Both);
    let (drawn, modelled) = triangles(&mut stage, &one(flat, 40.0), Tolerance::DRAFT);
    assert_eq!(drawn, modelled);
}

#[test]
fn gouraud_pictures_keep_within_the_bounds() {
    let rows = [
        ("Gouraud, Phong", Some(Shading::Gouraud), Reflectance::Phong),
        ("Gouraud, Blinn–Phong", Some(Shading::Gouraud), Reflectance::BlinnPhong),
    ];
    for tolerance in TOLERANCES {
        pictures_keep_within_the_bounds(tolerance, &rows);
    }
}

#[test]
fn phong_pictures_keep_within_the_bounds() {
    let rows = [
        ("Phong, Phong", Some(Shading::Phong), Reflectance::Phong),
        ("Phong, Blinn–Phong", Some(Shading::Phong), Reflectance::BlinnPhong),
    ];
    for tolerance in TOLERANCES {
        pictures_keep_within_the_bounds(tolerance, &rows);
    }
}

#[test]
fn auto_pictures_keep_within_the_bounds() {
    let rows = [
        ("Auto, Phong", Some(Shading::Auto), Reflectance::Phong),
        ("Auto, Blinn–Phong", Some(Shading::Auto), Reflectance::BlinnPhong),
    ];
    for tolerance in TOLERANCES {
        pictures_keep_within_the_bounds(tolerance, &rows);
    }
}

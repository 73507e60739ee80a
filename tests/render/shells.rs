//! Objects that are drawn coarser, close before others.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, rotated};
use crate::render::stage::{FULL, Stage};
use halfway::prelude::*;

/// A sphere of the size of 1, and one that is larger by a part around it, of another orientation; seen from a distance.
fn shells(larger_by: f32, distance: f32) -> Scene {
    let ball = Mesh::from(UvSphere::new(1.0, 256, 128));
    let inner = Thing::new(ball.clone()).of(glowing(1.0, 0.0, 0.0));
    let outer = rotated(0.5, 0.6, 0.7).with_scale(Vec3::splat(1.0 + larger_by));
    let outer = Thing::new(ball).of(glowing(0.0, 1.0, 0.0)).at(outer);
    Scene::seen_from(Vec3::new(0.2, 0.35, 0.9).normalize() * distance, Vec3::ZERO).with(inner).with(outer)
}

/// A tolerance lets points move by pixels, and a shell of 0.05 % is a fraction of one. It hides what is inside all the
/// same.
#[test]
fn a_shell_hides_what_is_close_inside() {
    let mut stage = Stage::new(128, 128);
    for larger_by in [0.0005, 0.00075, 0.001, 0.0015, 0.002] {
        for distance in [4.0, 6.0, 8.0, 12.0] {
            stage.set(&shells(larger_by, distance));
            for tolerance in [FULL, Tolerance::DEFAULT, Tolerance { pixels: 2.0, ..Tolerance::DEFAULT }] {
                stage.levels(tolerance);
                let picture = stage.float();
                let [inner, outer] = [0, 1].map(|k| picture.pixels().filter(|pixel| pixel.0[k] > 0.5).count());
                let row = format!("{larger_by} larger, from {distance}, {} pixels", tolerance.pixels);
                assert_eq!(inner, 0, "{row}: pixels of the inner sphere");
                assert!(outer > 200, "{row}: {outer} pixels of the outer one");
            }
        }
    }
}

/// At the terminator interpolation loses much, so that few steps keep most triangles; what is dark and what is bright
/// here differ by far more.
const MANY_STEPS: Tolerance = Tolerance { steps: 32.0, ..Tolerance::DEFAULT };

/// The same of two spheres in one mesh that have no corner in common. The normals of the inner one point away from the
/// light.
#[test]
fn a_shell_hides_what_is_close_inside_in_the_same_mesh() {
    let mut stage = Stage::new(128, 128);
    let ball = Mesh::from(UvSphere::new(1.0, 256, 128));
    let turned = rotated(0.5, 0.6, 0.7).rotation;
    let eye = Vec3::new(0.2, 0.35, 0.9).normalize();
    let mut drawn = |larger_by: f32, distance: f32, tolerance: Tolerance| {
        let outer = ball.positions().iter().map(|&p| turned * (p * (1.0 + larger_by)));
        let positions = ball.positions().iter().copied().chain(outer).collect();
        let normals = ball.normals().iter().map(|&n| -n).chain(ball.normals().iter().map(|&n| turned * n)).collect();
        let count = ball.positions().len() as u32;
        let indices = ball.indices().iter().copied().chain(ball.indices().iter().map(|i| i + count)).collect();
        let both = Mesh::from_parts(positions, Some(normals), None, indices).expect("two spheres");
        let matt = Material { diffuse: LinearRgba::WHITE, ..glowing(0.0, 0.0, 0.0) };
        let scene = Scene::seen_from(eye * distance, Vec3::ZERO)
            .with(Thing::new(both).of(matt).shaded(Shading::Gouraud))
            .lit(Lamp::directional(directional_light(), -eye));
        stage.set(&scene);
        stage.levels(tolerance);
        let picture = stage.float();
        let middle = picture.width() as f32 / 2.0;
        // Well within the outline, where the outer one is bright.
        let radius = 0.7 * middle / (0.5 * scene.camera.fov_y).tan() / distance;
        let within: Vec<f32> = picture
            .enumerate_pixels()
            .filter(|&(x, y, _)| (x as f32 - middle).hypot(y as f32 - middle) < radius)
            .map(|(_, _, pixel)| pixel.0[0])
            .collect();
        assert!(within.len() > 50, "{} pixels", within.len());
        (within.into_iter().filter(|&bright| bright < 0.05).count(), stage.report().triangles)
    };
    for larger_by in [0.0005, 0.00075, 0.001, 0.0015, 0.002] {
        for distance in [4.0, 6.0, 8.0, 12.0] {
            for tolerance in [FULL, MANY_STEPS, Tolerance { pixels: 2.0, ..MANY_STEPS }] {
                let (dark, _) = drawn(larger_by, distance, tolerance);
                assert_eq!(dark, 0, "{larger_by} larger, from {distance}, {} pixels", tolerance.pixels);
            }
        }
    }
    // Where there is room, both are drawn with fewer.
    let [all, fewer] = [FULL, MANY_STEPS].map(|tolerance| drawn(0.3, 12.0, tolerance).1);
    assert!(fewer < all / 2, "{fewer} of {all}");
}

/// The same of a sheet that is wound twice around a cylinder, and so is connected. The normals of its inner turn point
/// away from the light.
#[test]
fn a_turn_of_a_sheet_hides_what_is_close_inside() {
    const AROUND: u32 = 256;
    let mut stage = Stage::new(128, 128);
    let matt = Material { diffuse: LinearRgba::WHITE, ..glowing(0.0, 0.0, 0.0) };
    let mut drawn = |apart: f32, distance: f32, tolerance: Tolerance| {
        let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for along in 0..=2 * AROUND {
            // No corner of one turn is behind a corner of the other.
            let turns = along as f32 / (AROUND as f32 + 0.4);
            let (sin, cos) = (std::f32::consts::TAU * (turns + 0.3)).sin_cos();
            let (radius, out) = (1.0 + apart * turns, if turns <= 1.0 { -1.0 } else { 1.0 });
            for across in 0..=64_u32 {
                positions.push(Vec3::new(radius * sin, across as f32 / 32.0 - 1.0, radius * cos));
                normals.push(out * Vec3::new(sin, 0.0, cos));
                if along < 2 * AROUND && across < 64 {
                    let [a, b] = [65 * along + across, 65 * (along + 1) + across];
                    indices.extend([a, b, b + 1, a, b + 1, a + 1]);
                }
            }
        }
        let sheet = Mesh::from_parts(positions, Some(normals), None, indices).expect("a sheet");
        let scene = Scene::seen_from(Vec3::Z * distance, Vec3::ZERO)
            .with(Thing::new(sheet).of(matt).shaded(Shading::Gouraud))
            .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
        stage.set(&scene);
        stage.levels(tolerance);
        let picture = stage.float();
        let middle = picture.width() as f32 / 2.0;
        // Well within the outline, where the outer turn is bright.
        let half = 0.5 * middle / (0.5 * scene.camera.fov_y).tan() / distance;
        let is_within = |x: u32, y: u32| (x as f32 - middle).abs().max((y as f32 - middle).abs()) < half;
        let dark = picture.enumerate_pixels().filter(|&(x, y, pixel)| is_within(x, y) && pixel.0[0] < 0.05).count();
        (dark, stage.report().triangles)
    };
    for apart in [0.0002, 0.0005, 0.001, 0.002, 0.01] {
        for distance in [4.0, 8.0, 16.0, 32.0] {
            for tolerance in [FULL, MANY_STEPS, Tolerance { pixels: 2.0, ..MANY_STEPS }] {
                let (dark, _) = drawn(apart, distance, tolerance);
                assert_eq!(dark, 0, "{apart} apart, from {distance}, {} pixels", tolerance.pixels);
            }
        }
    }
    // Where there is room, it is drawn with fewer.
    let [all, fewer] = [FULL, MANY_STEPS].map(|tolerance| drawn(0.5, 32.0, tolerance).1);
    assert!(fewer < all / 2, "{fewer} of {all}");
}

/// What is near to another keeps all triangles, what is farther is drawn with fewer, in one frame.
#[test]
fn only_what_is_close_to_another_keeps_its_triangles() {
    let mut stage = Stage::new(128, 128);
    let ball = Mesh::from(UvSphere::new(1.0, 256, 128));
    let whole = ball.triangle_count() as u64;
    let at = |x: f32| Thing::new(ball.clone()).of(glowing(1.0, 1.0, 1.0)).at(Transform::from_xyz(x, 0.0, 0.0));
    let mut drawn = |xs: &[f32]| {
        let scene = Scene::seen_from(Vec3::new(0.0, 0.0, 16.0), Vec3::ZERO);
        stage.set(&xs.iter().fold(scene, |scene, &x| scene.with(at(x).faces(Faces::Both))));
        stage.levels(Tolerance::DEFAULT);
        stage.report().triangles
    };
    let alone = drawn(&[0.0]);
    assert!(alone < whole / 4, "{alone} of {whole}");
    assert_eq!(drawn(&[-3.0, 3.0]), 2 * alone, "far from each other");
    // Of two that touch, only the patches where they do are kept.
    let touching = drawn(&[-1.0, 1.0]);
    assert!(touching > 2 * alone && touching < whole, "{touching}, {alone} alone, of {whole} each");
    assert_eq!(drawn(&[0.0, 0.0001]), 2 * whole, "one in the other");
}

/// What is blended does not move, and keeps what is inside from showing.
#[test]
fn glass_counts_as_another() {
    let mut stage = Stage::new(64, 64);
    let ball = Mesh::from(UvSphere::new(1.0, 256, 128));
    let whole = ball.triangle_count() as u64;
    let inner = Thing::new(ball.clone()).of(glowing(1.0, 0.0, 0.0)).faces(Faces::Both);
    let glass = Thing::new(ball).blended(0.5).at(Transform::from_scale(Vec3::splat(1.001)));
    stage.set(&Scene::seen_from(Vec3::new(0.0, 0.0, 12.0), Vec3::ZERO).with(inner).with(glass));
    stage.levels(Tolerance::DEFAULT);
    assert_eq!(stage.report().triangles, 2 * whole);
}

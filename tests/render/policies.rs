//! Intensity policies that act on the finished picture: their cost, their state between frames, and their scope.

use crate::render::compare::{assert_identical, brightest};
use crate::render::conformance::policies::POLICIES;
use crate::render::scene::{Scene, Thing, glowing};
use crate::render::stage::Stage;
use halfway::lighting::equations::divisor;
use halfway::prelude::*;

/// A square of this emission before a black background.
fn glow(brightness: f32) -> Scene {
    let mut scene = Scene::in_eye_space()
        .with(Thing::square(Vec3::Z * -3.0, Vec3::Z, 1.0).with_material(glowing(brightness, 0.5, 0.25)));
    scene.camera.background = LinearRgba::rgb(0.5, 0.5, 0.5);
    scene
}

fn set_policy(stage: &mut Stage, policy: Intensity) {
    let world = stage.world();
    world.query::<&mut Camera>().iter_mut(world).for_each(|mut camera| camera.intensity = policy);
}

fn set_glow(stage: &mut Stage, red: f32) {
    let world = stage.world();
    world.query::<&mut Material>().iter_mut(world).for_each(|mut material| material.emission.red = red);
}

/// The number that the picture of a background of 0.5 was divided by.
fn divided_by(stage: &mut Stage) -> f64 {
    0.5 / f64::from(stage.float().get_pixel(0, 0).0[0])
}

#[test]
fn clamping_costs_nothing() {
    let mut stage = Stage::new(40, 30);
    stage.set(&glow(4.0));
    // The third frame keeps what the second has made.
    stage.bytes();
    stage.bytes();
    let (before, counts) = (stage.bytes(), stage.report().clone());
    assert_eq!((counts.picture_passes, &counts.errors[..]), (0, &[][..]));
    for (name, policy) in POLICIES {
        set_policy(&mut stage, policy);
        stage.bytes();
        // Reductions to 5 × 4 and 1 × 1, and the last pass; on the CPU a pass for the largest, and one.
        let expected = match (policy, stage.is_on_cpu()) {
            (Intensity::Renormalize { .. }, false) => 3,
            (Intensity::Renormalize { .. }, true) => 2,
            _ => 1,
        };
        assert_eq!(stage.report().picture_passes, expected, "{name}");
        set_policy(&mut stage, Intensity::Clamp);
        assert!(stage.bytes() == before, "after {name}");
        stage.bytes();
        // Pipelines of the policy with another format stay in the cache.
        let FrameReport { pipelines, pipelines_live, .. } = counts;
        let again = FrameReport { pipelines, pipelines_live, ..stage.report().clone() };
        assert_eq!(again, counts, "after {name}");
    }
}

#[test]
fn a_still_picture_stays_and_uploads_nothing() {
    let mut stage = Stage::new(40, 30);
    for (name, policy) in POLICIES {
        stage.set(&glow(4.0));
        set_policy(&mut stage, policy);
        let first = stage.float();
        stage.float();
        for _ in 0..3 {
            let again = stage.float();
            assert_eq!(stage.report().bytes_uploaded, 0, "{name}");
            assert_identical(name, &first, &again);
        }
    }
}

/// Every size that reduces to one number: a single pixel, one block, more in one direction, and the ends of blocks.
#[test]
fn the_largest_channel_is_found_wherever_it_is() {
    for [width, height] in [[1, 1], [8, 8], [9, 1], [1, 65], [64, 64], [65, 63], [130, 70]] {
        let mut stage = Stage::new(width, height);
        for at in [[0, 0], [width - 1, 0], [0, height - 1], [width - 1, height - 1], [width / 2, height / 2]] {
            // A small square over the middle of one pixel.
            let half = 0.5 * Camera::default().projection.height_at(1.0_f32);
            let place = |i: u32, of: u32| 2.0 * (i as f32 + 0.5) / of as f32 - 1.0;
            let aspect = width as f32 / height as f32;
            let center = Vec3::new(place(at[0], width) * half * aspect, -place(at[1], height) * half, -1.0);
            let size = half / height as f32;
            let mut scene =
                Scene::in_eye_space().with(Thing::square(center, Vec3::Z, size).with_material(glowing(0.25, 5.0, 0.5)));
            scene.camera.background = LinearRgba::rgb(0.5, 0.25, 2.0);
            scene.camera.intensity = Intensity::Renormalize { smoothing: 0.0 };
            let picture = stage.draw(&scene);
            let found = brightest(&picture);
            assert!((found - 1.0).abs() < 1e-6, "{width} × {height}, {at:?}: {found}");
            let pixel = picture.get_pixel(at[0], at[1]).0;
            assert!((pixel[0] - 0.05).abs() < 1e-6, "{width} × {height}, {at:?}: {pixel:?}");
        }
    }
}

#[test]
fn the_divisor_follows_as_its_equation_says() {
    let mut stage = Stage::new(24, 18);
    stage.set(&glow(4.0));
    let smoothing = 0.75;
    set_policy(&mut stage, Intensity::Renormalize { smoothing });
    // The first frame has none before.
    let mut expected = 4.0;
    for (frame, red) in [4.0f32, 4.0, 2.0, 2.0, 8.0, 8.0, 0.5, 0.5, 0.5].into_iter().enumerate() {
        set_glow(&mut stage, red);
        expected = divisor(f64::from(red), expected, smoothing.into());
        let found = divided_by(&mut stage);
        // A few roundings of f32 a frame.
        assert!((found / expected - 1.0).abs() < 1e-5, "frame {frame}: {found} for {expected}");
    }
    // Another policy in between resets the divisor.
    set_policy(&mut stage, Intensity::Aces);
    stage.float();
    set_policy(&mut stage, Intensity::Renormalize { smoothing });
    set_glow(&mut stage, 3.0);
    let found = divided_by(&mut stage);
    assert!((found - 3.0).abs() < 1e-5, "{found}");
}

/// A tolerance applies to the written picture: the same scene keeps to it under every policy.
#[test]
fn a_tolerance_holds_after_the_intensity_policy() {
    let mut stage = Stage::new(64, 48);
    for (name, policy) in POLICIES {
        let ball = Thing::new(UvSphere::new(1.0, 64, 32)).shaded(Shading::Phong);
        let mut scene = Scene::seen_from(Vec3::new(0.4, 0.3, 3.0), Vec3::ZERO).with(ball);
        for i in 0..24 {
            let angle = i as f32;
            let light = PointLight::new(LinearRgba::rgb(0.4, 0.2, 0.3) * if i < 12 { 1.0 } else { 1e-3 });
            let at = Vec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 2.0);
            scene.lamps.push(crate::render::scene::Lamp::point(light, at));
        }
        scene.camera.intensity = policy;
        scene.things[0].shading = Some(Shading::Phong);
        stage.world().insert_resource(ViewTolerance(Tolerance::EXACT));
        let exact = stage.draw_bytes(&scene);
        for steps in [1.0, 4.0] {
            stage.world().insert_resource(ViewTolerance(Tolerance::steps(steps)));
            let drawn = stage.draw_bytes(&scene);
            let most = exact.iter().zip(drawn.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
            // And half a step of rounding to either side.
            assert!(f32::from(most) <= steps + 1.0, "{name}: {most} steps of {steps}");
        }
    }
}

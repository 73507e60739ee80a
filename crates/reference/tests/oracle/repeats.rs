//! The same scene gives the same picture however it is drawn, and drawing reports progress and can be stopped.

use std::ops::ControlFlow;
use std::sync::Mutex;

use bevy_color::LinearRgba;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{AlphaMode, BackMaterial, DirectionalLight, Faces, Material, PointLight, SpotLight};
use halfway_mesh::{Cuboid, Mesh, Teapot, UvSphere};
use halfway_reference::Stopped;

use crate::scene::{REFLECTANCES, SHADINGS, Stage, assert_same, wall};

/// A little of everything.
fn crowd() -> Stage {
    let mut stage = Stage::new();
    stage.camera().background = LinearRgba::rgb(0.1, 0.2, 0.3);
    let plastic = |red, green, blue| Material::plastic(LinearRgba::rgb(red, green, blue));
    for (i, shading) in SHADINGS.into_iter().enumerate() {
        let x = 1.4 * i as f32 - 1.4;
        let at = Transform::from_xyz(x, 0.8, -3.0).with_rotation(Quat::from_rotation_x(0.5));
        stage.add_at(UvSphere::new(0.6, 20, 10), at, (plastic(0.8, 0.3, 0.2), shading, REFLECTANCES[i]));
        let veil = Material { opacity: 0.4, ..plastic(0.2, 0.5, 0.8) };
        let at = Transform::from_xyz(x, -0.6, -2.4).with_rotation(Quat::from_rotation_y(0.5 + x));
        let looks = (veil, BackMaterial(Material { opacity: 0.7, ..veil }), Faces::Both, AlphaMode::Blend, shading);
        stage.add_at(Cuboid::new(0.7, 0.7, 0.7), at, looks);
    }
    stage.add_at(Mesh::from(Teapot::new(4)), Transform::from_xyz(0.0, -0.5, -6.0), Material::BRASS);
    stage.add(wall(3.0, 8.0), Material::matte(LinearRgba::WHITE));
    stage.sun(DirectionalLight::white(), Vec3::new(-1.0, -2.0, -1.0));
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(1.0, 1.0, -1.0)));
    stage.world.spawn((SpotLight::white(0.4), GlobalTransform::from_xyz(0.0, 0.0, 1.0)));
    stage
}

#[test]
fn a_probe_at_a_pixels_centre_matches_the_pixel() {
    let (width, height) = (90, 60);
    let oracle = crowd().oracle(width, height);
    let image = oracle.draw();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let seen = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5);
        assert_same(&format!("({x}, {y})"), seen.color, image.pixel(x, y));
        assert_eq!(seen.nearest.is_some(), image.covered().expect("known")[(y * width + x) as usize]);
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a few threads");
        pool.install(|| crowd().oracle(90, 60).with_supersampling(2).draw())
    };
    let one = draw(1);
    assert!(one.pixels().iter().flatten().all(|i| i.is_finite() && *i >= 0.0));
    assert_eq!(one, draw(4));
}

#[test]
fn one_oracle_draws_the_same_twice() {
    let oracle = crowd().oracle(64, 40);
    assert_eq!(oracle.draw(), oracle.draw());
}

#[test]
fn progress_counts_every_tile_once() {
    let oracle = crowd().oracle(100, 70);
    let calls = Mutex::new(Vec::new());
    let image = oracle.draw_with(&|done, of| {
        calls.lock().expect("no call panics").push((done, of));
        ControlFlow::Continue(())
    });
    assert_eq!(image, Ok(oracle.draw()));
    let mut calls = calls.into_inner().expect("no call panicked");
    calls.sort_unstable();
    let count = calls.len() as u32;
    assert!(count > 4);
    assert_eq!(calls, (1..=count).map(|done| (done, count)).collect::<Vec<_>>());
}

#[test]
fn progress_can_stop_the_drawing() {
    let oracle = crowd().oracle(100, 70);
    let stopped =
        oracle.draw_with(&|done, _| if done < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) });
    assert_eq!(stopped, Err(Stopped));
    assert!(oracle.draw_with(&|_, _| ControlFlow::Continue(())).is_ok(), "it can be asked again");
}

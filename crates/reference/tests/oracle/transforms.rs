//! Mirrored, singular, sheared and extreme transforms.

use bevy_math::{Affine3A, DVec3, Mat3, Mat4, Quat, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{DirectionalLight, Faces, PointLight, Shading, Viewer};
use halfway_mesh::UvSphere;

use crate::scene::{EXACT, REFLECTANCES, SHADINGS, Stage, assert_close, chalk, panel, scaled, triangle, wall};
use halfway_lighting::Material;

#[test]
fn a_mirror_keeps_the_front_in_front() {
    for shading in SHADINGS {
        let mut pictures = Vec::new();
        // Twice mirrored is not mirrored; the rectangle is as wide to the left as to the right.
        for at in [scaled(1.0, 1.0, 1.0), scaled(-1.0, 1.0, 1.0), scaled(1.0, -1.0, 1.0), scaled(-1.0, -1.0, 1.0)] {
            let mut stage = Stage::new();
            stage.add_at(panel(-1.0, 1.0, -1.5, 1.5, 2.0), at, (chalk(0.5), shading));
            stage.sun(DirectionalLight::white(), Vec3::new(-3.0, 0.0, -4.0));
            pictures.push(stage.draw(12, 12));
        }
        assert_close("lit", pictures[0].pixel(6, 6), [0.4; 3]);
        for picture in &pictures {
            assert_eq!(picture.covered(), pictures[0].covered());
            for (found, expected) in picture.pixels().iter().zip(pictures[0].pixels()) {
                assert_close(&format!("{shading:?}"), *found, *expected);
            }
        }
    }
}

#[test]
fn depth_mirrored_turns_a_wall_to_its_other_side() {
    // z → −z brings a wall behind the eye before it, and turns its front away.
    let mut stage = Stage::new();
    stage.add_at(wall(4.0, -2.0), scaled(1.0, 1.0, -1.0), chalk(0.5));
    stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
    assert!(stage.draw(4, 4).covered().expect("known").iter().all(|covered| !covered));
    let mut stage = Stage::new();
    stage.add_at(wall(4.0, -2.0), scaled(1.0, 1.0, -1.0), (chalk(0.5), Faces::Back));
    stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
    assert_close("back", stage.draw(4, 4).pixel(1, 1), [0.5; 3]);
}

#[test]
fn a_sphere_pressed_flat_is_a_disc() {
    let press =
        Affine3A::from_mat3_translation(Mat3::from_diagonal(Vec3::new(1.0, 1.0, 0.0)), Vec3::new(0.0, 0.0, -2.0));
    for shading in SHADINGS {
        let mut stage = Stage::new();
        stage.add_at(UvSphere::new(1.5, 24, 12), GlobalTransform::from(press), (chalk(0.5), shading));
        stage.sun(DirectionalLight::white(), Vec3::new(-3.0, 0.0, -4.0));
        let image = stage.draw(16, 16);
        let covered = image.covered().expect("known");
        for (pixel, covered) in image.pixels().iter().zip(covered) {
            // On the equator normals lie in the disc's plane and vanish; Phong and Gouraud then lose light there.
            if shading == Shading::Flat && *covered {
                assert_close("disc", *pixel, [0.4; 3]);
            }
            assert!(pixel.iter().all(|i| (0.0..0.4 + EXACT).contains(i)));
        }
        assert_close("middle", image.pixel(8, 8), [0.4; 3]);
        assert!(covered.iter().filter(|covered| **covered).count() > 80);
    }
}

#[test]
fn a_sphere_pressed_to_a_line_or_a_point_is_not_there() {
    for scale in [Vec3::new(1.0, 0.0, 0.0), Vec3::ZERO] {
        let at = Transform { translation: Vec3::NEG_Z * 2.0, scale, rotation: Quat::from_rotation_z(0.3) };
        let mut stage = Stage::new();
        stage.add_at(UvSphere::new(1.5, 24, 12), at, (chalk(0.5), Faces::Both));
        stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
        assert!(stage.draw(16, 16).covered().expect("known").iter().all(|covered| !covered));
    }
}

#[test]
fn sheared_normals_use_the_inverse_transpose() {
    let shear = Mat3::from_cols(Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.5, 1.0, 0.25), Vec3::new(0.0, 0.75, 3.0));
    let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    for mirror in [1.0, -1.0] {
        let m = shear * Mat3::from_diagonal(Vec3::new(mirror, 1.0, 1.0));
        // A transform maps a plane as it maps three of its points.
        let [a, b, c] = corners.map(|corner| (m * corner).as_dvec3());
        let n = (b - a).cross(c - a).normalize() * f64::from(mirror);
        let toward = DVec3::new(0.6, 0.0, 0.8);
        for shading in SHADINGS {
            let mut stage = Stage::new();
            let at = GlobalTransform::from(Affine3A::from_mat3_translation(m, Vec3::new(0.0, 0.0, -3.0)));
            stage.add_at(triangle(corners, Some([Vec3::Z; 3])), at, (chalk(0.5), shading));
            stage.sun(DirectionalLight::white(), Vec3::new(-3.0, 0.0, -4.0));
            assert_close(&format!("{shading:?}"), stage.draw(3, 3).pixel(1, 1), [0.5 * n.dot(toward); 3]);
        }
    }
}

#[test]
fn the_camera_turns_and_moves_but_does_not_scale() {
    let mut pictures = Vec::new();
    for scale in [Vec3::ONE, Vec3::splat(7.0), Vec3::new(0.5, 2.0, 3.0)] {
        let mut stage = Stage::new();
        // Binary fractions, so that the view is the same to the bit.
        let at = Mat4::from_scale_rotation_translation(scale, Quat::IDENTITY, Vec3::new(16.0, 0.0, 0.5));
        stage.world.entity_mut(stage.camera).insert(GlobalTransform::from(at));
        stage.add_at(wall(1.0, 1.5), GlobalTransform::from_xyz(16.0, 0.0, 0.0), chalk(1.0));
        stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(17.0, 0.0, 0.0)));
        pictures.push(stage.draw(8, 8));
    }
    assert!(pictures[0].pixel(4, 4)[0] > 0.1);
    assert_eq!(pictures[0], pictures[1]);
    assert_eq!(pictures[0], pictures[2]);
}

#[test]
fn the_same_scene_far_from_the_origin_is_the_same() {
    let draw = |far: Vec3| {
        let mut stage = Stage::new();
        let at = |x, y, z| GlobalTransform::from_translation(far + Vec3::new(x, y, z));
        let camera = Transform::from_translation(far).with_rotation(Quat::from_rotation_y(0.1));
        stage.world.entity_mut(stage.camera).insert(GlobalTransform::from(camera));
        stage.add_at(UvSphere::new(1.0, 12, 6), at(0.0, 0.0, -3.0), Material::plastic(bevy_color::LinearRgba::WHITE));
        stage.world.spawn((PointLight::white(), at(2.0, 2.0, 0.0)));
        stage.draw(24, 24)
    };
    // Whole numbers up to 2²⁴ are exact in f32, and differences of f32 in f64.
    assert_eq!(draw(Vec3::ZERO), draw(Vec3::new(1e7, -2e6, 5e6)));
}

#[test]
fn models_of_any_size_look_the_same_and_hold_no_nan() {
    // Powers of two, so that nothing is rounded but what the size itself does.
    let draw = |size: f32, shading, reflectance| {
        let mut stage = Stage::new();
        {
            let mut camera = stage.camera();
            camera.projection = camera.projection.with_near(0.01 * size);
            camera.viewer = Viewer::Local;
        }
        let mut light = PointLight::white();
        light.attenuation = halfway_lighting::Attenuation::NONE;
        let at = Transform::from_xyz(0.0, 0.0, -3.0 * size).with_scale(Vec3::splat(size));
        let looks = (Material::plastic(bevy_color::LinearRgba::WHITE), shading, reflectance);
        stage.add_at(UvSphere::new(1.0, 16, 8), at, looks);
        stage.world.spawn((light, GlobalTransform::from_xyz(2.0 * size, size, 0.0)));
        stage.draw(24, 24)
    };
    for shading in SHADINGS {
        for reflectance in REFLECTANCES {
            let expected = draw(1.0, shading, reflectance);
            assert!(expected.pixels().iter().any(|pixel| pixel[0] > 0.5));
            // About 1e-12, 1e12, and the ends at which f32 still has room for the camera.
            for exponent in [-40, 40, -100, 100] {
                let found = draw(2f32.powi(exponent), shading, reflectance);
                for (found, expected) in found.pixels().iter().zip(expected.pixels()) {
                    assert!(found.iter().all(|i| i.is_finite()));
                    assert_close(&format!("2^{exponent}, {shading:?}, {reflectance:?}"), *found, *expected);
                }
            }
        }
    }
}

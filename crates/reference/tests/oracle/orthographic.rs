//! Orthographic and off-centre cameras: rays, planes, highlights, and pictures with planted faults.

use bevy_math::{DVec3, Vec3};
use halfway_lighting::{DirectionalLight, Faces, Film, Material, PointLight, Projection, Viewer};
use halfway_mesh::UvSphere;
use halfway_reference::Mode;

use crate::mutants::{assert_caught, float, moved, oracle};
use crate::scene::{SHADINGS, Stage, assert_close, glow, grey, panel, wall};

/// The stage under a camera that sees 4 units from edge to edge, from depth `near` on.
fn stage(near: f32, far: Option<f32>) -> Stage {
    let mut stage = Stage::new();
    stage.camera().projection = orthographic(4.0, near, far);
    stage
}

fn orthographic(height: f32, near: f32, far: Option<f32>) -> Projection {
    Projection::Orthographic { height, near, far, film: Film::DEFAULT }
}

fn tilted_wall() -> halfway_mesh::Mesh {
    moved(&wall(9.0, 0.0), |p| Vec3::new(p.x, p.y, -3.0 + 0.5 * p.x - 0.25 * p.y))
}

#[test]
fn parallel_rays_meet_a_slanted_wall_where_it_is() {
    for near in [-20.0, 0.5] {
        let mut stage = stage(near, None);
        stage.add(tilted_wall(), glow(1.0, 1.0, 1.0));
        let oracle = stage.oracle(40, 20);
        for (x, y) in (0..20).flat_map(|y| (0..40).map(move |x| (x, y))) {
            let (across, down) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            // The picture is twice as wide as high: a pixel is a fifth of a unit.
            let p = DVec3::new(across / 5.0 - 4.0, 2.0 - down / 5.0, 0.0);
            let expected = p.with_z(-3.0 + 0.5 * p.x - 0.25 * p.y);
            let nearest = oracle.probe(across, down).nearest;
            if -expected.z < f64::from(near) {
                assert!(nearest.is_none());
                continue;
            }
            let nearest = nearest.expect("the wall");
            assert!(nearest.position.distance(expected) < 1e-12, "{nearest:?}, expected {expected}");
            assert!((nearest.depth + expected.z).abs() < 1e-12);
            let (u, v) = oracle.project(expected).expect("on the picture");
            assert!((u - across).abs() < 1e-12 && (v - down).abs() < 1e-12);
        }
    }
}

#[test]
fn walls_show_between_the_planes_alone_and_the_nearest_hides() {
    let shown = |near: f32, far: Option<f32>, depths: &[f32]| {
        let mut stage = stage(near, far);
        for (number, depth) in depths.iter().enumerate() {
            stage.add(wall(4.0, *depth), glow(number as f32 + 1.0, 0.0, 0.0));
        }
        stage.draw(5, 5).pixel(2, 2)[0]
    };
    assert_close("the nearer", [shown(0.0, None, &[5.0, 2.0]); 3], [2.0; 3]);
    assert_close("behind the camera", [shown(-9.0, None, &[5.0, -2.0]); 3], [2.0; 3]);
    assert_close("before the near plane", [shown(3.0, None, &[5.0, 2.0]); 3], [1.0; 3]);
    assert_close("beyond the far plane", [shown(0.0, Some(4.0), &[5.0]); 3], [0.0; 3]);
}

#[test]
fn surfaces_and_their_meshes_have_one_silhouette() {
    let mut stage = stage(-8.0, None);
    stage.add(moved(&UvSphere::new(1.0, 8, 4).into(), |p| p), glow(1.0, 1.0, 1.0));
    let ball = UvSphere::new(1.0, 64, 32);
    let mut round = self::stage(-8.0, None);
    round.add(ball, glow(1.0, 1.0, 1.0));
    let surface = round.oracle(80, 80).with_mode(Mode::Surface).draw();
    for (x, y) in (0..80).flat_map(|y| (0..80).map(move |x| (x, y))) {
        let p = DVec3::new((f64::from(x) + 0.5) / 20.0 - 2.0, 2.0 - (f64::from(y) + 0.5) / 20.0, 0.0);
        let expected = p.length() < 1.0;
        assert_eq!(surface.covered().expect("known")[(y * 80 + x) as usize], expected, "({x}, {y})");
    }
}

#[test]
fn highlights_lie_where_a_constant_viewer_sees_them() {
    for shading in SHADINGS {
        let mut stage = stage(0.0, None);
        let glossy = Material { ambient: grey(0.0), diffuse: grey(0.0), specular: grey(1.0), ..Material::DEFAULT };
        stage.add(wall(9.0, 3.0), (glossy, shading));
        stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
        let image = stage.draw(9, 9);
        for (x, y) in (0..9).flat_map(|y| (0..9).map(move |x| (x, y))) {
            assert_close("a highlight", image.pixel(x, y), [1.0; 3]);
        }
        stage.camera().viewer = Viewer::Infinite;
        assert_eq!(stage.draw(9, 9), image);
    }
}

/// Balls before a wall, lit.
fn balls(projection: Projection) -> Stage {
    let mut stage = Stage::new();
    stage.camera().projection = projection;
    let glossy = Material { specular: grey(0.5), shininess: 20.0, ..Material::DEFAULT };
    for (at, radius) in [(Vec3::new(-0.6, 0.2, -3.0), 0.8), (Vec3::new(0.5, -0.3, -4.0), 0.9)] {
        let ball = moved(&UvSphere::new(radius, 16, 8).into(), |p| p + at);
        stage.add(ball, (glossy, Faces::Both));
    }
    stage.add(panel(-1.8, 1.8, -1.8, 1.8, 5.0), glossy);
    stage.world.spawn((PointLight::white(), bevy_transform::components::GlobalTransform::from_xyz(2.0, 3.0, 1.0)));
    stage
}

#[test]
fn faults_of_an_orthographic_drawer_are_caught() {
    let right = orthographic(4.0, 0.0, Some(9.0));
    let mut truth = balls(right);
    let verdict = float(&oracle(&mut truth), &truth.draw(96, 96));
    assert!(verdict.is_within(), "{verdict}");
    for (fault, wrong) in [
        ("a perspective", Projection::perspective(2.0 * 0.5_f32.atan())),
        ("another height", orthographic(4.04, 0.0, Some(9.0))),
        ("a near plane too far away", orthographic(4.0, 2.6, Some(9.0))),
        ("a far plane too near", orthographic(4.0, 0.0, Some(4.9))),
    ] {
        let actual = balls(wrong).draw(96, 96);
        assert_caught(fault, &mut truth, &actual);
    }
}

#[test]
fn rays_of_a_calibrated_camera_meet_a_slanted_wall_where_it_is() {
    let mut stage = Stage::new();
    stage.camera().projection = Projection::intrinsics([40.0, 50.0], [11.0, 13.5], [40, 20]);
    stage.add(tilted_wall(), glow(1.0, 1.0, 1.0));
    let oracle = stage.oracle(40, 20);
    for (x, y) in (0..20).flat_map(|y| (0..40).map(move |x| (x, y))) {
        let (across, down) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let slope = DVec3::new((across - 11.0) / 40.0, (13.5 - down) / 50.0, -1.0);
        // z = −3 + x/2 − y/4 on the wall.
        let depth = 3.0 / (1.0 + 0.5 * slope.x - 0.25 * slope.y);
        let expected = slope * depth;
        let nearest = oracle.probe(across, down).nearest.expect("the wall");
        // The field of view is an f32.
        assert!(nearest.position.distance(expected) < 2e-6, "{nearest:?}, expected {expected}");
        let (u, v) = oracle.project(nearest.position).expect("on the picture");
        assert!((u - across).abs() < 1e-12 && (v - down).abs() < 1e-12);
    }
}

#[test]
fn faults_of_an_off_centre_drawer_are_caught() {
    let film = Film { shift: [0.15, -0.1], aspect: None, pixel_aspect: 1.2 };
    for plain in [Projection::perspective(0.9), orthographic(3.6, 0.0, Some(9.0))] {
        let mut truth = balls(plain.with_film(film));
        let verdict = float(&oracle(&mut truth), &truth.draw(96, 96));
        assert!(verdict.is_within(), "{verdict}");
        for (fault, wrong) in [
            ("no shift", Film { shift: [0.0; 2], ..film }),
            ("to the other side", Film { shift: [-0.15, -0.1], ..film }),
            ("down for up", Film { shift: [0.15, 0.1], ..film }),
            ("a shift of a third of a pixel more", Film { shift: [0.1535, -0.1], ..film }),
            ("square pixels", Film { pixel_aspect: 1.0, ..film }),
        ] {
            let actual = balls(plain.with_film(wrong)).draw(96, 96);
            assert_caught(fault, &mut truth, &actual);
        }
    }
}

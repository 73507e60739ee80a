//! The surface that a mesh stands for, drawn in place of the mesh.

use bevy_math::{Affine3A, DMat3, DVec3, Mat3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{AlphaMode, DirectionalLight, Faces, Frequency, Material, PointLight, Shading, Terms};
use halfway_mesh::{Mesh, Teapot, UvSphere};
use halfway_reference::{Image, Mode};

use crate::scene::{SHADINGS, Stage, assert_close, assert_same, chalk, glow, grey, ray, triangle};

const SIZE: u32 = 24;
const TOWARD: DVec3 = DVec3::new(0.6, 0.0, 0.8);

/// A coarse unit sphere, which stands for a smooth one.
fn coarse() -> Mesh {
    UvSphere::new(1.0, 5, 3).into()
}

fn placed(m: Mat3) -> GlobalTransform {
    Affine3A::from_mat3_translation(m, Vec3::new(0.25, 0.0, -2.5)).into()
}

fn draw(stage: &mut Stage) -> Image {
    stage.oracle(SIZE, SIZE).with_mode(Mode::Surface).draw()
}

/// Where a ray enters (and leaves) the unit sphere that [`placed`] has moved, and the normals there.
fn sphere(m: Mat3, ray: DVec3) -> Option<[(f64, DVec3); 2]> {
    let inverse = DMat3::from_cols_array(&m.to_cols_array().map(f64::from)).inverse();
    let (o, d) = (inverse * -DVec3::new(0.25, 0.0, -2.5), inverse * ray);
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
    let root = b * b - a * c;
    // On the outline a last digit decides.
    (root > 1e-6).then(|| {
        [-1.0, 1.0].map(|sign| {
            let t = (-b + sign * root.sqrt()) / a;
            (t, (inverse.transpose() * (o + d * t)).normalize())
        })
    })
}

fn each_pixel() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)))
}

#[test]
fn a_coarse_sphere_is_drawn_as_the_smooth_one_it_stands_for() {
    for (row, m) in [
        ("as it is", Mat3::IDENTITY),
        ("stretched", Mat3::from_diagonal(Vec3::new(1.5, 0.5, 0.75))),
        ("mirrored", Mat3::from_diagonal(Vec3::new(-1.5, 0.5, 0.75))),
        ("sheared", Mat3::from_cols(Vec3::X, Vec3::new(0.5, 1.0, 0.0), Vec3::new(0.0, 0.25, 0.5))),
    ] {
        for shading in SHADINGS {
            let mut stage = Stage::new();
            stage.add_at(coarse(), placed(m), (chalk(0.5), shading));
            stage.sun(DirectionalLight::white(), -5.0 * TOWARD.as_vec3());
            let image = draw(&mut stage);
            let mut count = 0;
            for (x, y) in each_pixel() {
                if let Some([(_, n), _]) = sphere(m, ray(x, y, SIZE, SIZE)) {
                    // The sun's direction is rounded to f32.
                    let expected = 0.5 * n.dot(TOWARD).max(0.0);
                    let found = image.pixel(x, y)[0];
                    assert!((found - expected).abs() < 1e-7, "{row}, {shading:?}, ({x}, {y}): {found}, not {expected}");
                    count += 1;
                }
            }
            assert!(count > 20, "{row}: {count} pixels");
        }
    }
}

#[test]
fn the_inside_of_a_sphere_is_its_back() {
    let mut stage = Stage::new();
    stage.add_at(coarse(), placed(Mat3::IDENTITY), (chalk(0.5), Faces::Back));
    stage.world.spawn((PointLight::white(), GlobalTransform::IDENTITY));
    let oracle = stage.oracle(SIZE, SIZE).with_mode(Mode::Surface);
    for (x, y) in each_pixel() {
        let expected = sphere(Mat3::IDENTITY, ray(x, y, SIZE, SIZE));
        let seen = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if let (Some([_, (depth, n)]), Some(nearest)) = (expected, seen.nearest) {
            let p = ray(x, y, SIZE, SIZE) * depth;
            assert!(!nearest.front && nearest.triangle.is_none());
            assert!((nearest.depth - depth).abs() < 1e-9 && nearest.position.distance(p) < 1e-9);
            let d = p.length();
            let [a, b, c] = [1.0f32, 0.09, 0.032].map(f64::from);
            assert_close("inside", seen.color, [0.5 * n.dot(p / d).max(0.0) / (a + b * d + c * d * d); 3]);
        } else {
            assert!(expected.is_none(), "({x}, {y}) shows nothing");
        }
    }
}

#[test]
fn each_side_of_a_blended_surface_is_there_once() {
    for mesh in [coarse(), Mesh::from(Teapot::new(2))] {
        let mut stage = Stage::new();
        let veil = Material { opacity: 0.5, ..glow(1.0, 1.0, 1.0) };
        stage.add_at(mesh, placed(Mat3::from_diagonal(Vec3::splat(0.75))), (veil, AlphaMode::Blend, Faces::Both));
        let image = draw(&mut stage);
        let layers = |pixel: &[f64; 3]| -(1.0 - pixel[0]).log2();
        let counts: Vec<f64> = image.pixels().iter().map(layers).collect();
        assert!(counts.iter().all(|count| (count - count.round()).abs() < 1e-9));
        assert!(counts.iter().any(|count| (count - 2.0).abs() < 1e-9));
    }
    // Of a sphere every ray meets the far side and the near one, or nothing.
    let mut stage = Stage::new();
    let veil = Material { opacity: 0.5, ..glow(1.0, 1.0, 1.0) };
    stage.add_at(coarse(), placed(Mat3::IDENTITY), (veil, AlphaMode::Blend, Faces::Both));
    let image = draw(&mut stage);
    for (x, y) in each_pixel() {
        if sphere(Mat3::IDENTITY, ray(x, y, SIZE, SIZE)).is_some() {
            assert_close(&format!("({x}, {y})"), image.pixel(x, y), [0.75; 3]);
        }
    }
}

#[test]
fn a_blended_surface_has_no_seams() {
    // The patches of a teapot meet where x = 0, and so in the middle column of an odd picture.
    let mut stage = Stage::new();
    let veil = Material { opacity: 0.5, ..glow(1.0, 1.0, 1.0) };
    let at = GlobalTransform::from_xyz(0.0, -1.0, -4.0);
    stage.add_at(Mesh::from(Teapot::new(2)), at, (veil, AlphaMode::Blend, Faces::Both));
    let oracle = stage.oracle(25, 25).with_mode(Mode::Surface);
    let mut layers = 0.0;
    for y in (0..25).map(|y| f64::from(y) + 0.5) {
        let beside = oracle.probe(12.5 + 1e-4, y).color;
        assert_close(&format!("row {y}"), oracle.probe(12.5, y).color, beside);
        layers -= (1.0 - beside[0]).log2();
    }
    assert!(layers > 16.0, "the column shows hardly anything: {layers} layers");
}

#[test]
fn terms_that_are_never_shaded_stay_away() {
    let mut stage = Stage::new();
    let terms = Shading::Terms(Terms { diffuse: Frequency::Never, specular: Frequency::Vertex });
    let material = Material { specular: grey(1.0), emission: grey(0.25), ..chalk(1.0) };
    let looks = (material, terms);
    stage.add_at(coarse(), placed(Mat3::IDENTITY), looks);
    stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
    let brightest = |image: &Image| image.pixels().iter().map(|pixel| pixel[0]).fold(0.0, f64::max);
    let image = draw(&mut stage);
    // The highlight's peak, somewhere on 24 × 24 pixels; under the edge of it only emission is left.
    assert!((1.1..=1.25).contains(&brightest(&image)), "{}", brightest(&image));
    let of_edge = image.pixels().iter().filter(|pixel| (pixel[0] - 0.25).abs() < 1e-3).count();
    assert!(of_edge > 20, "{of_edge}");
}

#[test]
fn a_mesh_that_stands_for_nothing_is_shaded_as_phong_does() {
    let scene = |shading: Shading| {
        let corners = [Vec3::new(-2.0, -1.0, -2.0), Vec3::new(2.0, -1.0, -2.0), Vec3::new(0.0, 7.0, -8.0)];
        let mut stage = Stage::new();
        stage.add(triangle(corners, Some([Vec3::Z, Vec3::X, Vec3::Y])), (chalk(0.5), shading));
        stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
        stage
    };
    let phong = scene(Shading::Phong).draw(SIZE, SIZE);
    for shading in SHADINGS {
        assert_eq!(draw(&mut scene(shading)), phong, "{shading:?}");
    }
    assert_ne!(scene(Shading::Gouraud).draw(SIZE, SIZE), phong);
}

#[test]
fn a_surface_pressed_flat_is_drawn_as_its_mesh() {
    let mut stage = Stage::new();
    stage.add_at(coarse(), placed(Mat3::from_diagonal(Vec3::new(1.0, 1.0, 0.0))), chalk(0.5));
    stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
    assert_eq!(draw(&mut stage), stage.draw(SIZE, SIZE));
}

#[test]
fn the_mode_can_be_changed_back() {
    let mut stage = Stage::new();
    stage.add_at(coarse(), placed(Mat3::IDENTITY), (chalk(0.5), Shading::Flat));
    stage.sun(DirectionalLight::white(), Vec3::NEG_Z);
    let mesh = stage.draw(SIZE, SIZE);
    let oracle = stage.oracle(SIZE, SIZE).with_mode(Mode::Surface);
    assert_ne!(oracle.draw(), mesh);
    assert_eq!(oracle.with_mode(Mode::Mesh).draw(), mesh);
}

#[test]
fn probes_of_a_teapot_around_the_eye_match_its_pixels() {
    for at in [Vec3::new(0.0, -1.0, -5.0), Vec3::new(0.0, -1.0, 0.0)] {
        let mut stage = Stage::new();
        let looks = (Material::BRASS, Faces::Both);
        stage.add_at(Mesh::from(Teapot::new(2)), GlobalTransform::from_translation(at), looks);
        stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(0.5, 0.5, 0.5)));
        let oracle = stage.oracle(SIZE, SIZE).with_mode(Mode::Surface);
        let image = oracle.draw();
        for (x, y) in each_pixel() {
            let seen = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert_same(&format!("({x}, {y})"), seen.color, image.pixel(x, y));
        }
        let covered = image.covered().expect("known").iter().filter(|covered| **covered).count();
        assert!(covered > 30, "{covered}");
    }
}

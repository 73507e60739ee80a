//! Edge cases of surfaces: normals that cancel, degenerate triangles, surfaces behind the camera, vast surfaces.

use crate::render::compare::{FLOAT, Failures, assert_finite, assert_identical, brightest};
use crate::render::edges::{mesh, screen, unweakened};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::prelude::*;
use halfway::reference::metrics::Bars;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

#[test]
fn opposite_vertex_normals_fall_back_to_the_geometric_normal() {
    // n = (1 − 2u)·x vanishes on the middle column of an odd picture and nowhere else.
    let (left, right) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let folded = Thing::new(screen([left, right, right, left])).with_material(material()).back(other_material());
    let mut stage = Stage::new(33, 33);
    for (side, eye) in [("front", Vec3::ZERO), ("back", Vec3::Z * -8.0)] {
        for faces in [Faces::Front, Faces::Back, Faces::Both] {
            for mixed in [false, true] {
                let mut thing = folded.clone().faces(faces);
                if mixed {
                    thing = thing.terms(Frequency::Vertex, Frequency::Fragment);
                }
                let scene = Scene::seen_from(eye, Vec3::NEG_Z * 4.0)
                    .ambient(0.1)
                    .with(thing)
                    .lit(Lamp::directional(directional_light(), Vec3::new(0.1, -0.2, -1.0)))
                    .lit(Lamp::directional(directional_light(), Vec3::new(0.1, -0.2, 1.0)));
                let picture = stage.draw(&scene);
                let row = format!("{side}, {faces:?} faces, mixed terms {mixed}");
                assert_finite(&row, &picture);
                let oracle = stage.oracle();
                for (x, y) in [(16, 3), (16, 16), (16, 30), (5, 16), (28, 7)] {
                    let expected = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).color;
                    let found = picture.get_pixel(x, y).0;
                    // The fallback is a difference of neighbouring pixels: 10⁻³ of the brightest, 0.9.
                    let close = (0..3).all(|k| (f64::from(found[k]) - expected[k]).abs() < 1e-3);
                    assert!(close, "{row}: pixel ({x}, {y}) is {found:?}, expected {expected:?}");
                }
            }
        }
    }
}

#[test]
fn normals_that_cancel_inside_a_triangle_stay_finite() {
    // Three normals at 120° cancel at the centroid; two opposite ones on an edge's middle.
    let rows = [
        ("three ways", [[0.0, 1.0, 0.0], [0.866_025_4, -0.5, 0.0], [-0.866_025_4, -0.5, 0.0]]),
        ("two ways", [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]),
        ("all toward the eye", [[0.0, 0.0, 1.0]; 3]),
    ];
    let mut stage = Stage::new(33, 33);
    for (name, normals) in rows {
        let triangle = mesh(&[[-3.0, -3.0, -4.0], [3.0, -3.0, -4.0], [0.0, 6.0, -4.0]], &normals, &[0, 1, 2]);
        for shading in SHADINGS {
            for faces in [Faces::Front, Faces::Both] {
                let thing = Thing::new(triangle.clone()).shaded(shading).faces(faces);
                let scene = Scene::in_eye_space().with(thing).lit(Lamp::point(unweakened(), Vec3::ZERO));
                let picture = stage.draw(&scene);
                assert_finite(&format!("{name}, {shading:?}, {faces:?}"), &picture);
                assert!(brightest(&picture) > 0.1, "{name}, {shading:?}, {faces:?} shows nothing");
            }
        }
    }
}

#[test]
fn surfaces_that_reach_behind_the_camera_are_clipped() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let mut clipped = Scene::seen_from(Vec3::new(0.3, 1.0, 0.4), Vec3::new(0.1, 0.2, -3.0)).ambient(0.1);
    clipped.camera.projection = clipped.camera.projection.with_near(0.7);
    let floor = Thing::new(Plane { size: 14.0, divisions: 1 }).faces(Faces::Both);
    let tent = mesh(
        &[[-1.0, 3.0, 4.0], [-6.0, -2.0, 3.0], [0.5, 0.5, -5.0], [5.0, -1.0, 2.0]],
        &[[-0.3, 0.4, 0.8], [-0.6, 0.5, 0.6], [0.0, 1.0, 0.2], [0.7, 0.3, 0.5]],
        &[0, 1, 2, 0, 2, 3],
    );
    for (name, thing) in [("a floor", floor), ("a tent", Thing::new(tent).faces(Faces::Both).back(other_material()))] {
        for shading in SHADINGS {
            for lamp in [
                Lamp::point(point_light(), Vec3::new(0.5, 1.5, -2.0)),
                Lamp::point(point_light(), Vec3::new(0.5, 2.0, 5.0)),
                Lamp::directional(directional_light(), Vec3::new(-0.2, -1.0, -0.4)),
            ] {
                let scene = clipped.clone().with(thing.clone().shaded(shading)).lit(lamp);
                let row = format!("{name}, {shading:?}, {:?}", scene.lamps[0].at.translation);
                failures.draw(&row, &mut stage, &scene, FLOAT);
            }
        }
    }
    failures.finish();
}

#[test]
fn a_vast_floor_is_lit_however_low_the_camera_is() {
    // The eye is far closer to the plane than to a triangle's centroid: the side must not be decided by rounding.
    // Closer than this the corners themselves, which f32 holds to 10⁻⁷ of the size, rise above the eye.
    let mut stage = Stage::new(32, 32);
    let mut failures = Failures::default();
    for size in [1e2f32, 1e4, 1e6] {
        for height in [1e-3 * size, 1e-5 * size] {
            for faces in [Faces::Front, Faces::Both] {
                for shading in SHADINGS {
                    let floor = Thing::new(Plane { size, divisions: 1 }).shaded(shading).faces(faces);
                    let eye = Vec3::new(0.31 * height, height, 0.2 * height);
                    let mut scene = Scene::seen_from(eye, eye + Vec3::new(0.4, -0.5, -1.0))
                        .with(floor.back(Material::matte(LinearRgba::BLACK)))
                        .lit(Lamp::directional(directional_light(), Vec3::new(0.3, -1.0, -0.2)));
                    scene.camera.projection = scene.camera.projection.with_near(0.2 * height);
                    scene.camera.viewer = Viewer::Infinite;
                    let row = format!("{size:e} wide, seen from {height} above, {shading:?}, {faces:?} faces");
                    let picture = stage.draw(&scene);
                    // The horizon is above the picture: all of it shows the front, which one colour covers.
                    let expected = stage.oracle().probe(16.5, 16.5).color;
                    for (x, y, pixel) in picture.enumerate_pixels() {
                        let close = (0..3).all(|k| (f64::from(pixel.0[k]) - expected[k]).abs() < 1e-4);
                        if !close {
                            failures.unless(false, || {
                                format!("{row}: pixel ({x}, {y}) is {:?}, expected {expected:?}", pixel.0)
                            });
                            break;
                        }
                    }
                }
            }
        }
    }
    failures.finish();
}

#[test]
fn degenerate_triangles_show_nothing_and_spoil_nothing() {
    let toward_eye = [[0.0, 0.0, 1.0]; 6];
    let positions =
        [[-1.0, -1.0, -4.0], [1.0, -1.0, -4.0], [0.0, 1.0, -4.0], [0.0, 0.0, -3.9], [1.0, 1.0, -3.9], [2.0, 2.0, -3.9]];
    // A good triangle, a point, a needle of two corners, three corners on a line.
    let broken = mesh(&positions, &toward_eye, &[3, 3, 3, 0, 1, 2, 3, 4, 4, 3, 4, 5]);
    let whole = mesh(&positions, &toward_eye, &[0, 1, 2]);
    let mut stage = Stage::new(33, 33);
    for shading in SHADINGS {
        let mut draw = |mesh: &Mesh| {
            let thing = Thing::new(mesh.clone()).shaded(shading).faces(Faces::Both);
            stage.draw(&Scene::in_eye_space().with(thing).lit(Lamp::point(point_light(), Vec3::Y)))
        };
        let (broken, whole) = (draw(&broken), draw(&whole));
        assert_identical(&format!("{shading:?}"), &broken, &whole);
        assert!(brightest(&whole) > 0.1);
    }
}

#[test]
fn a_sheet_folded_on_itself_has_normals() {
    // Two triangles back to back on the same corners: their face normals cancel, and the larger one's stands.
    let corners = [[-1.0, -1.0, -4.0], [1.0, -1.0, -4.0], [0.0, 1.0, -4.0]].map(Vec3::from_array);
    let sheet = Mesh::from_parts(corners.to_vec(), None, None, vec![0, 1, 2, 0, 2, 1]).expect("a sheet");
    assert!(sheet.normals().iter().all(|n| (n.length() - 1.0).abs() < 1e-6), "{:?}", sheet.normals());
    let mut stage = Stage::new(33, 33);
    let mut failures = Failures::default();
    for shading in SHADINGS {
        for eye in [Vec3::ZERO, Vec3::Z * -8.0] {
            let scene = Scene::seen_from(eye, Vec3::NEG_Z * 4.0)
                .ambient(0.1)
                .with(Thing::new(sheet.clone()).shaded(shading))
                .lit(Lamp::point(point_light(), Vec3::Y))
                .lit(Lamp::point(point_light(), Vec3::new(0.0, 1.0, -8.0)));
            failures.draw(&format!("{shading:?} from {eye}"), &mut stage, &scene, FLOAT);
        }
    }
    failures.finish();
}

#[test]
fn a_triangle_with_a_nan_is_refused_before_it_is_drawn() {
    for (what, bad) in [("NaN", f32::NAN), ("infinity", f32::INFINITY)] {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, bad, 0.0)].to_vec();
        let error = Mesh::from_parts(corners, None, None, vec![0, 1, 2]).expect_err(what).to_string();
        assert!(error.contains('2'), "{what}: \"{error}\" does not name the vertex");
    }
}

#[test]
fn a_mesh_of_more_vertices_than_16_bits_count_is_drawn_whole() {
    let mut stage = Stage::new(32, 32);
    let mut failures = Failures::default();
    // 66,049 vertices.
    let plane = Plane { size: 3.0, divisions: 256 };
    for shading in SHADINGS {
        let mut scene = Scene::seen_from(Vec3::new(0.0, 4.5, 0.1), Vec3::ZERO)
            .with(Thing::new(plane).shaded(shading))
            .lit(Lamp::point(point_light(), Vec3::new(0.5, 1.0, 0.2)));
        scene.camera.background = LinearRgba::rgb(2.0, 0.0, 0.0);
        let picture = stage.draw(&scene);
        let coarse = Scene { things: vec![Thing::new(Plane { size: 3.0, divisions: 1 })], ..scene.clone() };
        // Cells of a hundredth of a unit: every frequency is Phong's but for the slope within a cell.
        assert_eq!(stage.report().triangles, 2 * 256 * 256);
        stage.draw(&coarse);
        failures.compare(&format!("{shading:?}"), &mut stage, &picture, Bars { most: 2e-2, worst: 3e-2, ..FLOAT });
    }
    failures.finish();
}

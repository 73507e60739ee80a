//! Front and back faces and their materials.

use crate::render::compare::{FLOAT, assert_as_expected, assert_identical, judge};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
const FACES: [Faces; 3] = [Faces::Front, Faces::Back, Faces::Both];

/// The part of a sphere above its equator, open below.
pub(crate) fn hemisphere(segments: u32, rings: u32) -> Mesh {
    let sphere = Mesh::from(UvSphere::new(1.0, segments, rings));
    let above = |corners: &[u32; 3]| corners.iter().all(|&i| sphere.positions()[i as usize].y > -1e-3);
    let indices = sphere.triangles().filter(above).flatten().collect();
    Mesh::from_parts(sphere.positions().to_vec(), Some(sphere.normals().to_vec()), None, indices)
        .expect("half of a valid mesh")
}

/// An open hemisphere seen from below its rim, so that its inside and its outside show.
fn bowl() -> Scene {
    Scene::seen_from(Vec3::new(0.0, -0.9, 3.0), Vec3::new(0.0, 0.4, 0.0))
        .ambient(0.1)
        .with(Thing::new(hemisphere(20, 10)).at(Transform::from_rotation(Quat::from_rotation_z(0.5))))
        .lit(Lamp::point(point_light(), Vec3::new(1.5, -0.5, 2.0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.5, -1.0, -0.8)))
}

#[test]
fn an_open_hemisphere_shows_its_sides_under_every_policy() {
    let mut stage = Stage::new(64, 64);
    for shading in SHADINGS {
        for faces in FACES {
            for back in [None, Some(other_material())] {
                let mut scene = bowl();
                scene.things[0].shading = Some(shading);
                scene.things[0].faces = Some(faces);
                scene.things[0].back = back;
                let row = format!("{shading:?}, {faces:?} faces, back material {}", back.is_some());
                let verdict = assert_as_expected(&row, &mut stage, &scene);
                // A grid of 1/16 pixel turns slopes, where any color around is right: such pixels are judged, and
                // counted apart.
                assert!(verdict.counted + verdict.edges > 0.1, "{row}: {verdict}");
            }
        }
    }
}

/// Also where a slope may show any color around.
#[test]
fn wrong_sides_of_an_open_hemisphere_are_found() {
    let wrongs: [fn(&mut Thing); 4] = [
        |bowl| bowl.faces = Some(Faces::Front),
        |bowl| bowl.faces = Some(Faces::Back),
        |bowl| bowl.back = None,
        |bowl| (bowl.material, bowl.back) = (other_material(), Some(bowl.material)),
    ];
    let mut stage = Stage::new(64, 64);
    for shading in SHADINGS {
        let mut right = bowl();
        let (faces, back) = (Some(Faces::Both), Some(other_material()));
        (right.things[0].shading, right.things[0].faces, right.things[0].back) = (Some(shading), faces, back);
        for (number, spoil) in wrongs.iter().enumerate() {
            let mut wrong = right.clone();
            spoil(&mut wrong.things[0]);
            let picture = Image::from_float(&stage.draw(&wrong));
            stage.set(&right);
            stage.frame();
            let (verdict, _) = judge(&mut stage, &picture, FLOAT);
            assert!(!verdict.is_within(), "{shading:?}, wrong in way {number}: {verdict}");
        }
    }
}

#[test]
fn a_square_shows_each_side_with_its_material_and_normal() {
    let mut stage = Stage::new(33, 33);
    for shading in SHADINGS {
        for (side, eye) in [("front", 3.0), ("back", -3.0)] {
            for faces in FACES {
                let square = Thing::square(Vec3::ZERO, Vec3::Z, 4.0).shaded(shading).faces(faces);
                let matte = |red, blue| Material::matte(LinearRgba::rgb(red, 0.0, blue));
                let scene = Scene::seen_from(Vec3::Z * eye, Vec3::ZERO)
                    .with(square.with_material(matte(0.8, 0.0)).back(matte(0.0, 0.6)))
                    .lit(Lamp::directional(DirectionalLight::white(), Vec3::NEG_Z * eye));
                let row = format!("{shading:?}, {faces:?} faces, seen from the {side}");
                let centre = stage.draw(&scene).get_pixel(16, 16).0;
                // kd·max(n·l, 0) with n·l = 1 on the side seen, 0 and so black on the other.
                let expected = match (side, faces) {
                    ("front", Faces::Front | Faces::Both) => [0.8, 0.0, 0.0],
                    ("back", Faces::Back | Faces::Both) => [0.0, 0.0, 0.6],
                    _ => [0.0; 3],
                };
                for k in 0..3 {
                    assert!((centre[k] - expected[k]).abs() < 1e-6, "{row}: {centre:?}, expected {expected:?}");
                }
            }
        }
    }
}

#[test]
fn back_faces_default_to_the_front_material() {
    let mut stage = Stage::new(48, 48);
    for shading in SHADINGS {
        let mut scene = bowl();
        scene.things[0].shading = Some(shading);
        scene.things[0].faces = Some(Faces::Both);
        let without = stage.draw(&scene);
        scene.things[0].back = Some(scene.things[0].material);
        assert_identical(&format!("{shading:?}"), &without, &stage.draw(&scene));
    }
}

#[test]
fn unlit_sides_have_their_own_emission() {
    let mut stage = Stage::new(9, 9);
    for shading in SHADINGS {
        for (eye, expected) in [(3.0, 0.25), (-3.0, 0.75)] {
            let square = Thing::square(Vec3::ZERO, Vec3::Z, 4.0).faces(Faces::Both).shaded(shading);
            let square = square.with_material(glowing(0.25, 0.25, 0.25)).back(glowing(0.75, 0.75, 0.75));
            let scene = Scene::seen_from(Vec3::Z * eye, Vec3::ZERO).with(square);
            let centre = stage.draw(&scene).get_pixel(4, 4).0;
            assert!((centre[0] - expected).abs() < 1e-7, "{shading:?} from z = {eye}: {centre:?}");
        }
    }
}

#[test]
fn a_sphere_under_both_faces_looks_like_one_under_front_faces() {
    // Its inside is hidden, and the outside is shaded by another variant of the shader.
    let mut stage = Stage::new(48, 48);
    for shading in SHADINGS {
        let scene = |faces| {
            let sphere = Thing::new(UvSphere::new(1.0, 16, 8)).shaded(shading).faces(faces).back(other_material());
            Scene::seen_from(Vec3::new(0.0, 0.5, 3.0), Vec3::ZERO)
                .with(sphere)
                .lit(Lamp::point(point_light(), Vec3::new(1.0, 1.0, 2.0)))
        };
        let (front, both) = (scene(Faces::Front), scene(Faces::Both));
        let row = format!("{shading:?}");
        assert_as_expected(&row, &mut stage, &front);
        assert_as_expected(&row, &mut stage, &both);
    }
}

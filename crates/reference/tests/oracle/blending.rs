//! Blending, and the drawing order.

use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, Mat3, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{AlphaMode, BackMaterial, Faces, Material};
use halfway_mesh::{Cuboid, Mesh};

use crate::scene::{Stage, assert_close, glow, wall};

fn veil(material: Material, opacity: f32) -> impl Bundle {
    (Material { opacity, ..material }, AlphaMode::Blend)
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

fn glowing([red, green, blue]: [f32; 3]) -> Material {
    glow(red, green, blue)
}

fn middle(stage: &mut Stage) -> [f64; 3] {
    stage.draw(3, 3).pixel(1, 1)
}

#[test]
fn blended_objects_are_drawn_back_to_front() {
    let mut stage = Stage::new();
    stage.add(wall(9.0, 2.0), veil(glowing(RED), 0.5));
    stage.add(wall(9.0, 5.0), glowing(BLUE));
    stage.add(wall(9.0, 3.0), veil(glowing(GREEN), 0.25));
    stage.add(wall(9.0, 6.0), veil(glow(8.0, 8.0, 8.0), 0.5));
    // Blue; a quarter of green over it; half of red over that. Surfaces behind the blue are hidden.
    assert_close("order", middle(&mut stage), [0.5, 0.125, 0.375]);
}

#[test]
fn without_blend_opacity_does_nothing() {
    let mut stage = Stage::new();
    stage.add(wall(9.0, 2.0), Material { opacity: 0.25, ..glowing(RED) });
    assert_close("opaque", middle(&mut stage), [1.0, 0.0, 0.0]);
}

#[test]
fn clear_and_full_opacity_are_exact() {
    let mut stage = Stage::new();
    stage.camera().background = bevy_color::LinearRgba::rgb(0.1, 0.2, 0.3);
    stage.add(wall(9.0, 2.0), veil(glow(1e12, 1e12, 1e12), 0.0));
    let background = [0.1f32, 0.2, 0.3].map(f64::from);
    assert_close("clear", middle(&mut stage), background);
    stage.add(wall(9.0, 3.0), veil(glowing(RED), 1.0));
    assert_close("full", middle(&mut stage), [1.0, 0.0, 0.0]);
}

#[test]
fn equal_centres_are_drawn_as_they_were_spawned() {
    // Two walls that cross in their common centre, in either order.
    for (first, second) in [(RED, GREEN), (GREEN, RED)] {
        let mut stage = Stage::new();
        for (color, angle) in [(first, 0.4), (second, -0.3)] {
            let at = Transform::from_xyz(0.0, 0.0, -3.1).with_rotation(bevy_math::Quat::from_rotation_y(angle));
            stage.add_at(wall(2.0, 0.0), at, veil(glowing(color), 0.5));
        }
        let blend = |k: usize| f64::from(0.5 * second[k] + 0.25 * first[k]);
        assert_close("spawned", middle(&mut stage), [0, 1, 2].map(blend));
    }
}

#[test]
fn of_opaque_surfaces_at_one_depth_the_first_stays() {
    let mut stage = Stage::new();
    // Entities in another order than the objects were spawned in.
    let spare: Vec<Entity> = (0..3).map(|_| stage.world.spawn_empty().id()).collect();
    let mesh = stage.mesh(wall(9.0, 2.0));
    for (entity, color) in [(spare[2], RED), (spare[0], GREEN), (spare[1], BLUE)] {
        stage.world.entity_mut(entity).insert((
            halfway_mesh::Mesh3d(mesh.clone()),
            GlobalTransform::IDENTITY,
            glowing(color),
        ));
    }
    let image = stage.draw(9, 9);
    for pixel in image.pixels() {
        assert_close("first", *pixel, [1.0, 0.0, 0.0]);
    }
    // Another plane through the same points, whose depths are rounded otherwise: still the first.
    let tilt =
        Affine3A::from_mat3_translation(Mat3::from_diagonal(Vec3::new(0.7, 1.3, 1.0)), Vec3::new(0.3, -0.1, 0.0));
    stage.add_at(wall(9.0, 2.0), GlobalTransform::from(tilt), glowing(BLUE));
    for pixel in stage.draw(9, 9).pixels() {
        assert_close("first", *pixel, [1.0, 0.0, 0.0]);
    }
}

#[test]
fn within_a_mesh_the_first_triangle_stays() {
    let square = wall(9.0, 2.0);
    let twice: Vec<u32> = square.indices().iter().chain(square.indices()).copied().collect();
    let twice = Mesh::from_parts(square.positions().to_vec(), None, None, twice).expect("a valid mesh");
    let mut stage = Stage::new();
    stage.add(twice, glowing(RED));
    let oracle = stage.oracle(5, 5);
    for (x, y) in (0..5).flat_map(|y| (0..5).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5))) {
        assert!(oracle.probe(x, y).nearest.expect("the wall").triangle.expect("of a mesh") < 2);
    }
}

#[test]
fn a_two_sided_blended_object_draws_its_far_side_first() {
    let mut stage = Stage::new();
    let back = BackMaterial(Material { opacity: 0.25, ..glowing(GREEN) });
    let at = GlobalTransform::from_xyz(0.0, 0.0, -3.0);
    stage.add_at(Cuboid::new(1.0, 1.0, 1.0), at, (veil(glowing(RED), 0.5), back, Faces::Both));
    stage.add(wall(9.0, 5.0), glowing(BLUE));
    assert_close("box", middle(&mut stage), [0.5, 0.125, 0.375]);
    // Triangles the other way round: still the back faces first, now the nearer ones.
    let mut stage = Stage::new();
    let inside_out = Mesh::from(Cuboid::new(1.0, 1.0, 1.0));
    let indices = inside_out.indices().chunks(3).flat_map(|t| [t[0], t[2], t[1]]).collect();
    let inside_out = Mesh::from_parts(inside_out.positions().to_vec(), None, None, indices).expect("a valid mesh");
    stage.add_at(inside_out, at, (veil(glowing(RED), 0.5), back, Faces::Both));
    assert_close("inside out", middle(&mut stage), [0.5, 0.125, 0.0]);
}

#[test]
fn within_a_side_triangles_keep_their_order() {
    // The nearer wall comes first in the mesh, and is drawn under the farther one.
    let near = wall(9.0, 2.0);
    let mut positions = near.positions().to_vec();
    positions.extend(wall(9.0, 4.0).positions());
    let indices = near.indices().iter().copied().chain(near.indices().iter().map(|i| i + 4)).collect();
    let mesh = Mesh::from_parts(positions, None, None, indices).expect("a valid mesh");
    let mut stage = Stage::new();
    stage.add(mesh, veil(glow(1.0, 1.0, 1.0), 0.5));
    let nearest = stage.oracle(3, 3).probe(1.5, 1.5).nearest.expect("a wall");
    assert!((nearest.depth - 2.0).abs() < 1e-12, "the nearest is what is nearest, whatever is drawn last");
    assert_close("both", middle(&mut stage), [0.75; 3]);
}

#[test]
fn clamping_acts_before_blending() {
    let mut stage = Stage::new();
    stage.camera().background = bevy_color::LinearRgba::rgb(4.0, 0.25, 0.0);
    stage.add(wall(9.0, 2.0), veil(glow(0.0, 2.0, 4.0), 0.5));
    assert_close("as it is", middle(&mut stage), [2.0, 1.125, 2.0]);
    let clamped = stage.oracle(3, 3).with_clamping(true).draw();
    assert_close("clamped", clamped.pixel(1, 1), [0.5, 0.625, 0.5]);
}

//! The pixels that a triangle covers.

use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Quat, Vec2, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{AlphaMode, Camera, Faces, Material};
use halfway_mesh::Mesh;

use crate::scene::{Stage, assert_close, glow, panel, ray, triangle, wall};

/// Half-clear white: a pixel that is covered k times holds 1 − 2⁻ᵏ.
fn veil() -> impl Bundle {
    (Material { opacity: 0.5, ..glow(1.0, 1.0, 1.0) }, AlphaMode::Blend, Faces::Both)
}

/// A wobbling grid over the whole picture, its middle vertex and lines exactly on the axes.
fn grid(count: i32, wobble: f32) -> Mesh {
    let line = 2 * count + 1;
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let mut positions = Vec::new();
    for y in -count..=count {
        for x in -count..=count {
            let shift = Vec2::new(random(), random()) * wobble;
            let at =
                Vec2::new(x as f32, y as f32) + shift * Vec2::new(x.signum().abs() as f32, y.signum().abs() as f32);
            positions.push((at * (8.0 / count as f32)).extend(-4.0 - 0.5 * random().abs()));
        }
    }
    let at = |x: i32, y: i32| (y * line + x) as u32;
    let cells = (0..line - 1).flat_map(|y| (0..line - 1).map(move |x| (x, y)));
    let indices = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        if (x + y) % 2 == 0 { [a, b, c, a, c, d] } else { [a, b, d, b, c, d] }
    });
    Mesh::new(positions, indices.collect()).expect("a valid grid")
}

#[test]
fn triangles_that_share_edges_cover_each_pixel_once() {
    for (row, wobble, turn) in [
        ("axes", 0.0, 0.0),
        ("wobbling", 0.3, 0.0),
        ("turned", 0.3, 0.7),
        ("diagonal", 0.0, std::f32::consts::FRAC_PI_4),
    ] {
        for size in [31, 32, 33] {
            let mut stage = Stage::new();
            let at = Transform::from_rotation(Quat::from_rotation_z(turn));
            stage.add_at(grid(12, wobble), at, veil());
            let image = stage.draw(size, size);
            for (i, pixel) in image.pixels().iter().enumerate() {
                assert_close(&format!("{row}, {size}², pixel {i}"), *pixel, [0.5; 3]);
            }
        }
    }
}

#[test]
fn a_vertex_on_a_sample_belongs_to_one_triangle_of_its_fan() {
    for corners in 3..20 {
        let around =
            |i: u32| Vec3::new((i as f32 * 6.2 / corners as f32).cos(), (i as f32 * 6.2 / corners as f32).sin(), -1.0);
        let mut positions = vec![Vec3::NEG_Z];
        positions.extend((0..corners).map(around));
        let indices = (0..corners).flat_map(|i| [0, 1 + i, 1 + (i + 1) % corners]).collect();
        let mut stage = Stage::new();
        stage.add(Mesh::new(positions, indices).expect("a valid fan"), veil());
        assert_close(&format!("{corners} triangles"), stage.draw(5, 5).pixel(2, 2), [0.5; 3]);
    }
}

#[test]
fn left_and_top_edges_are_inside_right_and_bottom_ones_are_not() {
    // Of a picture of odd size the middle row and column lie on the axes.
    for (row, mesh, inside) in [
        ("left", panel(0.0, 1.0, -1.0, 1.0, 2.0), true),
        ("right", panel(-1.0, 0.0, -1.0, 1.0, 2.0), false),
        ("top", panel(-1.0, 1.0, -1.0, 0.0, 2.0), true),
        ("bottom", panel(-1.0, 1.0, 0.0, 1.0, 2.0), false),
    ] {
        let mut stage = Stage::new();
        stage.add(mesh, glow(1.0, 1.0, 1.0));
        assert_eq!(stage.draw(5, 5).covered().expect("known")[12], inside, "{row}");
    }
}

#[test]
fn a_floor_runs_through_the_near_plane_and_behind_the_eye() {
    // Rolled, so that the near plane cuts it along a slanting line.
    let corner = |x: f32, z: f32| Vec3::new(x, -1.0 - 0.5 * x, z);
    let corners = vec![corner(-50.0, 90.0), corner(50.0, 90.0), corner(50.0, -30.0), corner(-50.0, -30.0)];
    let floor = Mesh::new(corners, vec![0, 1, 2, 0, 2, 3]).expect("a valid floor");
    let mut stage = Stage::new();
    stage.camera().projection = stage.camera().projection.with_near(2.0);
    stage.add(floor, glow(1.0, 1.0, 1.0));
    let (width, height) = (64, 48);
    let oracle = stage.oracle(width, height);
    let image = oracle.draw();
    let mut covered = 0;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let ray = ray(x, y, width, height);
        // y = −1 − x/2 on the floor.
        let depth = -1.0 / (ray.y + 0.5 * ray.x);
        let p = ray * depth;
        let expected = (2.0..=30.0).contains(&depth) && p.x.abs() <= 50.0;
        assert_eq!(image.covered().expect("known")[(y * width + x) as usize], expected, "({x}, {y})");
        let seen = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5);
        assert_eq!(seen.nearest.is_some(), expected);
        if let Some(nearest) = seen.nearest {
            assert!((nearest.depth - depth).abs() < 1e-12 * depth && nearest.position.distance(p) < 1e-11);
            covered += 1;
        }
    }
    assert!(covered > 500, "{covered}");
}

#[test]
fn objects_before_the_near_plane_are_not_drawn() {
    let mut stage = Stage::new();
    stage.add(wall(4.0, -2.0), (glow(1.0, 1.0, 1.0), Faces::Both));
    stage.add(wall(4.0, 0.05), glow(1.0, 1.0, 1.0));
    assert!(stage.draw(8, 8).covered().expect("known").iter().all(|covered| !covered));
}

#[test]
fn triangles_without_area_are_not_drawn() {
    let mut stage = Stage::new();
    let looks = || (glow(1.0, 1.0, 1.0), Faces::Both);
    let [a, b] = [Vec3::new(-1.0, 0.0, -2.0), Vec3::new(1.0, 0.0, -2.0)];
    stage.add(triangle([a, b, Vec3::new(0.0, 0.0, -2.0)], None), looks());
    stage.add(triangle([a, b, b], None), looks());
    stage.add(triangle([a, a, a], None), looks());
    // Its upper edge runs through the middle row of samples; its height is rounding.
    stage.add(triangle([a, Vec3::new(0.0, -1e-14, -2.0), b], None), looks());
    // Seen edge on, it covers nothing either.
    stage.add(triangle([a, b, Vec3::new(0.0, 0.0, -3.0)], None), looks());
    assert!(stage.draw(9, 9).covered().expect("known").iter().all(|covered| !covered));
}

#[test]
fn samples_share_a_pixel_that_is_half_covered() {
    let mut stage = Stage::new();
    stage.add(panel(-9.0, 0.0, -9.0, 9.0, 2.0), glow(1.0, 0.5, 2.0));
    // The middle column of three is cut in half.
    for n in [2, 4, 6] {
        let image = stage.oracle(3, 3).with_supersampling(n).draw();
        assert_close("left", image.pixel(0, 1), [1.0, 0.5, 2.0]);
        assert_close("middle", image.pixel(1, 1), [0.5, 0.25, 1.0]);
        assert_close("right", image.pixel(2, 1), [0.0; 3]);
        assert_eq!(&image.covered().expect("known")[3..6], [true, true, false]);
    }
    // Of a 3 × 3 grid a third or two; its middle column lies on the edge, which is a right one.
    assert_close(
        "a third",
        stage.oracle(3, 3).with_supersampling(3).draw().pixel(1, 1),
        [1.0 / 3.0, 0.5 / 3.0, 2.0 / 3.0],
    );
    assert_eq!(stage.oracle(3, 3).with_supersampling(0).draw(), stage.draw(3, 3));
}

#[test]
fn a_wide_picture_is_put_together_from_its_tiles() {
    let (width, height) = (101, 45);
    let mut stage = Stage::new();
    stage.world.entity_mut(stage.camera).insert(Camera::perspective(std::f32::consts::FRAC_PI_2));
    stage.add_at(wall(1.0, 0.0), GlobalTransform::from_xyz(0.5, 0.25, -2.0), glow(1.0, 1.0, 1.0));
    let image = stage.draw(width, height);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let p: DVec3 = 2.0 * ray(x, y, width, height);
        let inside = (-0.5..1.5).contains(&p.x) && p.y > -0.75 && p.y <= 1.25;
        assert_close(&format!("({x}, {y})"), image.pixel(x, y), [f64::from(u8::from(inside)); 3]);
    }
}

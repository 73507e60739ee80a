//! Any point of the picture, and what lies around a pixel's centre.

use bevy_math::{DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::Faces;
use halfway_mesh::UvSphere;

use crate::scene::{Stage, assert_close, glow, panel, ray, scaled, triangle, wall};

const RADIUS: f64 = 1.0 / 32.0;

#[test]
fn the_nearest_thing_has_its_name_side_and_place() {
    let eye = DVec3::new(1.0, 2.0, 0.5);
    let mut stage = Stage::new();
    stage.world.entity_mut(stage.camera).insert(GlobalTransform::from_translation(eye.as_vec3()));
    let far = stage.add(wall(19.0, 5.0), glow(1.0, 0.0, 0.0));
    // Mirrored in depth, it stands 3 before the origin with its front turned away.
    let looks = (glow(0.0, 1.0, 0.0), Faces::Both);
    let near = stage.add_at(panel(-9.0, 1.0, -9.0, 9.0, -3.0), scaled(1.0, 1.0, -1.0), looks);
    let oracle = stage.oracle(8, 8);
    for (x, y, object, front, depth) in [(1, 2, near, false, 3.5), (6, 2, far, true, 5.5)] {
        let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let nearest = oracle.seen(centre.0, centre.1).nearest.expect("a wall");
        assert_eq!((nearest.object, nearest.front), (object, front));
        assert!((nearest.depth - depth).abs() < 1e-12);
        assert!(nearest.position.distance(eye + depth * ray(x, y, 8, 8)) < 1e-12);
        let (back_x, back_y) = oracle.project(nearest.position).expect("before the eye");
        assert!((back_x - centre.0).abs() < 1e-12 && (back_y - centre.1).abs() < 1e-12);
    }
    assert_eq!(oracle.project(eye - 0.05 * DVec3::Z), None, "before the near plane");
}

#[test]
fn inside_a_triangle_there_is_no_edge() {
    let mut stage = Stage::new();
    stage.add(wall(9.0, 2.0), glow(0.5, 0.25, 0.125));
    let around = stage.oracle(8, 8).around(2, 5, RADIUS);
    assert!(around.edge, "the diagonal of the square");
    let around = stage.oracle(8, 8).around(2, 3, RADIUS);
    assert!(!around.edge);
    assert_close("low", around.low, [0.5, 0.25, 0.125]);
    assert_close("high", around.high, [0.5, 0.25, 0.125]);
}

#[test]
fn an_edge_near_the_centre_shows_both_sides_and_what_is_behind() {
    for (offset, edge) in [(0.5, true), (-0.5, true), (2.0, false), (-2.0, false)] {
        let mut stage = Stage::new();
        // The picture is 16 pixels of 1/8 at depth 1; the centre of pixel 8 lies at 1/16.
        let at = 0.0625 + offset as f32 * RADIUS as f32 / 8.0;
        stage.add(panel(at, 9.0, -9.0, 9.0, 1.0), glow(1.0, 0.0, 0.0));
        stage.add(panel(-9.0, 9.0, -19.0, 9.0, 2.0), glow(0.0, 1.0, 0.0));
        let around = stage.oracle(16, 16).around(8, 3, RADIUS);
        assert_eq!(around.edge, edge, "{offset}");
        if edge {
            assert_close("low", around.low, [0.0; 3]);
            assert_close("high", around.high, [1.0, 1.0, 0.0]);
        }
    }
}

#[test]
fn a_silhouette_against_the_background_is_an_edge() {
    let mut stage = Stage::new();
    stage.add(panel(0.0, 9.0, -9.0, 9.0, 2.0), glow(1.0, 1.0, 1.0));
    let around = stage.oracle(5, 5).around(2, 1, RADIUS);
    assert!(around.edge);
    assert_close("low", around.low, [0.0; 3]);
    assert_close("high", around.high, [1.0; 3]);
}

#[test]
fn slivers_between_the_probes_count() {
    // A needle a thousandth of a pixel wide that passes a hundredth of a pixel beside the centre.
    let pixel = 1.0 / 8.0;
    let [left, right] = [0.01, 0.011].map(|x| 0.0625 + x as f32 * pixel);
    let needle = [Vec3::new(left, -1.0, -1.0), Vec3::new(right, -1.0, -1.0), Vec3::new(left, 1.0, -1.0)];
    for (depth_of_wall, edge) in [(2.0, true), (0.5, false)] {
        let mut stage = Stage::new();
        stage.add(panel(-9.0, 9.0, -19.0, 9.0, depth_of_wall), glow(0.0, 1.0, 0.0));
        stage.add(triangle(needle, None), glow(1.0, 0.0, 0.0));
        let around = stage.oracle(16, 16).around(8, 3, RADIUS);
        assert_eq!(around.edge, edge, "a wall at {depth_of_wall}");
        assert_close("high", around.high, [f64::from(u8::from(edge)), 1.0, 0.0]);
    }
}

#[test]
fn surfaces_too_close_to_tell_apart_are_an_edge() {
    for (gap, edge) in [(1e-7, true), (1e-5, false)] {
        let mut stage = Stage::new();
        stage.add(panel(-9.0, 9.0, -19.0, 9.0, 1.0), glow(0.0, 1.0, 0.0));
        stage.add(panel(-9.0, 9.0, -19.0, 9.0, 1.0 + gap), glow(1.0, 0.0, 0.0));
        assert_eq!(stage.oracle(16, 16).around(8, 3, RADIUS).edge, edge, "{gap}");
    }
}

#[test]
fn probes_stay_on_the_picture() {
    let mut stage = Stage::new();
    stage.add_at(UvSphere::new(1.0, 32, 16), GlobalTransform::from_xyz(0.0, 0.0, -1.5), glow(1.0, 1.0, 1.0));
    let oracle = stage.oracle(7, 5);
    for (x, y) in (0..5).flat_map(|y| (0..7).map(move |x| (x, y))) {
        let around = oracle.around(x, y, 3.0);
        assert!((0..3).all(|k| around.low[k].is_finite() && around.low[k] <= around.high[k]));
    }
}

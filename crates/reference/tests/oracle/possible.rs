//! The colours that a pixel may show.

use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{AlphaMode, BackMaterial, Camera, Faces, Material, PointLight, Samples, Shading, SpotLight};
use halfway_mesh::{Mesh, UvSphere};
use halfway_reference::{ColorRange, Possible};

use crate::scene::{Stage, assert_close, glow, panel, triangle, wall};

const RADIUS: f64 = 1.0 / 16.0;
/// The pictures here have 16 × 16 pixels, of 1/8 at depth 1; the centre of pixel 8 lies at 1/16.
const PIXEL: f32 = 1.0 / 8.0;
const CENTRE: f32 = 1.0 / 16.0;

fn possible(stage: &mut Stage, x: u32, y: u32) -> Possible {
    stage.oracle(16, 16).possible(x, y, RADIUS)
}

/// Fails unless exactly these colours may be shown, in any order.
fn assert_shows(what: &str, found: &Possible, expected: &[[f64; 3]]) {
    assert_eq!(found.ranges.len(), expected.len(), "{what}: {found:?}");
    for color in expected {
        let near = |a: &[f64; 3]| (0..3).all(|k| (a[k] - color[k]).abs() < 1e-12);
        assert!(found.ranges.iter().any(|range| near(&range.low) && near(&range.high)), "{what}: {color:?}, {found:?}");
    }
}

#[test]
fn inside_a_surface_there_is_one_color() {
    let mut stage = Stage::new();
    stage.add(wall(9.0, 2.0), glow(0.5, 0.25, 0.125));
    // (3, 12) lies on the square's diagonal.
    for (x, y) in [(3, 12), (3, 3)] {
        let found = possible(&mut stage, x, y);
        assert_shows("a wall", &found, &[[0.5, 0.25, 0.125]]);
        assert!(!found.is_edge);
    }
}

#[test]
fn only_an_edge_within_the_radius_shows_both_sides() {
    for (offset, is_edge) in [(0.9, true), (-0.9, true), (1.1, false), (-1.1, false)] {
        let mut stage = Stage::new();
        let at = CENTRE + offset * RADIUS as f32 * PIXEL;
        stage.add(panel(at, 9.0, -9.0, 9.0, 1.0), glow(1.0, 0.0, 0.0));
        stage.add(panel(-19.0, 9.0, -19.0, 9.0, 2.0), glow(0.0, 1.0, 0.0));
        let found = possible(&mut stage, 8, 3);
        assert_eq!(found.is_edge, is_edge, "{offset}");
        let (red, green) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let expected = if is_edge { vec![red, green] } else { vec![if offset < 0.0 { red } else { green }] };
        assert_shows(&format!("{offset}"), &found, &expected);
    }
}

#[test]
fn a_silhouette_against_the_background_is_an_edge() {
    let mut stage = Stage::new();
    stage.add(panel(CENTRE, 9.0, -9.0, 9.0, 1.0), glow(1.0, 1.0, 1.0));
    assert_shows("a silhouette", &possible(&mut stage, 8, 3), &[[0.0; 3], [1.0; 3]]);
}

/// A square of two triangles, cut from top to bottom through the pixels of column 8, with or without its halves' common
/// vertices at one place.
fn halves(gap: f32) -> Mesh {
    let at = |x: f32, y: f32| Vec3::new(x, y, -1.0);
    let (left, right) = (CENTRE - gap, CENTRE + gap);
    let corners = [at(-9.0, -9.0), at(left, -9.0), at(left, 9.0), at(-9.0, 9.0)];
    let others = [at(right, -9.0), at(9.0, -9.0), at(9.0, 9.0), at(right, 9.0)];
    let indices = vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7];
    Mesh::from_parts([corners, others].concat(), None, None, indices).expect("two rectangles")
}

#[test]
fn nothing_shows_through_an_inner_edge() {
    for (gap, colors) in [(0.0, 1), (1e-4, 2)] {
        let mut stage = Stage::new();
        stage.add(halves(gap), glow(1.0, 0.0, 0.0));
        stage.add(wall(30.0, 2.0), glow(0.0, 1.0, 0.0));
        let found = possible(&mut stage, 8, 3);
        assert_shows(&format!("a gap of {gap}"), &found, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][..colors]);
    }
    // Two objects with the same transform meet along the edge: their vertices go to the same places.
    let mut stage = Stage::new();
    stage.add(panel(-9.0, CENTRE, -9.0, 9.0, 1.0), glow(1.0, 0.0, 0.0));
    stage.add(panel(CENTRE, 9.0, -9.0, 9.0, 1.0), glow(0.0, 0.0, 1.0));
    stage.add(wall(30.0, 2.0), glow(0.0, 1.0, 0.0));
    assert_shows("two parts", &possible(&mut stage, 8, 3), &[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn nothing_shows_through_a_closed_mesh() {
    // 96 × 48: triangles of less than a pixel, with poles and a seam, before a wall.
    let mut stage = Stage::new();
    let sphere =
        stage.add_at(UvSphere::new(1.0, 96, 48), GlobalTransform::from_xyz(0.1, 0.2, -2.0), glow(1.0, 0.0, 0.0));
    stage.add(wall(30.0, 8.0), glow(0.0, 1.0, 0.0));
    let oracle = stage.oracle(64, 64);
    let mut inside = 0;
    for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
        let at = |i: u32, j: u32| oracle.probe(f64::from(x) + f64::from(i) / 4.0, f64::from(y) + f64::from(j) / 4.0);
        let corners = (0..5).flat_map(|j| (0..5).map(move |i| (i, j)));
        let objects: Vec<_> = corners.map(|(i, j)| at(i, j).nearest.expect("the wall is behind").object).collect();
        let found = oracle.possible(x, y, RADIUS);
        if objects.iter().all(|object| *object == sphere) {
            inside += 1;
            assert_shows(&format!("({x}, {y})"), &found, &[[1.0, 0.0, 0.0]]);
        } else if objects.iter().all(|object| *object != sphere) {
            assert_shows(&format!("({x}, {y})"), &found, &[[0.0, 1.0, 0.0]]);
        }
    }
    assert!(inside > 500, "{inside} pixels of the sphere");
}

#[test]
fn slivers_are_seen_unless_something_hides_them() {
    // A needle a thousandth of a pixel wide that passes a hundredth of a pixel beside the centre.
    let [left, right] = [0.01, 0.011].map(|x| CENTRE + x * PIXEL);
    let needle = [Vec3::new(left, -1.0, -1.0), Vec3::new(right, -1.0, -1.0), Vec3::new(left, 1.0, -1.0)];
    for (depth_of_wall, colors) in [(2.0, 2), (0.5, 1)] {
        let mut stage = Stage::new();
        stage.add(panel(-9.0, 9.0, -19.0, 9.0, depth_of_wall), glow(0.0, 1.0, 0.0));
        stage.add(triangle(needle, None), glow(1.0, 0.0, 0.0));
        let found = possible(&mut stage, 8, 3);
        assert_shows(&format!("a wall at {depth_of_wall}"), &found, &[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]][..colors]);
    }
}

#[test]
fn depths_too_close_to_tell_apart_may_come_out_either_way() {
    for (gap, colors) in [(1e-7, 2), (1e-4, 1)] {
        let mut stage = Stage::new();
        stage.add(panel(-9.0, 9.0, -9.0, 9.0, 1.0), glow(0.0, 1.0, 0.0));
        stage.add(panel(-9.0, 9.0, -9.0, 9.0, 1.0 + gap), glow(1.0, 0.0, 0.0));
        assert_shows(&format!("{gap}"), &possible(&mut stage, 8, 3), &[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]][..colors]);
    }
}

#[test]
fn of_coincident_triangles_the_first_spawned_is_seen() {
    for (first, second) in [([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])] {
        let mut stage = Stage::new();
        for [red, green, blue] in [first, second] {
            stage.add(wall(9.0, 2.0), glow(red, green, blue));
        }
        let expected = first.map(f64::from);
        assert_shows("of one mesh", &possible(&mut stage, 8, 3), &[expected]);
        assert_close("drawn", stage.draw(16, 16).pixel(8, 3), expected);
        // An unrelated object before them changes nothing.
        stage.add(
            triangle([Vec3::new(-1.0, -1.0, -1.0), Vec3::new(-0.9, -1.0, -1.0), Vec3::new(-1.0, -0.9, -1.0)], None),
            Material::DEFAULT,
        );
        assert_shows("with another", &possible(&mut stage, 8, 3), &[expected]);
    }
}

#[test]
fn of_coincident_triangles_of_different_meshes_either_is_seen() {
    let colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let square = wall(9.0, 2.0);
    let halves = square.indices().iter().skip(3).chain(square.indices().iter().take(3)).copied().collect();
    let other = Mesh::from_parts(square.positions().to_vec(), None, None, halves).expect("the same triangles");
    let mut stage = Stage::new();
    for (mesh, [red, green, blue]) in [square, other].into_iter().zip(colors) {
        stage.add(mesh, glow(red, green, blue));
    }
    assert_shows("of two meshes", &possible(&mut stage, 8, 3), &colors.map(|color| color.map(f64::from)));
}

#[test]
fn blended_layers_come_in_the_order_of_drawing() {
    let glass = |red: f32, green: f32| (Material { opacity: 0.5, ..glow(red, green, 0.0) }, AlphaMode::Blend);
    let mut stage = Stage::new();
    stage.add(panel(CENTRE, 9.0, -9.0, 9.0, 1.0), glass(1.0, 0.0));
    stage.add(wall(9.0, 2.0), glass(0.0, 1.0));
    stage.add(wall(30.0, 3.0), glow(0.0, 0.0, 1.0));
    // Through the green one; or the red one over that. Never the red one alone, nor the green one over it.
    assert_shows("an edge", &possible(&mut stage, 8, 3), &[[0.0, 0.5, 0.5], [0.5, 0.25, 0.25]]);
    assert_shows("two layers", &possible(&mut stage, 12, 3), &[[0.5, 0.25, 0.25]]);
}

#[test]
fn the_far_side_of_a_blended_object_comes_before_its_near_side() {
    let near = Material { opacity: 0.5, ..glow(1.0, 0.0, 0.0) };
    let far = BackMaterial(Material { opacity: 0.5, ..glow(0.0, 1.0, 0.0) });
    let mut stage = Stage::new();
    let at = GlobalTransform::from_xyz(0.0, 0.0, -3.0);
    stage.add_at(UvSphere::new(2.0, 32, 16), at, (near, far, Faces::Both, AlphaMode::Blend));
    assert_shows("both sides", &possible(&mut stage, 8, 8), &[[0.5, 0.25, 0.0]]);
}

#[test]
fn facets_within_the_radius_may_swap_and_no_others() {
    let mut stage = Stage::new();
    let light = PointLight::white();
    stage.world.spawn((light, GlobalTransform::from_xyz(1.0, 3.0, 2.0)));
    let at = GlobalTransform::from_xyz(0.0, 0.0, -3.0);
    stage.add_at(UvSphere::new(2.0, 32, 16), at, (Material::default(), Shading::Flat));
    let oracle = stage.oracle(16, 16);
    let picture = oracle.draw();
    let mut edges = 0;
    for (x, y) in (4..12).flat_map(|y| (4..12).map(move |x| (x, y))) {
        let found = oracle.possible(x, y, RADIUS);
        let bits = |color: [f64; 3]| color.map(f64::to_bits);
        let holds = |range: &ColorRange| [range.low, range.high].map(bits) == [bits(picture.pixel(x, y)); 2];
        assert!(found.ranges.iter().any(holds), "({x}, {y})");
        assert_eq!(found.is_edge, found.ranges.len() > 1, "({x}, {y})");
        edges += usize::from(found.is_edge);
    }
    assert!(edges > 0 && edges < 64, "{edges} of 64 pixels beside an edge");
}

#[test]
fn the_edge_of_a_cone_is_a_jump_and_a_slope_is_none() {
    // The cone's edge passes beside the centre of pixel (12, 8), `beside` pixels farther out.
    let center = (4.5 * PIXEL).hypot(0.5 * PIXEL);
    for (beside, is_edge) in [(0.03, true), (-0.03, true), (0.1, false), (-0.1, false)] {
        let mut stage = Stage::new();
        stage.add(wall(9.0, 1.0), (Material::default(), Shading::Phong));
        let cutoff = (center + beside * PIXEL).atan();
        stage.world.spawn((SpotLight::white(cutoff), GlobalTransform::IDENTITY));
        let found = possible(&mut stage, 12, 8);
        assert_eq!((found.is_edge, found.ranges.len()), (is_edge, 1), "{beside}: {found:?}");
    }
}

#[test]
fn with_four_samples_each_may_see_its_own() {
    let mut stage = Stage::new();
    *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
    // Between the samples at 3/8 and 5/8 of the pixel's width, away from both.
    stage.add(panel(CENTRE, 9.0, -9.0, 9.0, 1.0), glow(1.0, 1.0, 1.0));
    assert_shows("a half", &possible(&mut stage, 8, 3), &[[0.5; 3]]);
    // Through the one at 3/8.
    let left = 0.99 * (CENTRE - 0.125 * PIXEL);
    stage.add(panel(left, left + PIXEL, -9.0, 9.0, 0.99), glow(1.0, 1.0, 1.0));
    assert_shows("an edge", &possible(&mut stage, 8, 3), &[[0.5; 3], [0.75; 3]]);
}

#[test]
fn with_four_samples_the_centre_alone_shows_nothing() {
    let mut stage = Stage::new();
    *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
    // Between the samples at 3/8 and 5/8 of the pixel's width: only the oracle's own picture meets it.
    stage.add(panel(CENTRE - 0.01 * PIXEL, CENTRE + 0.01 * PIXEL, -9.0, 9.0, 1.0), glow(1.0, 1.0, 1.0));
    let found = possible(&mut stage, 8, 3);
    assert_shows("the background", &found, &[[0.0; 3]]);
    assert!(found.is_edge, "a picture without it would be compared with one that has it");
}

#[test]
fn every_pixel_may_show_what_the_oracle_draws() {
    let mut stage = Stage::new();
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(1.0, 3.0, 2.0)));
    let at = GlobalTransform::from_xyz(0.0, 0.0, -1.5);
    stage.add_at(
        UvSphere::new(1.0, 32, 16),
        at,
        (Material { opacity: 0.7, ..Material::default() }, AlphaMode::Blend, Faces::Both),
    );
    stage.add_at(UvSphere::new(0.5, 7, 5), at, (Material::default(), Shading::Gouraud));
    // The floor passes below the eye and through both.
    let floor = [Vec3::new(-9.0, -0.3, 1.0), Vec3::new(9.0, -0.3, 1.0), Vec3::new(0.0, -0.3, -40.0)];
    stage.add(triangle(floor, None), (Material::default(), Faces::Both, Shading::Phong));
    let oracle = stage.oracle(31, 23);
    let picture = oracle.draw();
    for (x, y) in (0..23).flat_map(|y| (0..31).map(move |x| (x, y))) {
        let (found, color) = (oracle.possible(x, y, RADIUS), picture.pixel(x, y));
        let holds =
            |range: &ColorRange| (0..3).all(|k| range.low[k] <= color[k] + 1e-9 && color[k] <= range.high[k] + 1e-9);
        assert!(found.ranges.iter().any(holds), "({x}, {y}): {color:?}, {found:?}");
    }
}

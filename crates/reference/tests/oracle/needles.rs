//! Triangles inside a mesh that are a fraction of a pixel wide: the judge finds where one is missing.

use bevy_math::{Vec2, Vec3};
use halfway_mesh::Mesh;

use crate::mutants::{all_pixels, assert_caught, at_pixel, float, lit_before_a_wall, oracle, with, without};

/// A square before the camera, cut from top to bottom by a needle so many pixels wide at its upper end, which leans so
/// that it passes some centres. The needle is the first triangle; its edges are its neighbours', too.
fn cut_by_a_needle(width: f32) -> Mesh {
    let [low, high] = [Vec2::new(44.3, 80.2), Vec2::new(50.1, 12.4)];
    let corners = [low, high, high + width * Vec2::X, Vec2::new(14.0, 12.4), Vec2::new(14.0, 80.2)];
    let corners = corners.into_iter().chain([Vec2::new(84.0, 12.4), Vec2::new(84.0, 80.2)]);
    let positions: Vec<Vec3> = corners.map(|corner| at_pixel(2.0 * Vec3::NEG_Z, corner)).collect();
    let indices = vec![0, 2, 1, 0, 1, 3, 0, 3, 4, 0, 5, 2, 0, 6, 5];
    Mesh::from_parts(positions, Some(vec![Vec3::Z; 7]), None, indices).expect("five triangles")
}

#[test]
fn a_missing_needle_is_found() {
    let scene = lit_before_a_wall;
    for width in [0.5, 0.25, 0.1, 0.05, 0.03] {
        let mesh = cut_by_a_needle(width);
        let mut truth = scene(&mesh);
        let (right, wrong) = (oracle(&mut truth).draw(), oracle(&mut scene(&without(&mesh, 0))).draw());
        let verdict = float(&oracle(&mut truth), &right);
        assert!(verdict.is_within(), "a needle of {width} pixels: {verdict}");
        let shows = |(x, y): &(u32, u32)| (right.pixel(*x, *y)[0] - wrong.pixel(*x, *y)[0]).abs() > 0.1;
        let covered: Vec<_> = all_pixels().filter(shows).collect();
        assert!(!covered.is_empty(), "a needle of {width} pixels covers no centre");
        assert_caught(&format!("a needle of {width} pixels missing"), &mut truth, &wrong);
        // One centre is enough.
        let (x, y) = covered[covered.len() / 2];
        let one = with(&right, [((x, y), wrong.pixel(x, y))]);
        assert_caught(&format!("a needle of {width} pixels missing at a centre"), &mut truth, &one);
    }
}

//! Vertices on the grid that a rasterizer rounds to.

use bevy_color::LinearRgba;
use bevy_math::{Vec2, Vec3, Vec4};
use halfway_asset::Assets;
use halfway_lighting::{GlobalAmbient, Material};
use halfway_mesh::Mesh;
use halfway_reference::Image;
use halfway_reference::metrics::{Bars, judge};
use halfway_texture::{MapKind, Maps, TexelImage, Texture};

use crate::mutants::{on_grid, with};
use crate::scene::{Stage, panel};

/// A rectangle at depth 1 with a colour at each corner, on a picture of 16 × 16 pixels that shows 2 × 2 units there.
fn ramp(left: f32, right: f32, bottom: f32, top: f32) -> Stage {
    let mut stage = Stage::new();
    stage.world.insert_resource(GlobalAmbient(LinearRgba::WHITE));
    let colors = [[0.1, 0.2], [0.9, 0.4], [0.8, 0.9], [0.3, 0.6]].map(|[r, g]| Vec4::new(r, g, 0.5, 1.0));
    let mesh: Mesh = panel(left, right, bottom, top, 1.0).with_colors(colors.to_vec()).expect("a colour a vertex");
    stage.add(mesh, Material { ambient: LinearRgba::WHITE, diffuse: LinearRgba::BLACK, ..Material::DEFAULT });
    stage
}

fn difference(a: &Image, b: &Image) -> f64 {
    let channels = |image: &Image| image.pixels().iter().flatten().copied().collect::<Vec<f64>>();
    channels(a).into_iter().zip(channels(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn interpolation_uses_the_rounded_corners() {
    // Corners at 2.15 and 10.15 pixels, which whole pixels bring to 2 and 10, and quarters to 2.25 and 10.25.
    let mut stage = ramp(-0.73125, 0.26875, -0.26875, 0.73125);
    let exact = stage.oracle(16, 16).draw();
    for (bits, moved) in [(0, -0.15 / 8.0), (2, 0.1 / 8.0)] {
        let on_grid = stage.oracle(16, 16).on_grid(bits).draw();
        let mut by_hand = ramp(-0.73125 + moved, 0.26875 + moved, -0.26875 - moved, 0.73125 - moved);
        let expected = by_hand.oracle(16, 16).draw();
        // Positions are f32.
        let error = difference(&on_grid, &expected);
        assert!(error < 1e-6, "{bits} bits: {error}");
        assert!(difference(&on_grid, &exact) > 1e-3, "{bits} bits move nothing");
    }
    assert!(difference(&stage.oracle(16, 16).on_grid(24).draw(), &exact) < 1e-6);
}

/// Strips one above the other, 0.15 pixels high, on each of which the same spot of an image shrinks alike. A grid of
/// sixteenths of a pixel makes a strip a sixth lower or a quarter higher, and so more or fewer texels go to a pixel.
fn strips() -> Stage {
    // At depth 1, where a pixel is 1/8.
    let height = 0.15 / 8.0;
    let mut stage = Stage::new();
    stage.world.insert_resource(GlobalAmbient(LinearRgba::WHITE));
    // Whole texels of the third level, and quarters of the fourth.
    let is_bright = |i: u32| (32..36).contains(&i);
    let texel = |x, y| if is_bright(x) && is_bright(y) { [1.0, 0.5, 0.25, 1.0] } else { [0.1, 0.1, 0.1, 1.0] };
    let image = TexelImage::from_fn(64, 64, texel).expect("finite texels");
    let mut textures = Assets::<Texture>::default();
    let texture = textures.add(Texture::from(image));
    stage.world.insert_resource(textures);
    // 5.7 texels a pixel, which lies between the two levels.
    let [middle, half] = [34.0, 0.5 * 5.7 * 0.15].map(|texels| texels / 64.0);
    let uvs = [middle + half, middle - half].map(|v| [Vec2::new(middle, v); 2]).concat();
    for i in 0..40 {
        let bottom = -0.371 + height * i as f32;
        let [low, high] = [bottom, bottom + height];
        let corners = [(-0.7, low), (0.7, low), (0.7, high), (-0.7, high)].map(|(x, y)| Vec3::new(x, y, -1.0));
        let strip = Mesh::from_parts(corners.to_vec(), None, Some(uvs.clone()), vec![0, 1, 2, 0, 2, 3]);
        let looks = Material { ambient: LinearRgba::WHITE, diffuse: LinearRgba::BLACK, ..Material::DEFAULT };
        stage.add(strip.expect("a rectangle"), (looks, Maps::new(MapKind::Color, texture.clone())));
    }
    stage
}

#[test]
fn a_picture_on_the_grid_passes_only_as_a_whole() {
    let mut stage = strips();
    let exact = stage.oracle(16, 16);
    let (expected, picture) = (exact.draw(), stage.oracle(16, 16).on_grid(4).draw());
    let verdict = judge(&exact, &expected, &picture, Bars::FLOAT).expect("one size");
    assert!(!verdict.is_within(), "by the exact triangles: {verdict}");
    let by_either = |picture: &Image| on_grid(&exact, 4, picture);
    let verdict = by_either(&picture);
    assert!(verdict.is_within(), "by either: {verdict}");
    let verdict = by_either(&expected);
    assert!(verdict.is_within(), "the exact picture: {verdict}");
    // A pixel off by ten bars, and one that is right by the other rule.
    for (x, y) in (5..11).map(|y| (7, y)) {
        let brighter = picture.pixel(x, y).map(|channel| channel + 0.02);
        for (fault, color) in [("brighter", brighter), ("exact", expected.pixel(x, y))] {
            let verdict = by_either(&with(&picture, [((x, y), color)]));
            assert!(!verdict.is_within(), "({x}, {y}) is {fault}, {color:?}: {verdict}");
        }
    }
}

/// A grid of 1/256 of a pixel moves a slope of a fifth of the range a pixel by twice the bar at most.
#[test]
fn a_fine_grid_is_judged_by_either_rule_too() {
    // Four pixels wide; the corners are 0.45/256 of a pixel beside the grid's places.
    let beside = 0.45 / 256.0 / 8.0;
    let moved = |by: f32| ramp(-0.25 + by, 0.25 + by, -0.25 + by, 0.25 + by).oracle(16, 16);
    let slope = || moved(beside);
    let (exact, picture) = (slope(), slope().on_grid(8).draw());
    let expected = exact.draw();
    let by_either = |picture: &Image| on_grid(&exact, 8, picture);
    let verdict = judge(&exact, &expected, &picture, Bars::FLOAT).expect("one size");
    assert!(!verdict.is_within(), "by the exact triangles: {verdict}");
    let verdict = by_either(&picture);
    assert!(verdict.is_within(), "by either: {verdict}");
    // On the next places of the grid, a pixel off by ten bars, and one that is right by the other rule.
    let next = moved(1.0 / 256.0 / 8.0).draw();
    let brighter = with(&picture, [((8, 8), picture.pixel(8, 8).map(|channel| channel + 0.02))]);
    let exact_there = with(&picture, [((8, 8), expected.pixel(8, 8))]);
    for (fault, picture) in [("the next places", &next), ("brighter", &brighter), ("exact", &exact_there)] {
        let verdict = by_either(picture);
        assert!(!verdict.is_within(), "{fault}: {verdict}");
    }
}

/// A corner in the middle between two points of a grid of sixteenths may snap to either, independently of others; one a
/// hundredth of a pixel beside the middle may not, and no corner snaps farther away.
#[test]
fn ties_go_to_either_side() {
    // Pixels are 1/8 of a unit, and half a place 1/256. One corner at a time is moved by some places from the lower
    // ones of the grid.
    let at = |beside: f32| move |places: f32| -0.5 + (0.5 + beside + places) / 128.0;
    let scene = |beside: f32, places: [f32; 4]| {
        let [left, right, bottom, top] = places.map(at(beside));
        ramp(left, 1.0 + right, bottom, 1.0 + top)
    };
    let judged = |beside: f32, picture: &Image| on_grid(&scene(beside, [0.0; 4]).oracle(16, 16), 4, picture);
    for ways in 0..16_u32 {
        let picture = |beside: f32, farther: f32| {
            let place = |way: u32| if ways >> way & 1 == 1 { 0.5 + farther } else { -0.5 - farther } - beside;
            scene(beside, [0, 1, 2, 3].map(place)).oracle(16, 16).draw()
        };
        let verdict = judged(0.0, &picture(0.0, 0.0));
        assert!(verdict.is_within(), "{ways:04b}: {verdict}");
        // By less the slopes here change by no more than the bars allow.
        let verdict = judged(0.0, &picture(0.0, 2.0));
        assert!(!verdict.is_within(), "{ways:04b}, two places farther: {verdict}");
        // Less than the half place is to the nearest one, of which each side has one.
        for beside in [-0.16, 0.16] {
            let nearest = if beside > 0.0 { 15 } else { 0 };
            let verdict = judged(beside, &picture(beside, 0.0));
            assert_eq!(verdict.is_within(), ways == nearest, "{ways:04b}, {beside} beside: {verdict}");
        }
    }
}

/// Some renderers clip triangles at the sides of the picture and snap the new corners to the grid as well: an edge then
/// passes through other grid points than its unclipped ends do, while the two triangles on it are interpolated as
/// before.
#[test]
fn edges_of_cut_triangles_may_lead_through_other_places() {
    // In pixels. From end to end of the edge on the grid the middle of the pixel (3, 7) lies 0.03 pixels above it, and
    // from side to side of the picture 0.01 below.
    let (ends, pixel) = ([[-18.12, 6.4192], [33.79, 9.0519]], (3, 7));
    let place = |[x, y]: [f32; 2]| Vec3::new(x / 8.0 - 1.0, 1.0 - y / 8.0, -1.0);
    for (slope_is_above, third) in [(true, [8.0, -20.0]), (false, [8.0, 40.0])] {
        let mut stage = Stage::new();
        stage.world.insert_resource(GlobalAmbient(LinearRgba::WHITE));
        let mut add = |corners: [[f32; 2]; 3], colors: [f32; 3], indices: [u32; 3]| {
            let mesh = Mesh::from_parts(corners.map(place).to_vec(), None, None, indices.to_vec()).expect("a triangle");
            let colors = colors.map(|grey| Vec4::new(grey, grey, grey, 1.0)).to_vec();
            let looks = Material { ambient: LinearRgba::WHITE, diffuse: LinearRgba::BLACK, ..Material::DEFAULT };
            stage.add(mesh.with_colors(colors).expect("a colour a vertex"), looks);
        };
        // Counter-clockwise as seen.
        let windings = [[0, 1, 2], [1, 0, 2]];
        let [of_slope, of_flat] = if slope_is_above { windings } else { [windings[1], windings[0]] };
        let slope = [ends[0], ends[1], third];
        add(slope, [0.1, 0.9, 0.5], of_slope);
        add([ends[0], ends[1], [8.0, 20.0 - third[1]]], [0.7; 3], of_flat);
        let exact = stage.oracle(16, 16);
        let picture = stage.oracle(16, 16).on_grid(4).draw();
        // The slope's colour there, within its edge or beyond.
        let [a, b, c] = slope.map(|corner| corner.map(|along| (f64::from(along) * 16.0).round() / 16.0));
        let area =
            |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let on_slope = |p: [f64; 2]| (0.1 * area(p, b, c) + 0.9 * area(a, p, c) + 0.5 * area(a, b, p)) / area(a, b, c);
        let shows = |pixel: (u32, u32), slope: bool| {
            let at = [pixel.0, pixel.1].map(|along| f64::from(along) + 0.5);
            (pixel, [if slope { on_slope(at) } else { 0.7 }; 3])
        };
        let cut = shows(pixel, !slope_is_above);
        let drawn = with(&picture, [cut]);
        let verdict = judge(&exact, &exact.draw(), &drawn, Bars::FLOAT).expect("one size");
        assert!(!verdict.is_within(), "{slope_is_above}, by the exact triangles: {verdict}");
        let verdict = on_grid(&exact, 4, &drawn);
        assert!(verdict.is_within(), "{slope_is_above}: {verdict}");
        // Neither of the two colours, and the other one farther from the edge.
        let brighter = (pixel, cut.1.map(|channel| channel + 0.02));
        for fault in [brighter, shows((3, 6), !slope_is_above), shows((3, 8), slope_is_above)] {
            let verdict = on_grid(&exact, 4, &with(&drawn, [fault]));
            assert!(!verdict.is_within(), "{slope_is_above}, {fault:?}: {verdict}");
        }
    }
}

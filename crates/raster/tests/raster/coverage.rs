//! Coverage of triangles, against an exact fill rule in 64 bits on the same corners of the grid.

use crate::common::{Scene, Shading, at, draw};
use halfway_lighting::record::{Cull, MaterialRecord, SurfaceRecord};
use halfway_lighting::{Lens, Samples};
use halfway_raster::{
    ClearTiles, Output, Pieces, PixelFormat, RasterOptions, Rasterizer, TriangleOrder, VectorWidth, VertexLists,
};
use proptest::prelude::*;

const SIDE: u32 = 128;
/// Steps of the grid in a pixel.
const GRID: i64 = 256;
/// A corner on the grid.
type Corner = [i64; 2];

/// A point in eye space at a depth of 1 that falls exactly onto a corner of the grid: all numbers on the way have few
/// bits.
fn point([x, y]: Corner) -> [f32; 3] {
    let half = (i64::from(SIDE) * GRID / 2) as f32;
    [x as f32 / half - 1.0, 1.0 - y as f32 / half, -1.0]
}

/// White triangles over black. Half-transparent ones give 0.5 where one of them covers a sample, 0.75 where two do;
/// opaque ones, which take other code paths, 1 where any does.
fn scene(triangles: &[[[f32; 3]; 3]], samples: Samples, blend: bool) -> Scene {
    let positions = triangles.concat();
    let indices: Vec<_> = (0..positions.len() as u32).collect();
    let mesh =
        Pieces::new(&positions, VertexLists::default(), &indices, &[], TriangleOrder::Kept).expect("finite corners");
    let white = MaterialRecord { base: [1.0; 3], opacity: 0.5, ..MaterialRecord::default() };
    let mut call = draw(&mesh, 1, Shading::Constant);
    (call.cull, call.blend) = (Cull::None, blend);
    Scene {
        size: [SIDE; 2],
        samples,
        pixels: PixelFormat::Floats,
        clear: [0.0; 3],
        lens: Lens::perspective([1.0, 1.0], 0.5),
        lights: Vec::new(),
        lists: Vec::new(),
        surfaces: vec![SurfaceRecord { front: white, back: white, ..SurfaceRecord::default() }],
        instances: vec![at([0.0; 3], 0)],
        draws: vec![call],
        meshes: vec![mesh],
    }
}

/// The red channel.
fn picture(scene: &Scene, width: VectorWidth) -> Vec<f32> {
    let options = RasterOptions { width: Some(width), threads: Some(1) };
    let mut floats = vec![0.0; 4 * (SIDE * SIDE) as usize];
    let mut rasterizer = Rasterizer::new(options).expect("a width of this CPU");
    scene
        .with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats), &mut ClearTiles::default()))
        .expect("a sound pass");
    floats.chunks_exact(4).map(|pixel| pixel[0]).collect()
}

/// Whether a triangle covers a point of the grid: a point on an edge belongs to the triangle whose left or top edge it
/// is.
fn covers(corners: [Corner; 3], [x, y]: Corner) -> bool {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let ordered = if area > 0 { [a, b, c] } else { [a, c, b] };
    area != 0
        && (0..3).all(|k| {
            let (from, to) = (ordered[k], ordered[(k + 1) % 3]);
            let (along, down) = (to[0] - from[0], to[1] - from[1]);
            let side = along * (y - from[1]) - down * (x - from[0]);
            // Corners go clockwise on the screen: a left edge goes up, a top edge goes right.
            let owns = down < 0 || down == 0 && along > 0;
            side > 0 || side == 0 && owns
        })
}

/// Whether a triangle covers a point.
type Rule = fn([Corner; 3], Corner) -> bool;

/// The value that a pixel must have.
fn expected(rule: Rule, triangles: &[[Corner; 3]], samples: Samples, blend: bool, x: i64, y: i64) -> f32 {
    let places: &[Corner] = match samples {
        Samples::One => &[[0, 0]],
        _ => &[[-32, -96], [96, -32], [-96, 32], [32, 96]],
    };
    let opacity = if blend { 0.5 } else { 1.0 };
    let shown = |place: &Corner| {
        let point = [x * GRID + GRID / 2 + place[0], y * GRID + GRID / 2 + place[1]];
        let covering = triangles.iter().filter(|triangle| rule(**triangle, point));
        covering.fold(0.0, |color, _| color + opacity * (1.0 - color))
    };
    places.iter().map(shown).sum::<f32>() / places.len() as f32
}

/// Draws triangles by every code path, and compares each pixel with the exact rule.
fn check(triangles: &[[Corner; 3]]) -> Result<(), TestCaseError> {
    for samples in [Samples::One, Samples::Four] {
        for blend in [false, true] {
            check_by(covers, triangles, samples, blend)?;
        }
    }
    Ok(())
}

fn check_by(rule: Rule, triangles: &[[Corner; 3]], samples: Samples, blend: bool) -> Result<(), TestCaseError> {
    let points: Vec<_> = triangles.iter().map(|triangle| triangle.map(point)).collect();
    let place = |at: usize| (at as i64 % i64::from(SIDE), at as i64 / i64::from(SIDE));
    let expected: Vec<_> = (0..(SIDE * SIDE) as usize)
        .map(|at| expected(rule, triangles, samples, blend, place(at).0, place(at).1))
        .collect();
    for width in VectorWidth::available() {
        let found = picture(&scene(&points, samples, blend), width);
        for (at, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let what = if blend { "blended" } else { "opaque" };
            let pixel = place(at);
            prop_assert_eq!(found.to_bits(), expected.to_bits(), "{:?}, {}, {:?}, {}", pixel, width, samples, what);
        }
    }
    Ok(())
}

/// Corners of all kinds: anywhere, on pixels' centers, on the corners of pixels, far outside of the picture.
fn corner() -> impl Strategy<Value = Corner> {
    let anywhere = -2_000..(i64::from(SIDE) * GRID + 2_000);
    let pixel = 0..i64::from(SIDE);
    prop_oneof![
        3 => [anywhere.clone(), anywhere],
        2 => [pixel.clone(), pixel.clone()].prop_map(|[x, y]| [x * GRID + GRID / 2, y * GRID + GRID / 2]),
        1 => [pixel.clone(), pixel].prop_map(|[x, y]| [x * GRID, y * GRID]),
        1 => [-2_000_000_i64..6_000_000, -2_000_000..6_000_000],
    ]
}

/// Triangles of all kinds: large, small, slivers.
fn triangle() -> impl Strategy<Value = [Corner; 3]> {
    let near = |[x, y]: Corner, reach: i64| [-reach..=reach, -reach..=reach].prop_map(move |[dx, dy]| [x + dx, y + dy]);
    prop_oneof![
        [corner(), corner(), corner()],
        corner().prop_flat_map(move |a| [Just(a).boxed(), near(a, 900).boxed(), near(a, 900).boxed()]),
        corner().prop_flat_map(move |a| [Just(a).boxed(), near(a, 300).boxed(), near(a, 300).boxed()]),
        corner().prop_flat_map(move |a| [Just(a).boxed(), near(a, 8_000).boxed(), near(a, 3).boxed()]),
        [corner(), corner()].prop_flat_map(move |[a, b]| [Just(a).boxed(), Just(b).boxed(), near(b, 300).boxed()]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_triangle_covers_pixels_by_the_fill_rule(triangle in triangle()) {
        check(&[triangle])?;
    }

    #[test]
    fn many_triangles_cover_pixels_by_the_fill_rule(triangles in prop::collection::vec(triangle(), 2..70)) {
        // More than one vector of them, and more than one piece.
        check_by(covers, &triangles, Samples::One, false)?;
        check_by(covers, &triangles, Samples::Four, false)?;
    }

    #[test]
    fn of_adjacent_triangles_one_covers_each_pixel(a in corner(), b in corner(), c in corner(), inner in corner()) {
        // Three triangles around a point, which may lie outside: then they overlap, where the rule decides.
        let fan = [[a, b, inner], [b, c, inner], [c, a, inner]];
        check(&fan)?;
    }

    #[test]
    fn triangles_through_the_near_plane_leave_no_seams(
        corners in prop::array::uniform4([-3.0_f32..3.0, -3.0_f32..3.0, -4.0_f32..2.0]),
        split in prop::array::uniform3(0.0_f32..1.0),
    ) {
        // A triangle cut at a point inside into three: together they cover what it covers, each pixel once.
        let [a, b, c, _] = corners;
        let sum = split[0] + split[1] + split[2] + 1e-3;
        let inside = [0, 1, 2].map(|k| (a[k] * split[0] + b[k] * split[1] + c[k] * (split[2] + 1e-3)) / sum);
        let width = VectorWidth::available().next().expect("there is one");
        let whole = picture(&scene(&[[a, b, c]], Samples::One, true), width);
        let parts = picture(&scene(&[[a, b, inside], [b, c, inside], [c, a, inside]], Samples::One, true), width);
        // The point is rounded, so that a part seen edge-on may turn over, and overlap another.
        let seen = [a, b, c].map(|p| p.map(f64::from));
        prop_assume!(determinant(seen).abs() > 0.05);
        let side = SIDE as usize;
        let [whole, parts] = [whole, parts].map(|picture| picture.iter().map(|&x| (x * 4.0) as i32).collect::<Vec<_>>());
        for (place, (in_whole, in_parts)) in whole.iter().zip(&parts).enumerate() {
            prop_assert!(*in_parts < 3, "pixel {} is covered twice, {:?}, {:?}", place, corners, inside);
            // Where the near plane clips, the parts' outline has one more corner, rounded beside the whole's edge.
            let neighbors = [place.wrapping_sub(1), place + 1, place.wrapping_sub(side), place + side];
            let on_outline = neighbors.iter().any(|&near| whole.get(near).is_some_and(|near| near != in_whole));
            prop_assert!(in_whole == in_parts || on_outline, "pixel {} of {:?} and {:?}", place, corners, inside);
        }
    }
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Two halves of the square from pixel (1, 1) to (3, 3), whose edges run through centers: left and top are its own.
fn halves_of_a_square() -> [[Corner; 3]; 2] {
    let corner = |x: i64, y: i64| [x * GRID + GRID / 2, y * GRID + GRID / 2];
    [[corner(1, 1), corner(3, 1), corner(1, 3)], [corner(3, 1), corner(3, 3), corner(1, 3)]]
}

#[test]
fn the_fill_rule_itself_is_exact_on_a_square() {
    for y in 0..5 {
        for x in 0..5 {
            let inside = (1..3).contains(&x) && (1..3).contains(&y);
            let found = expected(covers, &halves_of_a_square(), Samples::One, true, x, y);
            assert!((found - if inside { 0.5 } else { 0.0 }).abs() < 1e-9, "({x}, {y})");
        }
    }
}

#[test]
fn the_check_finds_wrong_rules() {
    // The right and bottom edges own their points; no edge does; corners lie a step of the grid off.
    let turned: Rule = |corners, point| covers(corners.map(|[x, y]| [-x, -y]), [-point[0], -point[1]]);
    let none: Rule =
        |corners, point| covers(corners, point) && covers(corners.map(|[x, y]| [-x, -y]), [-point[0], -point[1]]);
    let off: Rule = |corners, point| covers(corners.map(|[x, y]| [x + 1, y]), point);
    for (name, rule) in [("turned", turned), ("none", none), ("off", off)] {
        for blend in [false, true] {
            let found = check_by(rule, &halves_of_a_square(), Samples::One, blend);
            assert!(found.is_err(), "{name}, {blend}");
        }
    }
}

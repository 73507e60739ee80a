//! Lines along edges, over the picture: against closed forms, and those that the oracle's surfaces give.

use crate::render::scene::{Scene, Thing, glowing};
use crate::render::stage::Stage;
use halfway::lighting::{Edges, HiddenEdges, WhichEdges};
use halfway::prelude::*;
use halfway::render::{draw_lines, take_picture};
use image::Rgba32FImage;

const RED: LinearRgba = LinearRgba::rgb(1.0, 0.0, 0.0);

/// Ten world units are as high as the picture of 100 pixels: a unit takes ten.
fn plan() -> Scene {
    Scene { camera: Camera::orthographic(10.0), ..Scene::in_eye_space() }
}

fn green_square(center: Vec3, size: f32) -> Thing {
    Thing::square(center, Vec3::Z, size).with_material(glowing(0.0, 1.0, 0.0))
}

fn drawn(stage: &mut Stage) -> Rgba32FImage {
    match take_picture(stage.world()).unwrap_or_else(|error| panic!("{error}")) {
        Picture::Float(picture) => picture,
        Picture::Byte(_) => panic!("bytes"),
    }
}

/// How much of the pixel is line: its red, as nothing else is red.
fn red(picture: &Rgba32FImage, x: u32, y: u32) -> f32 {
    picture.get_pixel(x, y).0[0]
}

#[test]
fn a_border_covers_its_width_and_its_colour_is_the_one_given() {
    let mut stage = Stage::new(100, 100);
    // From pixel 30 to pixel 70.
    let square = stage.set(&plan().with(green_square(Vec3::new(0.0, 0.0, -5.0), 4.0)))[0];
    let rows: [(f32, f32, [f32; 4]); 3] =
        [(1.0, 1.0, [0.0, 0.5, 0.5, 0.0]), (2.0, 1.0, [0.0, 1.0, 1.0, 0.0]), (3.0, 0.5, [0.25, 0.5, 0.5, 0.25])];
    for (width, opacity, expected) in rows {
        stage.world().entity_mut(square).insert(Edges {
            color: RED,
            opacity,
            width: width.into(),
            ..Edges::new(WhichEdges::Boundary)
        });
        let picture = drawn(&mut stage);
        for (number, expected) in (28..32).zip(expected) {
            for (x, y) in [(number, 50), (50, number), (99 - number, 50), (50, 99 - number)] {
                assert!(
                    (red(&picture, x, y) - expected).abs() < 1e-5,
                    "{width} wide, ({x}, {y}): {}",
                    red(&picture, x, y)
                );
            }
        }
        // The diagonal is no border, and what lies between is as it was.
        assert_eq!(picture.get_pixel(50, 50).0, [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(picture.get_pixel(5, 5).0, [0.0, 0.0, 0.0, 1.0]);
    }
    stage.world().entity_mut(square).remove::<Edges>();
    assert!(drawn(&mut stage).pixels().all(|pixel| pixel.0[0] == 0.0));
}

#[test]
fn bytes_have_the_same_lines() {
    let mut stage = Stage::new(100, 100);
    let square = stage.set(&plan().with(green_square(Vec3::new(0.0, 0.0, -5.0), 4.0)))[0];
    let edges = Edges { color: RED, width: 1.0.into(), ..Edges::new(WhichEdges::Boundary) };
    stage.world().entity_mut(square).insert(edges);
    stage.pixels(Pixels::Byte);
    let picture = stage.bytes();
    // Half a red over half a green, encoded.
    assert_eq!(picture.get_pixel(50, 30).0, [188, 188, 0, 255]);
    assert_eq!(picture.get_pixel(50, 29).0, [188, 0, 0, 255]);
}

#[test]
fn what_lies_behind_a_surface_is_left_out_or_dashed() {
    let mut stage = Stage::new(100, 100);
    let behind = green_square(Vec3::new(0.0, 0.0, -6.0), 6.0);
    // It hides the right half, from pixel 50 on.
    let before = green_square(Vec3::new(4.0, 0.0, -5.0), 8.0);
    let things = stage.set(&plan().with(behind).with(before));
    let share_of_line = |picture: &Rgba32FImage, columns: std::ops::Range<u32>| {
        let count = columns.len() as f32;
        columns.map(|x| red(picture, x, 20)).sum::<f32>() / count
    };
    for (hidden, expected) in [(HiddenEdges::Omit, 0.0), (HiddenEdges::Dash, 5.0 / 9.0)] {
        let edges = Edges { color: RED, width: 2.0.into(), hidden, ..Edges::new(WhichEdges::Boundary) };
        stage.world().entity_mut(things[0]).insert(edges);
        let picture = drawn(&mut stage);
        assert!((share_of_line(&picture, 22..49) - 1.0).abs() < 1e-5, "{hidden:?}");
        let found = share_of_line(&picture, 52..79);
        // Three dashes and gaps of whole pixels, begun anywhere.
        assert!((found - expected).abs() < 0.08, "{hidden:?}: {found}");
    }
}

#[test]
fn each_choice_has_its_edges_and_the_camera_s_hold_for_all() {
    let mut stage = Stage::new(100, 100);
    let cube = Thing::new(Cuboid::default()).at(Transform::from_xyz(0.0, 0.0, -5.0).with_scale(Vec3::splat(4.0)));
    let cube = stage.set(&plan().with(cube.with_material(glowing(0.0, 1.0, 0.0))))[0];
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    let with = |which| Edges { color: RED, width: 1.0.into(), ..Edges::new(which) };
    // Pixels of the frontal face that are lines: its outline, and with all edges its diagonal.
    let mut count = |which, wires: bool| {
        stage.world().entity_mut(camera).insert(Edges { surface: !wires, ..with(which) });
        let picture = drawn(&mut stage);
        let inner = (32..68).flat_map(|y| (32..68).map(move |x| (x, y)));
        (
            red(&picture, 50, 30),
            inner.filter(|&(x, y)| red(&picture, x, y) > 0.0).count(),
            picture.get_pixel(40, 60).0[1],
        )
    };
    assert_eq!(count(WhichEdges::SHARP, false), (0.5, 0, 1.0));
    assert_eq!(count(WhichEdges::Silhouette, false), (0.5, 0, 1.0));
    assert_eq!(count(WhichEdges::Boundary, false), (0.0, 0, 1.0));
    let (outline, diagonal, _) = count(WhichEdges::All, false);
    assert!(outline == 0.5 && (36..=3 * 36).contains(&diagonal), "{outline} {diagonal}");
    // A wireframe has no surface, and shows what is behind.
    let (outline, both, inner) = count(WhichEdges::All, true);
    assert!(outline == 0.5 && both >= diagonal && inner == 0.0, "{outline} {both} {inner}");
    // Its own win.
    stage.world().entity_mut(cube).insert(with(WhichEdges::Boundary));
    assert_eq!(red(&drawn(&mut stage), 50, 30), 0.0);
}

#[test]
fn lines_are_those_that_the_oracle_s_surfaces_give() {
    let mut stage = Stage::new(160, 120);
    let scene = Scene::seen_from(Vec3::new(1.3, 1.6, 3.4), Vec3::ZERO)
        .with(Thing::new(UvSphere::new(0.8, 24, 12)).at(Transform::from_xyz(-0.6, 0.0, 0.0)))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(0.6, -0.2, 0.3)))
        .with(green_square(Vec3::new(0.0, 0.5, -1.0), 2.5));
    stage.set(&scene);
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    for which in [WhichEdges::All, WhichEdges::SHARP, WhichEdges::Silhouette] {
        stage.world().entity_mut(camera).insert(Edges { color: RED, ..Edges::new(which) });
        let picture = drawn(&mut stage);
        let oracle = stage.oracle();
        let size = UVec2::new(160, 120);
        let found = |x: u32, y: u32| {
            let nearest = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?;
            Some((nearest.object, nearest.triangle?))
        };
        let mut lines_by = |found: &dyn Fn(u32, u32) -> Option<(Entity, u32)>| {
            let surfaces = Surfaces::found_by(stage.world(), size, found).expect("a camera");
            let mut lines = Picture::Float(Rgba32FImage::new(160, 120));
            draw_lines(stage.world(), &mut lines, &surfaces).expect("valid edges");
            let Picture::Float(lines) = lines else { panic!("bytes") };
            lines
        };
        // Only lines are as red as this; where a pixel shows another side of a surface's edge, a hidden line may begin
        // a pixel later.
        let differ = |lines: &Rgba32FImage| {
            picture.pixels().zip(lines.pixels()).filter(|(a, b)| (a.0[0] - b.0[0]).abs() > 0.75).count()
        };
        let expected = lines_by(&found);
        let lines = expected.pixels().filter(|pixel| pixel.0[0] > 0.75).count();
        let wrong = differ(&expected);
        assert!(lines > 100 && wrong * 100 <= lines, "{which:?}: {wrong} pixels differ, of {lines}");
        // A planted fault: without surfaces nothing is hidden.
        let wrong = differ(&lines_by(&|_, _| None));
        assert!(wrong * 100 > lines, "{which:?}: {wrong} pixels differ where nothing is hidden, of {lines}");
    }
}

#[test]
fn an_invalid_width_is_refused_by_name() {
    let mut stage = Stage::new(20, 20);
    let square = Thing::square(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 4.0).named("tile");
    let square = stage.set(&plan().with(square))[0];
    stage.world().entity_mut(square).insert(Edges { width: 0.0.into(), ..Edges::default() });
    let error = take_picture(stage.world()).expect_err("no width").to_string();
    assert!(error.contains("\"tile\"") && error.contains("width") && error.contains("above 0"), "{error}");
}

//! Lines and points over the picture: against closed forms, surfaces of the same material, and the reference.

use crate::render::scene::{Lamp, Scene, Thing, glowing, material};
use crate::render::stage::Stage;
use halfway::asset::Assets;
use halfway::lighting::{HiddenEdges, LineStyle, Width};
use halfway::mesh::{Lines, Lines3d};
use halfway::prelude::*;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use halfway::render::{Surfaces, draw_lines, take_picture, why_empty};
use image::Rgba32FImage;
use std::f32::consts::PI;
use std::ops::ControlFlow;

const SIZE: UVec2 = UVec2::splat(100);

/// Ten world units are as high as the picture of 100 pixels: a unit takes ten.
fn plan() -> Scene {
    Scene { camera: Camera::orthographic(10.0), ..Scene::in_eye_space() }
}

fn red() -> Material {
    glowing(1.0, 0.0, 0.0)
}

fn stroke(stage: &mut Stage, lines: Lines, looks: impl Bundle) -> Entity {
    let handle = stage.world().resource_mut::<Assets<Lines>>().add(lines);
    stage.spawn((Lines3d(handle), looks))
}

fn drawn(stage: &mut Stage) -> Rgba32FImage {
    match take_picture(stage.world()).unwrap_or_else(|error| panic!("{error}")) {
        Picture::Float(picture) => picture,
        Picture::Byte(_) => panic!("bytes"),
    }
}

fn sum(picture: &Rgba32FImage, channel: usize) -> f32 {
    picture.pixels().map(|pixel| pixel.0[channel]).sum()
}

#[test]
fn a_level_line_covers_its_width_exactly() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&plan());
    // From column 30 to column 70, in the middle of row 52 or between it and the next.
    for (y, width, expected) in [
        (-0.25, Width::Pixels(1.0), [0.0, 1.0, 0.0]),
        (-0.3, Width::Pixels(1.0), [0.0, 0.5, 0.5]),
        (-0.25, Width::World(0.2), [0.5, 1.0, 0.5]),
    ] {
        let path = Lines::path(vec![Vec3::new(-2.0, y, -5.0), Vec3::new(2.0, y, -5.0)]).expect("a line");
        let style = LineStyle { line_width: width, ..LineStyle::default() };
        let line = stroke(&mut stage, path, (red(), style));
        let picture = drawn(&mut stage);
        for (row, expected) in (51..54).zip(expected) {
            for column in 31..69 {
                let found = picture.get_pixel(column, row).0[0];
                assert!((found - expected).abs() < 1e-5, "{width:?} at {y}, ({column}, {row}): {found}");
            }
        }
        // With a half disc at each end, which is counted by its distance.
        let pixels = width.in_pixels(0.1) as f32;
        let area = 40.0 * pixels + PI * (pixels * pixels / 4.0 + 1.0 / 12.0);
        assert!((sum(&picture, 0) - area).abs() < 0.3, "{width:?}: {} instead of {area}", sum(&picture, 0));
        stage.world().despawn(line);
    }
    assert!(drawn(&mut stage).pixels().all(|pixel| pixel.0[0] == 0.0));
}

#[test]
fn discs_cover_their_areas_exactly() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&plan());
    let places = vec![Vec3::new(-2.03, 1.11, -5.0), Vec3::new(2.17, -1.0, -3.0), Vec3::new(0.05, 0.05, -7.0)];
    for (size, diameter) in [(Width::Pixels(1.0), 1.0), (Width::Pixels(4.0), 4.0), (Width::World(1.25), 12.5)] {
        let style = LineStyle { point_size: size, ..LineStyle::default() };
        let cloud = stroke(&mut stage, Lines::cloud(places.clone()).expect("three points"), (red(), style));
        let found = sum(&drawn(&mut stage), 0);
        let expected = 3.0 * PI * diameter * diameter / 4.0;
        assert!((found - expected).abs() < 1e-3 * expected, "{size:?}: {found} instead of {expected}");
        stage.world().despawn(cloud);
    }
    // In perspective a width in world units is smaller the farther away.
    stage.set(&Scene { camera: Camera::perspective(PI / 2.0), ..Scene::in_eye_space() });
    let style = LineStyle { point_size: Width::World(1.0), ..LineStyle::default() };
    for depth in [5.0, 10.0] {
        let cloud = stroke(&mut stage, Lines::cloud(vec![Vec3::NEG_Z * depth]).expect("a point"), (red(), style));
        let (found, radius) = (sum(&drawn(&mut stage), 0), 0.5 * 50.0 / depth);
        assert!((found / (PI * radius * radius) - 1.0).abs() < 1e-3, "{depth}: {found}");
        stage.world().despawn(cloud);
    }
}

#[test]
fn colours_of_vertices_and_the_style_s() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    // The nearer end is 5 away, the farther one 15.
    stage.set(&Scene { camera: Camera::perspective(PI / 2.0), ..Scene::in_eye_space() });
    let ends = [Vec3::new(-4.0, 0.0, -5.0), Vec3::new(12.0, 0.0, -15.0)];
    let (green, blue) = (Vec4::new(0.0, 1.0, 0.0, 1.0), Vec4::new(0.0, 0.0, 1.0, 0.5));
    let path = Lines::path(ends.to_vec()).and_then(|path| path.with_colors(vec![green, blue])).expect("two colours");
    let style = LineStyle { line_width: Width::Pixels(4.0), ..LineStyle::default() };
    let white = Material::matte(LinearRgba::WHITE);
    let line = stroke(&mut stage, path, (white, style));
    let picture = drawn(&mut stage);
    for column in [15, 50, 85] {
        let [r, g, b, _] = picture.get_pixel(column, 50).0;
        // The point of the line on the column's ray x = s·z: −4 + 16t = s(5 + 10t).
        let s = (column as f32 + 0.5) / 50.0 - 1.0;
        let t = (5.0 * s + 4.0) / (16.0 - 10.0 * s);
        assert!((g - (1.0 - t)).abs() < 1e-4 && (b - t).abs() < 1e-4 && r == 0.0, "{column}: {r} {g} {b}, {t}");
    }
    // Opacities count where the entity is blended.
    let material = Material { opacity: 0.5, ..white };
    stage.world().entity_mut(line).insert((AlphaMode::Blend, material));
    let [_, g, b, alpha] = drawn(&mut stage).get_pixel(15, 50).0;
    assert!(g > 0.4 && g + b < 0.5 && alpha == 1.0, "{g} {b}");
    stage.world().entity_mut(line).insert(VertexColors::Ignore);
    let [r, g, b, _] = drawn(&mut stage).get_pixel(50, 50).0;
    assert!(r == 0.5 && g == 0.5 && b == 0.5, "{r} {g} {b}");
    stage.world().entity_mut(line).insert(LineStyle { color: Some(LinearRgba::RED), ..style });
    assert_eq!(drawn(&mut stage).get_pixel(50, 50).0, [0.5, 0.0, 0.0, 1.0]);
}

#[test]
fn normals_reflect_the_lights_as_a_surface_does() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let normal = Vec3::new(0.3, 0.5, 0.8).normalize();
    let lamp = Lamp::point(PointLight::white().with_range(20.0), Vec3::new(1.0, 2.0, -1.0));
    let tile = Thing::square(Vec3::new(-0.05, -0.05, -5.0), normal, 9.0).with_material(material());
    stage.set(&plan().lit(lamp).ambient(0.2).with(tile));
    let without = drawn(&mut stage);
    // The middles of pixels, on the tile; the last normal points to its other side.
    let places = [[50, 50], [30, 60], [60, 25]];
    let point = |[column, row]: [u32; 2]| {
        let (x, y) = ((column as f32 - 49.5) / 10.0, (49.5 - row as f32) / 10.0);
        let (dx, dy) = (x + 0.05, y + 0.05);
        Vec3::new(x, y, -5.0 - (normal.x * dx + normal.y * dy) / normal.z)
    };
    let cloud =
        Lines::cloud(places.map(point).to_vec()).and_then(|cloud| cloud.with_normals(vec![normal, normal, -normal]));
    let style = LineStyle { point_size: Width::Pixels(6.0), ..LineStyle::default() };
    let cloud = stroke(&mut stage, cloud.expect("three points"), (material(), style));
    let with = drawn(&mut stage);
    for [column, row] in places {
        let [surface, disc] = [&without, &with].map(|picture| picture.get_pixel(column, row).0);
        let same = surface.iter().zip(disc).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(same && surface[0] > 0.05, "({column}, {row}): {disc:?} instead of {surface:?}");
    }
    // A disc has one colour, the tile has not: it lies over it in full.
    let [at, beside] = [50, 52].map(|column| with.get_pixel(column, 50).0);
    assert!(at == beside && without.get_pixel(52, 50).0 != at);
    // A planted fault: with another normal it is another colour.
    let world = stage.world();
    let handle = world.get::<Lines3d>(cloud).expect("lines").0.clone();
    let turned = Lines::cloud(places.map(point).to_vec()).and_then(|cloud| cloud.with_normals(vec![Vec3::Z; 3]));
    *world.resource_mut::<Assets<Lines>>().get_mut(&handle).expect("they are there") = turned.expect("three points");
    let turned = drawn(&mut stage);
    assert!((turned.get_pixel(50, 50).0[0] - at[0]).abs() > 1e-3);
}

#[test]
fn a_policy_of_intensities_tones_what_is_lit_as_it_tones_surfaces() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let tile = Thing::square(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 9.0).with_material(material());
    let white = Intensity::WHITE;
    let mut found = Vec::new();
    for intensity in [Intensity::Clamp, Intensity::Reinhard { white }, Intensity::Aces] {
        let sun = Lamp::directional(DirectionalLight::white(), Vec3::new(-0.2, -0.3, -1.0));
        let camera = Camera { intensity, ..plan().camera };
        stage.set(&Scene { camera, ..plan() }.lit(sun).ambient(1.5).with(tile.clone()));
        let without = drawn(&mut stage);
        let at = Vec3::new(0.05, 0.05, -5.0);
        let cloud = Lines::cloud(vec![at]).and_then(|cloud| cloud.with_normals(vec![Vec3::Z])).expect("a point");
        stroke(&mut stage, cloud, (material(), LineStyle { point_size: Width::Pixels(5.0), ..LineStyle::default() }));
        let line = Lines::path(vec![Vec3::new(-3.0, 2.05, -4.0), Vec3::new(3.0, 2.05, -4.0)]).expect("a line");
        stroke(&mut stage, line, red());
        let with = drawn(&mut stage);
        let [surface, disc] = [&without, &with].map(|picture| picture.get_pixel(50, 49).0);
        let same = surface.iter().zip(disc).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(same && surface[0] > 0.3, "{intensity:?}: {disc:?} instead of {surface:?}");
        // A colour of its own stays.
        assert_eq!(with.get_pixel(50, 29).0, [1.0, 0.0, 0.0, 1.0], "{intensity:?}");
        found.push(disc[0]);
    }
    // A planted fault: the curve of another policy.
    assert!((found[0] - found[1]).abs() > 0.01 && (found[1] - found[2]).abs() > 0.01, "{found:?}");
}

#[test]
fn surfaces_before_them_hide_them_and_those_they_lie_on_do_not() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    // Leaning far back, from the left to the right.
    let normal = Vec3::new(0.0, 0.97, 0.243).normalize();
    let slope = Thing::square(Vec3::new(0.0, 0.0, -20.0), normal, 30.0).with_material(glowing(0.0, 0.5, 0.0));
    let before = Thing::square(Vec3::new(4.0, 0.0, -2.0), Vec3::Z, 4.0).with_material(glowing(0.0, 0.0, 0.5));
    stage.set(&plan().with(slope).with(before));
    // On the slope, across and along it, and behind the square from column 70 on.
    let on_slope = |x: f32, y: f32| Vec3::new(x, y, -20.0 - y * normal.y / normal.z);
    let corners = vec![on_slope(-4.0, 0.5), on_slope(4.0, 0.5), on_slope(-3.0, -1.5), on_slope(-1.0, 1.5)];
    let lines = Lines::new(corners, vec![[0, 1], [2, 3]], Vec::new()).expect("two lines");
    let style = LineStyle { line_width: Width::Pixels(1.0), ..LineStyle::default() };
    let wires = stroke(&mut stage, lines, (red(), style));
    let picture = drawn(&mut stage);
    let column = |x: u32| (0..100).map(|y| picture.get_pixel(x, y).0[0]).sum::<f32>();
    for x in 12..68 {
        assert!(column(x) > 0.99, "column {x}: {}", column(x));
    }
    for x in 72..88 {
        assert_eq!(column(x), 0.0, "column {x}");
    }
    let steep: f32 =
        (0..100).flat_map(|y| (22..40).map(move |x| (x, y))).map(|(x, y)| picture.get_pixel(x, y).0[0]).sum();
    // The level line, and the other one, 20 columns and 30 rows long; they cross once.
    let expected = 18.0 + 18.0 / 20.0 * 13.0_f32.sqrt() * 10.0 - 1.2;
    assert!((steep - expected).abs() < 1.5, "{steep} instead of {expected}");
    stage.world().despawn(wires);

    // A ball of points: a disc wider than the edge before it is cut there.
    let half = Lines::cloud(vec![Vec3::new(2.0, 0.0, -3.0)]).expect("a point");
    let style = LineStyle { point_size: Width::Pixels(20.0), ..LineStyle::default() };
    stroke(&mut stage, half, (red(), style));
    let found = sum(&drawn(&mut stage), 0);
    assert!((found / (PI * 100.0) - 0.5).abs() < 0.06, "{found}");
}

#[test]
fn hidden_lines_are_left_out_or_dashed_along_their_whole_path() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    // It hides the columns from 50 on.
    let before = Thing::square(Vec3::new(4.0, 0.0, -2.0), Vec3::Z, 8.0).with_material(glowing(0.0, 0.5, 0.0));
    stage.set(&plan().with(before));
    let from_to = |ends: [f32; 2], pieces: u32| {
        let at = |i: u32| ends[0] + (ends[1] - ends[0]) * i as f32 / pieces as f32;
        Lines::path((0..=pieces).map(|i| Vec3::new(at(i), 0.05, -4.0)).collect()).expect("a path")
    };
    let mut row = |path: Lines, hidden| {
        let style = LineStyle { line_width: Width::Pixels(1.0), hidden, ..LineStyle::default() };
        let line = stroke(&mut stage, path, (red(), style));
        let picture = drawn(&mut stage);
        stage.world().despawn(line);
        (10..90).map(|x| picture.get_pixel(x, 49).0[0]).collect::<Vec<_>>()
    };
    // From column 10 to column 90.
    let whole = row(from_to([-4.0, 4.0], 1), HiddenEdges::Omit);
    assert!(whole[..39].iter().all(|&red| red == 1.0) && whole[41..].iter().all(|&red| red == 0.0), "{whole:?}");
    let dashed = row(from_to([-4.0, 4.0], 1), HiddenEdges::Dash);
    for (column, &red) in dashed.iter().enumerate().skip(41) {
        // The middle of the pixel is this far along the path: 5 pixels of line, 4 of nothing.
        let is_dash = (column as f32 + 0.5) % 9.0 < 5.0;
        assert_eq!(red, f32::from(is_dash), "column {column}");
    }
    assert_eq!(dashed[..39], whole[..39]);
    // Segments of 2 pixels have the same dashes; a planted fault would be segments that begin anew.
    let pieces = row(from_to([-4.0, 4.0], 40), HiddenEdges::Dash);
    let differing = dashed.iter().zip(&pieces).filter(|(a, b)| (*a - *b).abs() > 0.01).count();
    assert!(differing <= 2, "{differing} columns differ: {pieces:?}");
    let is_gap = |red: &&f32| **red == 0.0;
    assert!(pieces[41..].iter().filter(is_gap).count() > 12, "{pieces:?}");
}

#[test]
fn the_nearer_of_two_covers_the_other_whatever_their_order() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&plan());
    let style = LineStyle { point_size: Width::Pixels(12.0), line_width: Width::Pixels(5.0), ..LineStyle::default() };
    let point = Lines::cloud(vec![Vec3::new(0.0, 0.0, -4.0)]).expect("a point");
    stroke(&mut stage, point, (red(), style));
    // From before the point to behind it.
    let through = Lines::path(vec![Vec3::new(-3.0, 0.0, -1.0), Vec3::new(3.0, 0.0, -7.0)]).expect("a line");
    stroke(&mut stage, through, (glowing(0.0, 1.0, 0.0), style));
    let picture = drawn(&mut stage);
    assert_eq!(picture.get_pixel(47, 50).0, [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(picture.get_pixel(52, 50).0, [1.0, 0.0, 0.0, 1.0]);
}

/// Surfaces, lines across and through them, and lit points.
fn still_life(stage: &mut Stage) {
    let lamp = Lamp::directional(DirectionalLight::white(), Vec3::new(-1.0, -1.0, -2.0));
    let scene = Scene::seen_from(Vec3::new(1.3, 1.6, 3.4), Vec3::ZERO)
        .lit(lamp)
        .with(Thing::new(UvSphere::new(0.8, 24, 12)).at(Transform::from_xyz(-0.6, 0.0, 0.0)))
        .with(Thing::new(Cuboid::default()).at(Transform::from_xyz(0.6, -0.2, 0.3)));
    stage.set(&scene);
    let helix = (0..300).map(|i| 0.1 * i as f32).map(|t| Vec3::new(t.cos(), 0.06 * t - 0.9, t.sin()));
    stroke(stage, Lines::path(helix.collect()).expect("many points"), red());
    let ball = Mesh::from(UvSphere::new(1.2, 16, 8)).positions().to_vec();
    let cloud = Lines::cloud(ball.clone()).and_then(|cloud| cloud.with_normals(ball));
    stroke(stage, cloud.expect("many points"), (material(), LineStyle::default()));
}

#[test]
fn the_reference_has_the_same_lines_and_points() {
    let mut stage = Stage::new(160, 120);
    still_life(&mut stage);
    let picture = drawn(&mut stage);
    let frame = FrameToDraw { number: 0, size: UVec2::new(160, 120), pixels: Pixels::Float };
    let reference = ReferenceDrawing::default().picture(&mut stage.app, frame, &|_, _| ControlFlow::Continue(()));
    let Ok(Picture::Float(reference)) = reference else { panic!("a picture in floating point") };
    let differ = |picture: &Rgba32FImage| {
        let pairs = picture.pixels().zip(reference.pixels());
        pairs.filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| (a - b).abs() > 0.02)).count()
    };
    // On the edges of surfaces a pixel may show another side.
    let wrong = differ(&picture);
    assert!(wrong <= 60, "{wrong} pixels differ");
    // A planted fault: nothing is hidden.
    let surfaces = Surfaces::found_by(stage.world(), UVec2::new(160, 120), |_, _| None).expect("a camera");
    let mut faulty = Picture::Float(picture);
    draw_lines(stage.world(), &mut faulty, &surfaces).expect("valid lines");
    let Picture::Float(faulty) = faulty else { panic!("bytes") };
    assert!(differ(&faulty) > 300, "{} pixels differ where nothing is hidden", differ(&faulty));
}

#[test]
fn bad_ones_are_refused_by_name_and_lines_alone_are_not_nothing() {
    let mut stage = Stage::new(20, 20);
    stage.set(&plan());
    let point = Lines::cloud(vec![Vec3::NEG_Z * 5.0]).expect("a point");
    let style = LineStyle { point_size: Width::World(-1.0), ..LineStyle::default() };
    let cloud = stroke(&mut stage, point, (red(), style, Name::new("cloud")));
    let error = take_picture(stage.world()).expect_err("no size").to_string();
    assert!(
        error.contains("\"cloud\"") && error.contains("LineStyle.point_size") && error.contains("above 0"),
        "{error}"
    );
    stage.world().entity_mut(cloud).insert(LineStyle::default());
    drawn(&mut stage);
    assert_eq!(why_empty(stage.world()), None);
    stage.world().entity_mut(cloud).insert(Lines3d::default());
    let error = take_picture(stage.world()).expect_err("no lines").to_string();
    assert!(error.contains("\"cloud\""), "{error}");
}

//! The judge finds each planted fault, and passes the pictures of correct rasterisers.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3, Vec4};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{
    AlphaMode, BackMaterial, Camera, DirectionalLight, Encoding, Faces, GlobalAmbient, Material, PointLight, Samples,
    Shading,
};
use halfway_mesh::{Mesh, UvSphere};
use halfway_reference::metrics::{Bars, Verdict, judge, judge_on_grid};
use halfway_reference::{Image, Oracle};
use image::{DynamicImage, RgbaImage};

use crate::scene::{Stage, glow, grey, panel, triangle, wall};

const SIZE: u32 = 96;
/// Where the four samples of a pixel lie.
const FOUR: [[f64; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

pub(crate) fn oracle(stage: &mut Stage) -> Oracle {
    stage.oracle(SIZE, SIZE)
}

pub(crate) fn float(truth: &Oracle, actual: &Image) -> Verdict {
    judge(truth, &truth.draw(), actual, Bars::FLOAT).expect("pictures of one size")
}

/// Judges the picture of a renderer with a grid of this many bits.
pub(crate) fn on_grid(truth: &Oracle, bits: u32, actual: &Image) -> Verdict {
    judge_on_grid(truth, &truth.draw(), bits, actual, Bars::FLOAT).expect("pictures of one size")
}

/// The picture rounded to bytes, judged by their bars.
fn bytes(stage: &mut Stage, actual: &Image, encoding: Encoding) -> Verdict {
    let truth = oracle(stage).with_clamping(true);
    let rounded: RgbaImage = DynamicImage::from(actual.to_bytes(encoding)).into_rgba8();
    let bars = Bars { equal: 0.0, ..Bars::bytes(encoding) };
    judge(&truth, &truth.draw(), &Image::from_bytes(&rounded, encoding), bars).expect("pictures of one size")
}

/// Fails unless all judges, of floating point on either grid and of bytes, find the fault.
pub(crate) fn assert_caught(fault: &str, stage: &mut Stage, actual: &Image) {
    let verdict = float(&oracle(stage), actual);
    assert!(!verdict.is_within(), "{fault}: {verdict}");
    for bits in [4, 8] {
        let verdict = on_grid(&oracle(stage), bits, actual);
        assert!(!verdict.is_within(), "{fault}, on a grid of {bits} bits: {verdict}");
    }
    for encoding in [Encoding::Raw, Encoding::Srgb] {
        let verdict = bytes(stage, actual, encoding);
        assert!(!verdict.is_within(), "{fault}, {encoding:?}: {verdict}");
    }
}

/// The picture with some pixels changed.
pub(crate) fn with(image: &Image, changes: impl IntoIterator<Item = ((u32, u32), [f64; 3])>) -> Image {
    let (width, height) = image.dimensions();
    let mut pixels = image.pixels().to_vec();
    for ((x, y), color) in changes {
        pixels[(y * width + x) as usize] = color;
    }
    Image::new(width, height, pixels)
}

pub(crate) fn all_pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)))
}

/// A white light from above for a grey material, visible under either shading.
fn lamp(stage: &mut Stage) -> Entity {
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(2.0, 3.0, 1.0))).id()
}

/// A sphere whose vertices are in eye space, so that they can be moved there.
fn ball(center: Vec3, radius: f32, columns: u32, rows: u32) -> Mesh {
    let mesh = Mesh::from(UvSphere::new(radius, columns, rows));
    moved(&mesh, |p| p + center)
}

pub(crate) fn moved(mesh: &Mesh, place: impl Fn(Vec3) -> Vec3) -> Mesh {
    let positions = mesh.positions().iter().map(|p| place(*p)).collect();
    Mesh::from_parts(positions, Some(mesh.normals().to_vec()), None, mesh.indices().to_vec())
        .expect("the same triangles")
}

pub(crate) fn without(mesh: &Mesh, triangle: usize) -> Mesh {
    let mut indices = mesh.indices().to_vec();
    indices.drain(3 * triangle..3 * triangle + 3);
    Mesh::from_parts(mesh.positions().to_vec(), Some(mesh.normals().to_vec()), None, indices).expect("one less")
}

/// Where a point before the stage's camera lies on the picture.
fn pixel(p: Vec3) -> Vec2 {
    0.5 * SIZE as f32 * (1.0 + Vec2::new(p.x, -p.y) / -p.z)
}

/// The point of the same depth that lies elsewhere on the picture.
pub(crate) fn at_pixel(p: Vec3, pixel: Vec2) -> Vec3 {
    let at_depth_1 = pixel / (0.5 * SIZE as f32) - 1.0;
    Vec3::new(at_depth_1.x * -p.z, -at_depth_1.y * -p.z, p.z)
}

/// The mesh with its vertices on a grid of N places a pixel, as a rasteriser has them.
pub(crate) fn snapped(mesh: &Mesh, places: f32) -> Mesh {
    moved(mesh, |p| at_pixel(p, (pixel(p) * places).round() / places))
}

/// A scene of balls before a wall, some inside each other, each mesh taken through a function.
fn balls(looks: impl Fn(f32) -> Material, shading: Shading, change: impl Fn(&Mesh) -> Mesh) -> Stage {
    let mut stage = Stage::new();
    lamp(&mut stage);
    stage.add(wall(30.0, 8.0), (looks(0.2), shading));
    for (i, (center, columns)) in
        [(Vec3::new(-0.7, 0.3, -2.5), 96), (Vec3::new(0.9, -0.4, -3.0), 16), (Vec3::new(0.2, 0.2, -2.2), 9)]
            .into_iter()
            .enumerate()
    {
        stage.add(change(&ball(center, 0.8, columns, columns / 2)), (looks(0.5 + 0.2 * i as f32), shading));
    }
    // A plate that is seen nearly from its edge, and two of its sides.
    let plate = moved(&panel(-0.9, 0.3, -1.0, 1.0, 0.0), |p| Vec3::new(p.x, -0.9 + 0.02 * p.y, p.y - 3.0));
    stage.add(change(&plate), (looks(0.4), shading, Faces::Both));
    stage
}

fn grey_glow(grey: f32) -> Material {
    glow(grey, 1.0 - grey, 0.5 * grey)
}

fn plain(_: f32) -> Material {
    glossy(20.0)
}

fn glossy(shininess: f32) -> Material {
    Material { specular: grey(0.5), shininess, ..Material::default() }
}

/// Another colour at each vertex.
fn painted(mesh: &Mesh) -> Mesh {
    let wave = |i: usize, by: f32| 0.5 + 0.4 * (by * i as f32).sin();
    let colors = (0..mesh.positions().len()).map(|i| Vec4::new(wave(i, 0.1), wave(i, 0.3), wave(i, 0.7), 1.0));
    mesh.clone().with_colors(colors.collect()).expect("a colour a vertex")
}

/// The balls in colours that stay with their vertices, as on a rasteriser, wherever those are moved.
fn painted_balls(change: impl Fn(&Mesh) -> Mesh) -> Stage {
    let looks = |_| Material { ambient: LinearRgba::WHITE, ..glow(0.0, 0.0, 0.0) };
    let mut stage = balls(looks, Shading::Phong, |mesh| painted(&change(mesh)));
    stage.world.insert_resource(GlobalAmbient(LinearRgba::WHITE));
    stage
}

#[test]
fn a_rasteriser_that_is_right_passes() {
    for places in [16.0, 256.0] {
        let picture = oracle(&mut balls(grey_glow, Shading::Flat, |mesh| snapped(mesh, places))).draw();
        let verdict = float(&oracle(&mut balls(grey_glow, Shading::Flat, Mesh::clone)), &picture);
        // A coarse grid moves some edges over centres.
        assert!(verdict.is_within() && (places > 16.0 || verdict.edges > 0.0), "{places} places a pixel: {verdict}");
    }
    // Flat shading takes its normals from what is moved here, which a rasteriser does not.
    for shading in [Shading::Gouraud, Shading::Phong] {
        let picture = oracle(&mut balls(plain, shading, |mesh| snapped(mesh, 256.0))).draw();
        let mut truth = balls(plain, shading, Mesh::clone);
        let verdict = float(&oracle(&mut truth), &picture);
        assert!(verdict.is_within(), "{shading:?}: {verdict}");
        let verdict = bytes(&mut truth, &picture, Encoding::Srgb);
        assert!(verdict.is_within(), "{shading:?} in bytes: {verdict}");
    }
    // A coarse grid moves slopes, too, and is over the bar where it is not known.
    for places in [16.0, 256.0] {
        let truth = oracle(&mut painted_balls(Mesh::clone));
        let picture = oracle(&mut painted_balls(|mesh| snapped(mesh, places))).draw();
        let verdict = on_grid(&truth, places.log2() as u32, &picture);
        assert!(verdict.is_within(), "painted, {places} places a pixel: {verdict}");
        let verdict = float(&truth, &picture);
        assert!(places > 16.0 || !verdict.is_within(), "the slopes do not move: {verdict}");
    }
}

#[test]
fn cracks_beside_inner_edges_are_found() {
    // A 96 × 48 sphere before a wall: the wall shows through wherever an inner edge passes a centre.
    let scene = |with_sphere: bool| {
        let mut stage = Stage::new();
        lamp(&mut stage);
        stage.add(wall(30.0, 8.0), (glow(1.0, 0.5, 0.1), Shading::Phong));
        if with_sphere {
            stage.add(ball(Vec3::new(0.0, 0.0, -2.0), 1.2, 96, 48), (Material::default(), Shading::Phong));
        }
        stage
    };
    let behind = oracle(&mut scene(false)).draw();
    let mut truth = scene(true);
    let judged = oracle(&mut truth);
    let picture = judged.draw();
    let triangles = |x: u32, y: u32| {
        [(0.47, 0.5), (0.53, 0.5), (0.5, 0.47), (0.5, 0.53)].map(|(dx, dy)| {
            let nearest = judged.probe(f64::from(x) + dx, f64::from(y) + dy).nearest.expect("the wall is behind");
            (nearest.object, nearest.triangle)
        })
    };
    let sphere = judged.probe(48.5, 48.5).nearest.expect("the sphere").object;
    let cracks: Vec<(u32, u32)> = all_pixels()
        .filter(|(x, y)| {
            let found = triangles(*x, *y);
            found.iter().all(|(object, _)| *object == sphere) && found.iter().any(|one| *one != found[0])
        })
        .collect();
    assert!(cracks.len() > 200, "{} pixels beside inner edges", cracks.len());
    assert!(float(&judged, &picture).is_within());
    assert_caught(
        "all cracks",
        &mut truth,
        &with(&picture, cracks.iter().map(|(x, y)| ((*x, *y), behind.pixel(*x, *y)))),
    );
    for (x, y) in cracks.iter().step_by(29) {
        let one = with(&picture, [((*x, *y), behind.pixel(*x, *y))]);
        assert_caught("one crack", &mut truth, &one);
    }
    // A seam is black.
    let (x, y) = cracks[cracks.len() / 2];
    assert_caught("a black pixel", &mut truth, &with(&picture, [((x, y), [0.0; 3])]));
}

#[test]
fn a_missing_object_is_found() {
    let scene = |with_ball: bool| {
        let mut stage = balls(plain, Shading::Gouraud, Mesh::clone);
        if with_ball {
            // Some 300 pixels; 2,000 triangles, so that most centres have an edge beside them.
            stage.add(ball(Vec3::new(1.4, 1.4, -2.5), 0.5, 64, 32), Material::default());
        }
        stage
    };
    let picture = oracle(&mut scene(false)).draw();
    let mut truth = scene(true);
    assert_caught("a missing ball", &mut truth, &picture);
}

#[test]
fn a_missing_light_is_found() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let scene = |with_light: bool| {
            let mut stage = balls(plain, shading, Mesh::clone);
            if with_light {
                let light = DirectionalLight { diffuse: grey(0.05), ..DirectionalLight::white() };
                stage.sun(light, Vec3::new(1.0, -0.5, -1.0));
            }
            stage
        };
        let picture = oracle(&mut scene(false)).draw();
        assert_caught("a missing light", &mut scene(true), &picture);
    }
}

/// A mesh under a lamp, before a wall that glows.
pub(crate) fn lit_before_a_wall(mesh: &Mesh) -> Stage {
    let mut stage = Stage::new();
    lamp(&mut stage);
    stage.add(wall(30.0, 8.0), glow(1.0, 0.5, 0.1));
    stage.add(mesh.clone(), Material::default());
    stage
}

#[test]
fn a_missing_triangle_is_found() {
    let mesh = ball(Vec3::new(0.0, 0.0, -2.0), 1.2, 96, 48);
    let scene = lit_before_a_wall;
    let mut truth = scene(&mesh);
    let judged = oracle(&mut truth);
    let mut triangles: Vec<u32> = (20..76)
        .step_by(5)
        .flat_map(|y| (20..76).step_by(7).map(move |x| (x, y)))
        .filter_map(|(x, y)| judged.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?.triangle)
        .filter(|triangle| *triangle > 1)
        .collect();
    triangles.dedup();
    assert!(triangles.len() > 50);
    for triangle in triangles.into_iter().step_by(9) {
        let picture = oracle(&mut scene(&without(&mesh, triangle as usize))).draw();
        assert_caught(&format!("triangle {triangle} missing"), &mut truth, &picture);
    }
}

#[test]
fn an_outline_moved_by_a_quarter_of_a_pixel_is_found() {
    let corners = [Vec3::new(-1.3, -1.1, -2.0), Vec3::new(1.2, -0.7, -2.0), Vec3::new(0.1, 1.4, -2.0)];
    let scene = |corner: usize, by: Vec2| {
        let mut stage = Stage::new();
        let mut corners = corners;
        corners[corner] = at_pixel(corners[corner], pixel(corners[corner]) + by);
        stage.add(triangle(corners, None), glow(1.0, 1.0, 1.0));
        stage.add(wall(30.0, 8.0), glow(0.3, 0.0, 0.0));
        stage
    };
    let mut truth = scene(0, Vec2::ZERO);
    for corner in 0..3 {
        for by in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
            let picture = oracle(&mut scene(corner, 0.25 * by)).draw();
            assert_caught(&format!("corner {corner} moved by {by}"), &mut truth, &picture);
            // A shift within a grid of four bits passes.
            let picture = oracle(&mut scene(corner, 0.06 * by)).draw();
            let verdict = float(&oracle(&mut truth), &picture);
            assert!(verdict.is_within(), "corner {corner}: {verdict}");
        }
    }
}

#[test]
fn an_exponent_one_hundredth_off_is_found() {
    for shading in [Shading::Gouraud, Shading::Phong] {
        for shininess in [5.0, 60.0] {
            let looks = |factor: f32| move |_: f32| glossy(shininess * factor);
            let truth = || oracle(&mut balls(looks(1.0), shading, Mesh::clone));
            // Bytes are too coarse for it.
            let picture = oracle(&mut balls(looks(1.01), shading, Mesh::clone)).draw();
            let verdicts = [float(&truth(), &picture), on_grid(&truth(), 4, &picture), on_grid(&truth(), 8, &picture)];
            for verdict in verdicts {
                assert!(!verdict.is_within(), "{shading:?}, {shininess}: {verdict}");
            }
            // Drawn on a coarse grid, too.
            let change = |mesh: &Mesh| snapped(mesh, 16.0);
            let picture = oracle(&mut balls(looks(1.01), shading, change)).draw();
            let verdict = on_grid(&truth(), 4, &picture);
            assert!(!verdict.is_within(), "{shading:?}, {shininess}, on a coarse grid: {verdict}");
        }
    }
}

#[test]
fn a_wrong_order_of_blended_sides_is_found() {
    let [near, far] = [(0.9, 0.1), (0.1, 0.9)].map(|(red, green)| Material { opacity: 0.5, ..glow(red, green, 0.2) });
    let mesh = ball(Vec3::new(0.0, 0.0, -2.0), 1.0, 32, 16);
    let mut truth = Stage::new();
    truth.add(mesh.clone(), (near, BackMaterial(far), Faces::Both, AlphaMode::Blend));
    // At equal depth the first spawned is drawn first.
    let mut wrong = Stage::new();
    wrong.add(mesh.clone(), (near, Faces::Front, AlphaMode::Blend));
    wrong.add(mesh.clone(), (far, Faces::Back, AlphaMode::Blend));
    let picture = oracle(&mut wrong).draw();
    assert_caught("the near side first", &mut truth, &picture);
    // One pixel is enough.
    let one = with(&oracle(&mut truth).draw(), [((50, 40), picture.pixel(50, 40))]);
    assert_caught("the near side first in one pixel", &mut truth, &one);
    let mut right = Stage::new();
    right.add(mesh.clone(), (far, Faces::Back, AlphaMode::Blend));
    right.add(mesh, (near, Faces::Front, AlphaMode::Blend));
    let verdict = float(&oracle(&mut truth), &oracle(&mut right).draw());
    assert!(verdict.is_within(), "{verdict}");
}

/// Panes with these opacities before a wall, the farthest first.
fn panes(opacities: &[f32]) -> Stage {
    let mut stage = Stage::new();
    stage.add(wall(30.0, 9.0), glow(0.55, 0.3, 0.05));
    for (i, opacity) in opacities.iter().enumerate() {
        let [red, blue] = [0.1, 0.7].map(|share| (share + 0.23 * i as f32).fract());
        let looks = Material { opacity: *opacity, ..glow(red, 0.4, blue) };
        stage.add(wall(30.0, 8.0 - i as f32), (looks, AlphaMode::Blend));
    }
    stage
}

#[test]
fn a_step_more_than_the_roundings_of_blended_layers_is_found() {
    for count in 0..6 {
        let mut truth = panes(&vec![0.15; count]);
        for encoding in [Encoding::Raw, Encoding::Srgb] {
            let picture = oracle(&mut truth).draw();
            let off_by = |steps: f64| {
                let here = picture.pixel(50, 40).map(|i| (encoding.encode(i) * 255.0).round() + steps);
                with(&picture, [((50, 40), here.map(|byte| encoding.decode(byte / 255.0)))])
            };
            // One step for the surface and the oracle, and a half for each layer.
            let allowed = (1.0 + 0.5 * count as f64).floor();
            let verdict = bytes(&mut truth, &off_by(allowed), encoding);
            assert!(verdict.is_within(), "{count} layers, {encoding:?}: {verdict}");
            assert_eq!(verdict.layered > 0.0, allowed > 1.0, "{count} layers, {encoding:?}: {verdict}");
            for steps in [allowed + 1.0, -allowed - 1.0] {
                let verdict = bytes(&mut truth, &off_by(steps), encoding);
                let is_one_more = (verdict.worst - (allowed + 1.0)).abs() < 1e-9;
                assert!(!verdict.is_within() && is_one_more, "{count} layers, {encoding:?}: {verdict}");
            }
            // Floating point is never rounded to bytes.
            let verdict = float(&oracle(&mut truth), &off_by(allowed));
            assert!(!verdict.is_within(), "{count} layers: {verdict}");
        }
    }
}

#[test]
fn bytes_rounded_after_each_blended_layer_pass() {
    for opacities in [&[0.5, 0.5][..], &[0.1, 0.2, 0.1], &[0.05; 5], &[0.9, 0.02, 0.3]] {
        for encoding in [Encoding::Raw, Encoding::Srgb] {
            let rounded = |i: f64| encoding.decode((encoding.encode(i) * 255.0).round() / 255.0);
            let mut stage = panes(&[]);
            let mut picture = oracle(&mut stage).draw().pixel(50, 40).map(rounded);
            for count in 1..=opacities.len() {
                // Pictures with and without a pane give its contribution.
                let [before, after] =
                    [count - 1, count].map(|n| oracle(&mut panes(&opacities[..n])).draw().pixel(50, 40));
                let opacity = f64::from(opacities[count - 1]);
                picture = std::array::from_fn(|k| {
                    rounded(picture[k] * (1.0 - opacity) + after[k] - before[k] * (1.0 - opacity))
                });
            }
            let mut truth = panes(opacities);
            let whole = Image::new(SIZE, SIZE, vec![picture; (SIZE * SIZE) as usize]);
            let verdict = bytes(&mut truth, &whole, encoding);
            assert!(verdict.is_within(), "{opacities:?}, {encoding:?}: {verdict}");
        }
    }
}

#[test]
fn black_pixels_between_facets_are_found() {
    let mut truth = Stage::new();
    lamp(&mut truth);
    truth.add(ball(Vec3::new(0.0, 0.0, -2.0), 1.2, 96, 48), (Material::default(), Shading::Flat, Faces::Both));
    let judged = oracle(&mut truth);
    let picture = judged.draw();
    // Where triangles are slivers, near the outline, but not on it.
    let is_inside = |x: u32, y: u32| {
        let corner = |dx: f64, dy: f64| judged.probe(f64::from(x) + dx, f64::from(y) + dy).nearest.is_some();
        corner(0.2, 0.5) && corner(0.8, 0.5) && corner(0.5, 0.2) && corner(0.5, 0.8)
    };
    let inside: Vec<_> = all_pixels().filter(|(x, y)| is_inside(*x, *y)).collect();
    let lit: Vec<_> = inside.iter().filter(|(x, y)| picture.pixel(*x, *y)[0] > 0.05).collect();
    assert!(lit.len() > 1000);
    for (x, y) in lit.into_iter().step_by(97) {
        assert_caught(&format!("({x}, {y}) black"), &mut truth, &with(&picture, [((*x, *y), [0.0; 3])]));
    }
}

/// A picture with four samples a pixel: each sample's triangle is shaded in the middle of the samples that it covers;
/// or, as by a renderer that forgets `centroid`, at the pixel's centre, inside the triangle or not.
fn four_samples(oracle: &Oracle, extrapolated: bool) -> Image {
    let seen = |x: u32, y: u32, [dx, dy]: [f64; 2]| oracle.probe(f64::from(x) + dx, f64::from(y) + dy);
    let pixel = |(x, y): (u32, u32)| {
        let of_sample = |at: [f64; 2]| {
            let here = seen(x, y, at);
            if !extrapolated || here.nearest.is_none() || seen(x, y, [0.5; 2]).nearest.is_some() {
                return here.color;
            }
            // On along the triangle, from two places close to each other, as far as the centre.
            let step = 1e-3;
            let beside =
                |axis: usize| seen(x, y, std::array::from_fn(|i| at[i] + if i == axis { step } else { 0.0 })).color;
            let (right, below) = (beside(0), beside(1));
            let along = |k: usize, axis: usize| ([right, below][axis][k] - here.color[k]) / step * (0.5 - at[axis]);
            std::array::from_fn(|k| here.color[k] + along(k, 0) + along(k, 1))
        };
        let samples = FOUR.map(of_sample);
        std::array::from_fn(|k| samples.iter().map(|color| color[k]).sum::<f64>() / 4.0)
    };
    Image::new(SIZE, SIZE, all_pixels().map(pixel).collect())
}

#[test]
fn an_object_only_at_centres_is_found_with_four_samples() {
    // A bar from top to bottom between the samples of column 48: the oracle's own picture, of the centres, shows it.
    let mut truth = Stage::new();
    *truth.camera() = Camera { samples: Samples::Four, ..*truth.camera() };
    let half = SIZE as f32 / 2.0;
    let [left, right] = [48.49, 48.51].map(|x| (x - half) / half);
    truth.add(panel(left, right, -9.0, 9.0, 1.0), glow(1.0, 0.8, 0.6));
    truth.add(wall(30.0, 8.0), glow(0.2, 0.3, 0.4));
    let judged = oracle(&mut truth);
    let (of_centres, right) = (judged.draw(), four_samples(&judged, false));
    let (bar, wall) = (of_centres.pixel(48, 40), right.pixel(48, 40));
    assert!(bar[0] > wall[0] + 0.5, "the centres meet the bar and the samples do not");
    let verdict = float(&judged, &right);
    assert!(verdict.is_within(), "{verdict}");
    assert_caught("the bar where no sample meets it", &mut truth, &of_centres);
    assert_caught("the bar in one pixel", &mut truth, &with(&right, [((48, 40), bar)]));
    let quarter = std::array::from_fn(|k| 0.75 * wall[k] + 0.25 * bar[k]);
    assert_caught("the bar in one sample", &mut truth, &with(&right, [((48, 40), quarter)]));
}

#[test]
fn colors_from_outside_a_triangle_are_found_with_four_samples() {
    let scene = |change: &dyn Fn(&Mesh) -> Mesh| {
        let mut stage = Stage::new();
        *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
        lamp(&mut stage);
        let mesh = ball(Vec3::new(0.0, 0.0, -2.0), 1.2, 24, 12);
        stage.add(change(&mesh), (Material::default(), Shading::Gouraud));
        stage
    };
    let mut truth = scene(&Mesh::clone);
    for places in [16.0, 256.0] {
        let picture = four_samples(&oracle(&mut scene(&|mesh| snapped(mesh, places))), false);
        let verdict = float(&oracle(&mut truth), &picture);
        // With four bits the slopes inside move by more than the bars.
        let within = if places < 256.0 { verdict.bad == 0 } else { verdict.is_within() };
        assert!(within && verdict.edges > 0.0, "{places} places a pixel: {verdict}");
    }
    let picture = four_samples(&oracle(&mut truth), true);
    assert!(picture.pixels().iter().flatten().any(|channel| *channel < 0.0), "some are negative");
    let without_negative = Image::new(SIZE, SIZE, picture.pixels().iter().map(|p| p.map(|i| i.max(0.0))).collect());
    assert!(!float(&oracle(&mut truth), &picture).is_within());
    assert_caught("extrapolated", &mut truth, &without_negative);
    let jagged = oracle(&mut truth).draw();
    assert_caught("one sample a pixel where there should be four", &mut truth, &jagged);
}

//! Passes without lighting: order, blending, formats, ranges of indices, and refused input.

use crate::common::{Scene, Shading, at, draw, lens, sphere};
use halfway_lighting::record::{Cull, LightRecord, MaterialRecord, SurfaceRecord};
use halfway_lighting::{Lens, Samples};
use halfway_raster::{
    ClearTiles, DrawCall, LARGEST_SIDE, Output, Pieces, PixelFormat, RasterError, RasterOptions, Rasterizer,
    TriangleOrder, VectorWidth, VertexLists,
};

/// Squares across the whole view at these depths, each of a color and an opacity.
fn squares(squares: &[(f32, [f32; 3], f32)], blend: bool) -> Scene {
    let corners = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]];
    let mesh = Pieces::new(&corners, VertexLists::default(), &[0, 1, 2, 0, 2, 3], &[0..3, 3..6], TriangleOrder::Kept)
        .expect("sound");
    let surface = |&(_, base, opacity): &(f32, [f32; 3], f32)| SurfaceRecord {
        front: MaterialRecord { base, opacity, ..MaterialRecord::default() },
        ..SurfaceRecord::default()
    };
    let call = |number: u32| DrawCall { instances: number..number + 1, blend, ..draw(&mesh, 0, Shading::Constant) };
    Scene {
        size: [70, 66],
        samples: Samples::One,
        pixels: PixelFormat::Floats,
        clear: [0.25, 0.5, 4.0],
        lens: lens([70, 66], 60.0),
        lights: Vec::new(),
        lists: Vec::new(),
        surfaces: squares.iter().map(surface).collect(),
        instances: squares.iter().zip(0..).map(|(&(depth, ..), number)| at([0.0, 0.0, -depth], number)).collect(),
        draws: (0..squares.len() as u32).map(call).collect(),
        meshes: vec![mesh],
    }
}

fn floats(scene: &Scene) -> Vec<[f32; 4]> {
    let mut floats = vec![f32::NAN; 4 * (scene.size[0] * scene.size[1]) as usize];
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    scene
        .with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats), &mut ClearTiles::default()))
        .expect("a sound pass");
    floats.as_chunks().0.to_vec()
}

fn every_pixel_is(scene: &Scene, expected: [f32; 3]) {
    for samples in [Samples::One, Samples::Four] {
        let scene = Scene { samples, draws: scene.draws.clone(), ..squares_like(scene) };
        for pixel in floats(&scene) {
            for c in 0..3 {
                assert!((pixel[c] - expected[c]).abs() < 1e-6, "{pixel:?} instead of {expected:?}, {samples:?}");
            }
            assert!((pixel[3] - 1.0).abs() < 1e-9);
        }
    }
}

/// The same lists in a scene of its own.
fn squares_like(scene: &Scene) -> Scene {
    let list: Vec<_> = scene
        .surfaces
        .iter()
        .zip(&scene.instances)
        .map(|(surface, instance)| (-instance.eye_from_model[2][3], surface.front.base, surface.front.opacity))
        .collect();
    squares(&list, false)
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 2.0];

#[test]
fn nothing_drawn_is_the_clear_color() {
    every_pixel_is(&squares(&[], false), [0.25, 0.5, 4.0]);
}

#[test]
fn nearer_surfaces_hide_farther_ones_in_any_order() {
    every_pixel_is(&squares(&[(2.0, RED, 1.0), (3.0, GREEN, 1.0), (2.5, BLUE, 1.0)], false), RED);
    every_pixel_is(&squares(&[(3.0, GREEN, 1.0), (2.5, BLUE, 1.0), (2.0, RED, 1.0)], false), RED);
}

#[test]
fn of_equal_depths_the_first_drawn_stays() {
    every_pixel_is(&squares(&[(2.0, GREEN, 1.0), (2.0, RED, 1.0)], false), GREEN);
}

#[test]
fn blended_surfaces_are_laid_over_in_order() {
    let scene = squares(&[(3.0, GREEN, 0.5), (2.0, RED, 0.25)], true);
    // Over the clear color green by a half, then red by a quarter, not clamped.
    every_pixel_is(&scene, [0.34375, 0.5625, 1.5]);
    let turned = squares(&[(2.0, RED, 0.25), (3.0, GREEN, 0.5)], true);
    every_pixel_is(&turned, [0.21875, 0.6875, 1.5]);
}

#[test]
fn blended_surfaces_are_drawn_after_opaque_ones() {
    let mut scene = squares(&[(2.0, RED, 0.5), (4.0, RED, 0.5), (3.0, GREEN, 1.0)], true);
    scene.draws[2].blend = false;
    every_pixel_is(&scene, [0.5, 0.5, 0.0]);
}

#[test]
fn triangles_of_a_mesh_blend_in_their_order() {
    // Squares of one mesh over each other, small and large in turn, each blended by a half.
    let mut positions = Vec::new();
    let mut scene = squares(&[(2.0, RED, 0.5)], true);
    for (number, reach) in [9.0_f32, 0.05, 9.0, 0.05, 0.05, 9.0].into_iter().enumerate() {
        let depth = -0.01 * number as f32;
        positions.extend([[-reach, -reach, depth], [reach, -reach, depth], [0.0, reach, depth]]);
    }
    // Front and back differ in color, and every other triangle is flipped.
    let indices: Vec<_> = (0..6)
        .flat_map(|k| if k % 2 == 0 { [3 * k, 3 * k + 1, 3 * k + 2] } else { [3 * k, 3 * k + 2, 3 * k + 1] })
        .collect();
    scene.meshes =
        vec![Pieces::new(&positions, VertexLists::default(), &indices, &[], TriangleOrder::Kept).expect("sound")];
    scene.surfaces[0].back = MaterialRecord { base: GREEN, opacity: 0.5, ..MaterialRecord::default() };
    scene.clear = [0.0; 3];
    scene.draws[0] = DrawCall { indices: 0..18, cull: Cull::None, ..scene.draws[0].clone() };
    let middle = floats(&scene)[(33 * 70 + 35) as usize];
    // Red and green by turns: Σ 2⁻ᵏ over every other k.
    let (red, green) = (1.0 / 4.0 + 1.0 / 16.0 + 1.0 / 64.0, 1.0 / 2.0 + 1.0 / 8.0 + 1.0 / 32.0);
    assert!((middle[0] - red).abs() < 1e-6 && (middle[1] - green).abs() < 1e-6, "{middle:?}");
}

#[test]
fn a_range_of_indices_draws_its_triangles() {
    let mut scene = squares(&[(2.0, RED, 1.0)], false);
    scene.draws[0].indices = 3..6;
    let reds = floats(&scene).iter().filter(|pixel| pixel[0] > 0.5).count();
    // About the upper left half of 70 × 66 pixels, since the diagonal may run differently.
    assert!((1_500..3_200).contains(&reds), "{reds}");
    scene.draws[0].indices = 1..6;
    let refused = refusal(&scene);
    assert_eq!(refused, RasterError::Cut { draw: 0, start: 1, end: 6 });
}

#[test]
fn bytes_are_clamped_and_encoded() {
    for (pixels, expected) in
        [(PixelFormat::SrgbBytes, [188, 137, 255, 255]), (PixelFormat::RawBytes, [128, 64, 255, 255])]
    {
        let mut scene = squares(&[(2.0, [0.5, 0.25, 7.0], 1.0)], false);
        scene.pixels = pixels;
        let mut bytes = vec![0; 4 * 70 * 66];
        let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
        scene
            .with_pass(|pass| rasterizer.draw(pass, Output::Bytes(&mut bytes), &mut ClearTiles::default()))
            .expect("a sound pass");
        assert!(bytes.chunks_exact(4).all(|pixel| pixel == expected), "{pixels:?}: {:?}", &bytes[..4]);
    }
}

#[test]
fn every_byte_of_srgb_is_the_nearest() {
    // Each step's own intensity, by the definition (IEC 61966-2-1) in f64.
    for step in 0..=255_u8 {
        let encoded = f64::from(step) / 255.0;
        let linear = if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
        let mut scene = squares(&[], false);
        (scene.size, scene.pixels, scene.clear) = ([1, 1], PixelFormat::SrgbBytes, [linear as f32; 3]);
        let mut bytes = [0; 4];
        let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
        scene
            .with_pass(|pass| rasterizer.draw(pass, Output::Bytes(&mut bytes), &mut ClearTiles::default()))
            .expect("a sound pass");
        assert_eq!(bytes, [step, step, step, 255]);
    }
}

#[test]
fn pictures_of_many_shapes_are_drawn_to_their_ends() {
    for size in [[1, 1], [1, 200], [200, 1], [63, 65], [64, 64], [129, 127]] {
        let mut scene = squares(&[(2.0, RED, 1.0)], false);
        scene.size = size;
        assert!(floats(&scene).iter().all(|pixel| pixel[0] > 0.5), "{size:?}");
    }
}

#[test]
fn the_largest_picture_is_drawn() {
    let mut scene = squares(&[(2.0, RED, 1.0)], false);
    (scene.size, scene.pixels) = ([LARGEST_SIDE, 33], PixelFormat::RawBytes);
    scene.lens = lens(scene.size, 0.5);
    let mut bytes = vec![0; 4 * LARGEST_SIDE as usize * 33];
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    scene
        .with_pass(|pass| rasterizer.draw(pass, Output::Bytes(&mut bytes), &mut ClearTiles::default()))
        .expect("a sound pass");
    assert!(bytes.chunks_exact(4).all(|pixel| pixel == [255, 0, 0, 255]));
}

fn refusal(scene: &Scene) -> RasterError {
    let [width, height] = scene.size.map(|side| side.min(64) as usize);
    let mut floats =
        vec![0.0; 4 * width.max(scene.size[0] as usize).min(70) * height.max(scene.size[1] as usize).min(66)];
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    scene
        .with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats), &mut ClearTiles::default()))
        .expect_err("an unsound pass")
}

#[test]
fn invalid_passes_are_refused_by_name() {
    type Spoil = fn(&mut Scene);
    let cases: [(&str, Spoil); 12] = [
        ("each side must be", |scene| scene.size = [LARGEST_SIDE + 1, 4]),
        ("each side must be", |scene| scene.size = [0, 4]),
        ("clear is NaN", |scene| scene.clear[1] = f32::NAN),
        ("near is 0", |scene| scene.lens.near = 0.0),
        ("near is NaN", |scene| scene.lens = Lens::orthographic([1.0; 2], [f32::NAN, 1.0])),
        ("far is inf", |scene| scene.lens = Lens::orthographic([1.0; 2], [0.0, f32::INFINITY])),
        ("eye_from_model is inf", |scene| scene.instances[0].eye_from_model[1][1] = f32::INFINITY),
        ("base is -1", |scene| scene.surfaces[0].front.base[2] = -1.0),
        ("opacity is 1.5", |scene| scene.surfaces[0].back.opacity = 1.5),
        ("surface reaches to 8", |scene| scene.instances[0].surface = 7),
        ("both reaches to 3", |scene| scene.surfaces[0].lights.both.count = 3),
        ("kind is 99", |scene| scene.lights.push(LightRecord { kind: 99, ..LightRecord::default() })),
    ];
    for (message, spoil) in cases {
        let mut scene = squares(&[(2.0, RED, 1.0)], false);
        spoil(&mut scene);
        let refusal = refusal(&scene).to_string();
        assert!(refusal.contains(message), "{refusal} does not say {message:?}");
    }
}

#[test]
fn meshes_that_are_not_sound_are_refused() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let of = |positions: &[[f32; 3]], normals: &[[f32; 3]], indices: &[u32], cuts: &[std::ops::Range<u32>]| {
        Pieces::new(
            positions,
            VertexLists { normals, ..VertexLists::default() },
            indices,
            cuts,
            TriangleOrder::Clustered,
        )
        .expect_err("it is not")
        .to_string()
    };
    assert!(of(&corners, &[], &[0, 1, 3], &[]).contains("an index reaches to 4, but there are 3"));
    assert!(of(&corners, &[], &[0, 1], &[]).contains("the last triangle"));
    assert!(of(&corners, &[[0.0; 3]], &[0, 1, 2], &[]).contains("normals"));
    assert!(of(&[[f32::NAN; 3]; 3], &[], &[0, 1, 2], &[]).contains("NaN"));
    assert!(of(&corners, &[], &[0, 1, 2], &[0..2, 2..3]).contains("cut 0"));
    assert!(of(&corners, &[], &[0, 1, 2, 0, 1, 2], std::slice::from_ref(&(0..3))).contains("cut 1"));
}

#[test]
fn an_unknown_simd_level_is_refused_with_a_list() {
    let refused = VectorWidth::named("mmx").expect_err("long gone").to_string();
    let plainest = VectorWidth::available().last().expect("one").to_string();
    assert!(refused.contains("\"mmx\"") && refused.contains(&plainest), "{refused}");
}

#[test]
fn collapsed_triangles_give_finite_pictures() {
    let mut scene = sphere(true, Shading::Phong).expect("a sound mesh");
    scene.pixels = PixelFormat::Floats;
    for rows in [
        [[0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, -3.0]],
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -3.0]],
        [[1e30, 0.0, 0.0, 0.0], [0.0, 1e30, 0.0, 0.0], [0.0, 0.0, 1e30, 0.0]],
        [[f32::MAX, f32::MAX, 0.0, 0.0], [0.0, f32::MAX, f32::MAX, 0.0], [0.0, f32::MAX, f32::MAX, f32::MAX]],
        [[1e-30, 0.0, 0.0, 0.0], [0.0, 1e-30, 0.0, 0.0], [0.0, 0.0, 1e-30, -3.0]],
    ] {
        for cull in [Cull::Back, Cull::None] {
            scene.instances[0].eye_from_model = rows;
            scene.draws[0].cull = cull;
            assert!(floats(&scene).as_flattened().iter().all(|x| x.is_finite() && *x >= 0.0), "{rows:?}");
        }
    }
}

/// One square in the middle of some pixels, on a clear color.
fn square_on(clear: [f32; 3], size: [u32; 2], pixels: PixelFormat, half: f32) -> Scene {
    let mut scene = squares(&[(20.0, RED, 1.0)], false);
    (scene.clear, scene.size, scene.pixels) = (clear, size, pixels);
    let corners = [[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]];
    scene.meshes = vec![
        Pieces::new(&corners, VertexLists::default(), &[0, 1, 2, 0, 2, 3], &[], TriangleOrder::Kept).expect("sound"),
    ];
    scene
}

/// Draws scenes after each other into one memory, each of a row by itself, and compares each with it drawn alone.
#[test]
fn pictures_drawn_over_each_other_are_those_drawn_alone() {
    use PixelFormat::{Floats, RawBytes, SrgbBytes};
    let scenes = [
        // A square that grows, goes and moves out of tiles; another color, size and format.
        square_on([0.0, 0.5, 0.25], [300, 200], SrgbBytes, 1.0),
        square_on([0.0, 0.5, 0.25], [300, 200], SrgbBytes, 8.0),
        square_on([0.0, 0.5, 0.25], [300, 200], SrgbBytes, 0.0),
        square_on([0.0, 0.5, 0.25], [300, 200], SrgbBytes, 1.0),
        square_on([0.0, 0.5, 0.75], [300, 200], SrgbBytes, 1.0),
        square_on([0.0, 0.5, 0.75], [300, 200], RawBytes, 1.0),
        square_on([0.0, 0.5, 0.75], [200, 300], RawBytes, 1.0),
        square_on([0.0, 0.5, 0.75], [200, 300], Floats, 1.0),
        square_on([0.0, 0.5, 0.75], [200, 300], RawBytes, 0.0),
    ];
    for threads in [1, 3] {
        let mut rasterizer = Rasterizer::new(RasterOptions { width: None, threads: Some(threads) }).expect("threads");
        let mut clear_tiles = ClearTiles::default();
        let (mut bytes, mut floats) = (vec![0; 4 * 60_000], vec![0.0; 4 * 60_000]);
        let (mut alone, mut floats_alone) = (bytes.clone(), floats.clone());
        for (number, scene) in scenes.iter().enumerate() {
            let [output, fresh] = if scene.pixels == Floats {
                [Output::Floats(&mut floats), Output::Floats(&mut floats_alone)]
            } else {
                [Output::Bytes(&mut bytes), Output::Bytes(&mut alone)]
            };
            let drawn = scene.with_pass(|pass| rasterizer.draw(pass, output, &mut clear_tiles));
            drawn.expect("a sound pass");
            scene.with_pass(|pass| rasterizer.draw(pass, fresh, &mut ClearTiles::default())).expect("a sound pass");
            assert!(bytes == alone && floats == floats_alone, "scene {number}, {threads} threads");
        }
    }
}

#[test]
fn tiles_that_stay_clear_are_not_written_again() {
    let scene = square_on([0.0; 3], [256, 192], PixelFormat::RawBytes, 1.0);
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    let mut clear_tiles = ClearTiles::default();
    let mut bytes = vec![0; 4 * 256 * 192];
    for frame in 0..2 {
        bytes.fill(7);
        let output = Output::Bytes(&mut bytes);
        let drawn = scene.with_pass(|pass| rasterizer.draw(pass, output, &mut clear_tiles));
        drawn.expect("a sound pass");
        // Four by three tiles, of which the square meets the two in the middle.
        let left_alone = bytes.as_chunks().0.iter().filter(|&&pixel| pixel == [7; 4]).count();
        assert_eq!(left_alone, if frame == 0 { 0 } else { 64 * 64 * 10 });
    }
}

//! The judge on pictures with four samples a pixel, with colours that curve within a pixel: environments in mirrors,
//! solids, and nearby lamps.

use bevy_color::LinearRgba;
use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::{Camera, Material, PointLight, Samples, Shading};
use halfway_mesh::{Mesh, UvSphere};
use halfway_reference::metrics::{Bars, Verdict, judge};
use halfway_reference::{Image, Oracle};
use halfway_texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
use halfway_texture::{SolidKind, SolidTexture};

use crate::scene::{SHADINGS, Stage, triangle};

const SIZE: u32 = 64;
/// Where the four samples of a pixel lie.
const FOUR: [[f64; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

/// A coarse mirror ball in an environment of this strength, with four samples a pixel.
fn mirror(strength: f32, shading: Shading) -> Stage {
    let mut stage = Stage::new();
    *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
    let wave = |x: f64| 0.3 + 0.2 * (4.0 * x).sin();
    let color = |[x, y, z]: [f64; 3]| [wave(x + y), wave(y - 0.5 * z), wave(z + 0.3), 1.0].map(|number| number as f32);
    let cube = Environment::from_fn(EnvironmentShape::Cube, 16, color).expect("a small environment");
    let mut maps = Assets::<EnvironmentMap>::default();
    let map = maps.add(EnvironmentMap::new(&cube).expect("a small environment"));
    stage.world.insert_resource(maps);
    stage.world.spawn(EnvironmentLight { strength, sky: false, ..EnvironmentLight::from(map) });
    let ball = Mesh::from(UvSphere::new(1.2, 12, 6));
    let positions = ball.positions().iter().map(|p| *p - 2.2 * Vec3::Z).collect();
    let ball = Mesh::from_parts(positions, Some(ball.normals().to_vec()), None, ball.indices().to_vec());
    let specular = LinearRgba::rgb(0.9, 0.8, 0.7);
    let material = Material { ambient: LinearRgba::BLACK, diffuse: LinearRgba::BLACK, specular, ..Material::DEFAULT };
    stage.add(ball.expect("a ball"), (Material { shininess: 1e5, ..material }, shading));
    stage
}

/// The picture of a correct renderer: each triangle is shaded once a pixel, at the centre if it covers that, else in
/// the middle of the samples that it covers; or, with `at_first_sample`, everything is shaded at the pixel's first
/// sample.
fn drawn(oracle: &Oracle, at_first_sample: bool) -> Image {
    let pixel = |x: u32, y: u32| {
        let seen = |[dx, dy]: [f64; 2]| oracle.probe(f64::from(x) + dx, f64::from(y) + dy);
        let triangle = |at: [f64; 2]| seen(at).nearest.map(|nearest| (nearest.object, nearest.triangle));
        let shown = FOUR.map(triangle);
        let of_sample = |number: usize| {
            let of = shown[number];
            if at_first_sample {
                return seen(FOUR[0]).color;
            }
            if of == triangle([0.5; 2]) {
                return seen([0.5; 2]).color;
            }
            let own: Vec<_> = FOUR.iter().zip(shown).filter(|(_, shown)| *shown == of).map(|(at, _)| at).collect();
            let middle = [0, 1].map(|axis| own.iter().map(|at| at[axis]).sum::<f64>() / own.len() as f64);
            seen(middle).color
        };
        let samples = [0, 1, 2, 3].map(of_sample);
        std::array::from_fn(|k| samples.iter().map(|color| color[k]).sum::<f64>() / 4.0)
    };
    Image::new(SIZE, SIZE, (0..SIZE * SIZE).map(|i| pixel(i % SIZE, i / SIZE)).collect())
}

fn judged(truth: &mut Stage, actual: &Image) -> Verdict {
    let oracle = truth.oracle(SIZE, SIZE);
    judge(&oracle, &oracle.draw(), actual, Bars::FLOAT).expect("pictures of one size")
}

#[test]
fn right_mirrored_environments_pass_with_four_samples() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let picture = drawn(&mirror(0.8, shading).oracle(SIZE, SIZE), false);
        let verdict = judged(&mut mirror(0.8, shading), &picture);
        assert!(verdict.is_within() && verdict.edges > 0.01, "{shading:?}: {verdict}");
    }
}

#[test]
fn faults_of_mirrored_environments_are_found_with_four_samples() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        let brighter = drawn(&mirror(0.84, shading).oracle(SIZE, SIZE), false);
        let verdict = judged(&mut mirror(0.8, shading), &brighter);
        assert!(!verdict.is_within(), "a twentieth brighter, {shading:?}: {verdict}");
        let jagged = drawn(&mirror(0.8, shading).oracle(SIZE, SIZE), true);
        let verdict = judged(&mut mirror(0.8, shading), &jagged);
        assert!(!verdict.is_within(), "one sample for all, {shading:?}: {verdict}");
    }
}

/// A coarse ball cut from a solid of which a pixel shows half a cell, with four samples a pixel.
fn cut(kind: SolidKind, brightest: f32, shading: Shading) -> Stage {
    let mut stage = Stage::new();
    *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(2.0, 3.0, 1.0)));
    let ball = Mesh::from(UvSphere::new(1.2, 12, 6));
    let solid = SolidTexture::new(kind, [[0.1, 0.2, 0.3], [brightest; 3]]).scaled(8.0);
    let at = GlobalTransform::from_xyz(0.0, 0.0, -2.2);
    stage.add_at(ball, at, (Material::default(), shading, solid));
    stage
}

#[test]
fn solids_pass_with_four_samples_where_they_are_right() {
    for (kind, shading) in SolidKind::ALL.into_iter().flat_map(|kind| SHADINGS.map(|shading| (kind, shading))) {
        let picture = drawn(&cut(kind, 1.0, shading).oracle(SIZE, SIZE), false);
        let verdict = judged(&mut cut(kind, 1.0, shading), &picture);
        assert!(verdict.is_within() && verdict.edges > 0.01, "{kind:?}, {shading:?}: {verdict}");
    }
}

#[test]
fn faults_of_solids_are_found_with_four_samples() {
    let shading = Shading::Gouraud;
    for kind in SolidKind::ALL {
        let brighter = drawn(&cut(kind, 1.0, shading).oracle(SIZE, SIZE), false);
        let verdict = judged(&mut cut(kind, 0.97, shading), &brighter);
        assert!(!verdict.is_within(), "a thirtieth brighter, {kind:?}: {verdict}");
        let jagged = drawn(&cut(kind, 1.0, shading).oracle(SIZE, SIZE), true);
        let verdict = judged(&mut cut(kind, 1.0, shading), &jagged);
        assert!(!verdict.is_within(), "one sample for all, {kind:?}: {verdict}");
    }
}

/// A floor under a lamp, of one triangle that reaches behind the eye or does not.
fn floor(is_cut: bool) -> Stage {
    let mut stage = Stage::new();
    *stage.camera() = Camera { samples: Samples::Four, ..*stage.camera() };
    stage.world.spawn((PointLight::white(), GlobalTransform::from_xyz(0.0, -0.1, -0.8)));
    let nearest = if is_cut { 1.0 } else { -0.2 };
    let corners = [Vec3::new(-9.0, -0.3, nearest), Vec3::new(9.0, -0.3, nearest), Vec3::new(0.0, -0.3, -40.0)];
    stage.add(triangle(corners, Some([Vec3::Y; 3])), (Material::default(), Shading::Phong));
    stage
}

/// The near plane leaves a quadrangle of a triangle, which is drawn as two triangles: a pixel on their seam is shaded
/// in both.
#[test]
fn only_seams_of_near_clipped_triangles_pass() {
    for is_cut in [true, false] {
        let mut truth = floor(is_cut);
        let oracle = truth.oracle(SIZE, SIZE);
        let plain = oracle.draw();
        let pixel = |i: u32| {
            let (x, y) = (i % SIZE, i / SIZE);
            let seen = |[dx, dy]: [f64; 2]| oracle.probe(f64::from(x) + dx, f64::from(y) + dy).color;
            if x != 24 || y < 40 {
                return plain.pixel(x, y);
            }
            let (first, second) =
                (seen([0.5; 2]), seen([0.5 * (FOUR[0][0] + FOUR[2][0]), 0.5 * (FOUR[0][1] + FOUR[2][1])]));
            std::array::from_fn(|k| 0.5 * (first[k] + second[k]))
        };
        let with_seam = Image::new(SIZE, SIZE, (0..SIZE * SIZE).map(pixel).collect());
        assert!(judged(&mut truth, &plain).is_within());
        let verdict = judged(&mut truth, &with_seam);
        assert_eq!(verdict.is_within(), is_cut, "cut: {is_cut}: {verdict}");
        let brighter = plain.pixels().iter().map(|pixel| pixel.map(|i| 1.03 * i)).collect();
        let verdict = judged(&mut truth, &Image::new(SIZE, SIZE, brighter));
        assert!(!verdict.is_within(), "a thirtieth brighter, cut: {is_cut}: {verdict}");
    }
}

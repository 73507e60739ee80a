//! Normals of heights, and normals from afar against the mean over all of them.

#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use halfway_texture::normals::{NormalMoments, decoded, from_heights, mean_length, toksvig};
use halfway_texture::{Pyramid, Sampling, TexelImage, TextureError, Wrap, lookup};
use std::f64::consts::TAU;

fn heights(width: u32, height: u32, of: impl Fn(f64, f64) -> f64) -> TexelImage {
    let texel = |x: u32, y: u32| [of(f64::from(x), f64::from(y)) as f32; 4];
    TexelImage::from_fn(width, height, texel).expect("a small image")
}

#[test]
fn normals_of_a_slope_and_of_a_wave() {
    // Half a texel up for each to the right, a quarter for each row upward, in the middle of a ramp.
    let ramp = heights(9, 9, |x, y| 0.5 * x - 0.25 * y);
    let normals = from_heights(&ramp, [Wrap::Clamp; 2], 1.0).expect("normals");
    let [x, y, z] = decoded(normals.texels()[4 * 9 + 4].map(f64::from));
    assert!((x / z + 0.5).abs() < 1e-6 && (y / z + 0.25).abs() < 1e-6 && (x * x + y * y + z * z - 1.0).abs() < 1e-6);
    // At an edge: clamped, half of it; repeated, the way down to the other side.
    let edge = |wrap| {
        let normals = from_heights(&ramp, [wrap; 2], 1.0).expect("normals");
        let [x, _, z] = decoded(normals.texels()[4 * 9].map(f64::from));
        x / z
    };
    assert!((edge(Wrap::Clamp) + 0.25).abs() < 1e-6 && (edge(Wrap::Repeat) - 1.75).abs() < 1e-6);
    // A wave that repeats, against its derivative; the difference of neighbours is sin(k)/k of it.
    let wave = heights(32, 1, |x, _| (TAU * x / 32.0).sin());
    let normals = from_heights(&wave, [Wrap::Repeat; 2], 2.0).expect("normals");
    for (k, texel) in normals.texels().iter().enumerate() {
        let [x, _, z] = decoded(texel.map(f64::from));
        assert!((x / z + 2.0 * (TAU * k as f64 / 32.0).cos() * (TAU / 32.0).sin()).abs() < 1e-5, "{k}");
    }
    assert!(matches!(from_heights(&wave, [Wrap::Repeat; 2], f32::NAN), Err(TextureError::NotFinite { .. })));
}

/// Bumps of every direction, about as steep as said.
fn bumps(steep: f32) -> TexelImage {
    let of = |x: f64, y: f64| {
        let wave = |i: f64, j: f64, phase: f64| (TAU * (i * x + j * y) / 64.0 + phase).sin();
        wave(5.0, 2.0, 0.3) + wave(-3.0, 7.0, 1.1) + wave(9.0, 4.0, 2.0) + wave(2.0, -11.0, 0.7)
    };
    from_heights(&heights(64, 64, of), [Wrap::Repeat; 2], steep).expect("normals")
}

fn power(n: [f64; 3], h: [f64; 3], s: f64) -> f64 {
    (0..3).map(|k| n[k] * h[k]).sum::<f64>().max(0.0).powf(s)
}

fn unit(d: [f64; 3]) -> [f64; 3] {
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    d.map(|x| x / length)
}

/// A highlight over the whole image and over parts of it: the mean over all texels is the truth, and what one lookup makes of
/// it is nearer with Toksvig's correction than without, and nearer still by moments.
#[test]
fn highlights_from_afar_are_nearer_with_corrected_exponents() {
    for (steep, s) in [(0.2, 30.0), (0.2, 100.0), (0.4, 30.0), (0.4, 100.0)] {
        let normals = bumps(steep);
        let (pyramid, moments) = (Pyramid::new(normals.clone()), NormalMoments::new(&normals).expect("moments"));
        let mut squares = [0.0; 4];
        let mut count = 0.0;
        for (level, tile) in [(4_usize, 16_usize), (5, 32), (6, 64)] {
            let tiles = 64 / tile;
            for at in 0..tiles * tiles {
                let [i, j] = [at % tiles, at / tiles];
                let uv = [i, j].map(|k| (k as f64 + 0.5) / tiles as f64);
                let side = tile as f64 / 64.0;
                let footprint = [[side, 0.0], [0.0, side]];
                for h in [[0.0, 0.0, 1.0], [0.2, 0.1, 1.0], [-0.1, 0.35, 1.0], [0.5, -0.2, 1.0]].map(unit) {
                    let texel = |k: usize| {
                        decoded(normals.texels()[(j * tile + k / tile) * 64 + i * tile + k % tile].map(f64::from))
                    };
                    let truth = (0..tile * tile).map(|k| power(texel(k), h, s)).sum::<f64>() / (tile * tile) as f64;
                    let sampling = Sampling::default();
                    let mean = decoded(lookup::at_level(&pyramid, &sampling, uv, level as f64));
                    let length = mean.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let n = unit(mean);
                    let [corrected, factor] = toksvig(length, s);
                    let spread = moments.at(&sampling, uv, footprint);
                    let [even, even_factor] = spread.exponent(s);
                    let found = [
                        power(n, h, s),
                        factor * power(n, h, corrected),
                        even_factor * power(spread.normal(), h, even),
                        spread.highlight(h, s),
                    ];
                    (0..4).for_each(|kind| squares[kind] += (found[kind] - truth).powi(2));
                    count += 1.0;
                }
            }
        }
        let [plain, by_length, by_trace, by_moments] = squares.map(|sum| (sum / count).sqrt());
        println!(
            "steepness {steep}, exponent {s}: RMS {plain:.4} plain, {by_length:.4} Toksvig, {by_trace:.4} one exponent by \
             moments, {by_moments:.4} two axes"
        );
        assert!(by_length < 0.6 * plain && by_trace < 0.6 * plain && by_moments < 0.5 * plain);
    }
}

/// The variance of slopes that a length stands for is (1 − |n|)/|n|: steeper slopes have it times the square.
#[test]
fn means_of_steeper_normals_are_shorter_by_the_square() {
    let texel = |length: f64| [0.5, 0.5, 0.5 * length + 0.5];
    let variance = |length: f64| (1.0 - length) / length;
    for length in [0.2, 0.7, 0.95] {
        for s in [0.0, 0.5, -1.0, 2.0] {
            let found = mean_length(texel(length), s);
            assert!((variance(found) - s * s * variance(length)).abs() < 1e-12, "{length}, {s}: {found}");
        }
        // As wide as Phong's lobe, whose exponent is a fourth of that of (n·h)^s.
        let [blinn, _] = toksvig(mean_length(texel(length), 1.0), 200.0);
        let [phong, _] = toksvig(mean_length(texel(length), 2.0), 50.0);
        assert!((blinn - 4.0 * phong).abs() < 1e-9, "{blinn}, {phong}");
    }
    // Of 8 bits some are a little longer than 1.
    assert_eq!(mean_length([0.5, 0.5, 1.001], 3.0), 1.0);
    assert_eq!(mean_length([1.0, 1.0, 1.0], f64::MAX), 1.0);
    assert!(mean_length([0.5_f64; 3], 1.0).abs() < 1e-30);
}

#[test]
fn one_normal_keeps_its_highlight() {
    assert_eq!(toksvig(1.0, 40.0), [40.0, 1.0]);
    assert!(toksvig(0.0_f64, 40.0).iter().all(|number| number.is_finite()));
    let even = TexelImage::from_fn(4, 4, |_, _| [0.6, 0.5, 0.99, 1.0]).expect("an image");
    let moments = NormalMoments::new(&even).expect("moments");
    let spread = moments.at(&Sampling::default(), [0.3_f64, 0.6], [[1.0, 0.0], [0.0, 1.0]]);
    assert!(spread.covariance.iter().all(|number| number.abs() < 1e-7), "{spread:?}");
    // In its own direction the highlight is 1, and a little beside about the power.
    let n = spread.normal();
    assert!((spread.highlight(n, 200.0) - 1.0).abs() < 1e-4);
    // Slopes of a normal that leans by 11° are apart by a little more than its angles are.
    let h = unit([n[0] + 0.05, n[1] - 0.03, n[2]]);
    assert!(
        (spread.highlight(h, 200.0) - power(n, h, 200.0)).abs() < 0.03,
        "{} {}",
        spread.highlight(h, 200.0),
        power(n, h, 200.0)
    );
    assert_eq!(spread.highlight([0.0, 0.0, -1.0], 50.0), 0.0);
    // f32 is near f64.
    let single = moments.at(&Sampling::default(), [0.3_f32, 0.6], [[1.0, 0.0], [0.0, 1.0]]);
    assert!((f64::from(single.highlight(h.map(|x| x as f32), 200.0)) - spread.highlight(h, 200.0)).abs() < 1e-3);
}

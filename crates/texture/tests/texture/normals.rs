//! Normals of heights, and normals from afar against the mean over all of them.

use halfway_texture::normals::{
    SlopeSpread, from_heights, lean_lobe, mean_length, slope_covariance, spread_length, toksvig,
};
use halfway_texture::{Pyramid, Sampling, TexelImage, TextureError, Wrap, lookup};
use std::f64::consts::TAU;

fn heights(width: u32, height: u32, of: impl Fn(f64, f64) -> f64) -> TexelImage {
    let texel = |x: u32, y: u32| [of(f64::from(x), f64::from(y)) as f32; 4];
    TexelImage::from_fn(width, height, texel).expect("a small image")
}

/// The normal that a texel, or a mean of texels, stands for. Means are shorter than 1.
fn decoded([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z].map(|number| 2.0 * number - 1.0)
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

/// Bumps in every direction, with slopes of about `steep`.
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

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// A highlight about the normal of mean slopes with this covariance: by an exponent for each direction, and by one for
/// all.
fn by_covariance([x, y]: [f64; 2], covariance: [f64; 3], h: [f64; 3], s: f64) -> [f64; 2] {
    let n = unit([x, y, 1.0]);
    // Beside it, along x, and at a right angle to both.
    let u = unit([1.0 - n[0] * n[0], -n[0] * n[1], -n[0] * n[2]]);
    let v = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]];
    let [xx, xy, yy, factor] = lean_lobe(covariance, s);
    let (a, b) = (dot(h, u), dot(h, v));
    let around = a * a + b * b;
    let along = if around > 0.0 { (xx * a * a + 2.0 * xy * a * b + yy * b * b) / around } else { 0.0 };
    let [even, even_factor] = toksvig(spread_length(covariance), s);
    [factor * power(n, h, along), even_factor * power(n, h, even)]
}

fn by_moments(spread: &SlopeSpread<f64>, h: [f64; 3], s: f64) -> [f64; 2] {
    by_covariance(spread.mean, spread.covariance(1.0), h, s)
}

/// A highlight over the whole image and over parts of it: the mean over all texels is the truth; one lookup is nearer
/// to it with Toksvig's correction than without, and nearer still by moments.
#[test]
fn corrected_exponents_improve_distant_highlights() {
    for (steep, s) in [(0.2, 30.0), (0.2, 100.0), (0.4, 30.0), (0.4, 100.0)] {
        let normals = bumps(steep);
        let pyramid = Pyramid::new(normals.clone());
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
                    let spread = SlopeSpread::filtered(&pyramid, &sampling, uv, footprint);
                    let [by_axes, by_one] = by_moments(&spread, h, s);
                    let found = [power(n, h, s), factor * power(n, h, corrected), by_one, by_axes];
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

/// Over waves along one axis a highlight is a streak: of one exponent it is a spot of the wrong shape, and of a
/// covariance with its axes swapped, mirrored, or without what they have in common it lies elsewhere.
#[test]
fn a_streak_needs_two_axes() {
    let of = |x: f64, y: f64| {
        let wave = TAU * (7.0 * x + 3.0 * y) / 64.0;
        wave.sin() + (2.0 * wave + 1.0).sin()
    };
    let normals = from_heights(&heights(64, 64, of), [Wrap::Repeat; 2], 0.5).expect("normals");
    let pyramid = Pyramid::new(normals.clone());
    let whole = [[1.0, 0.0], [0.0, 1.0]];
    let spread = SlopeSpread::filtered(&pyramid, &Sampling::default(), [0.3, 0.7], whole);
    let [xx, xy, yy] = spread.covariance(1.0);
    let s = 60.0;
    let mut squares = [0.0; 6];
    for at in 0..169 {
        let h = unit([f64::from(at % 13) / 12.0 - 0.5, f64::from(at / 13) / 12.0 - 0.5, 1.0]);
        let of_texel = |texel: &[f32; 4]| power(decoded(texel.map(f64::from)), h, s);
        let truth = normals.texels().iter().map(of_texel).sum::<f64>() / 4096.0;
        let mean = decoded(pyramid.level(6)[0].map(f64::from));
        let [exponent, factor] = toksvig(dot(mean, mean).sqrt(), s);
        let [by_axes, by_one] = by_moments(&spread, h, s);
        let faults =
            [[yy, xy, xx], [xx, -xy, yy], [xx, 0.0, yy]].map(|fault| by_covariance(spread.mean, fault, h, s)[0]);
        let found = [factor * power(unit(mean), h, exponent), by_one, by_axes, faults[0], faults[1], faults[2]];
        (0..6).for_each(|kind| squares[kind] += (found[kind] - truth).powi(2));
    }
    let [by_length, by_one, by_axes, faults @ ..] = squares.map(|sum: f64| (sum / 169.0).sqrt());
    println!("a streak: RMS {by_length:.4} Toksvig, {by_one:.4} one exponent by moments, {by_axes:.4} two axes");
    println!("of wrong covariances: {faults:.4?}");
    assert!(by_axes < 0.5 * by_length && by_axes < 0.5 * by_one, "{by_length}, {by_one}, {by_axes}");
    assert!(faults.iter().all(|fault| *fault > 0.5 * by_length), "{faults:?}, {by_length} Toksvig");
}

/// The inverse of Σ + I/s, from its definition; energy is kept; invalid covariances and infinite numbers give finite
/// results.
#[test]
fn a_lobe_is_as_wide_as_its_normals_and_its_own() {
    let cases = [(0.1_f64, 0.05, 0.3, 20.0), (0.0, 0.0, 0.0, 50.0), (2.0, -1.0, 0.5, 3.0), (0.2, 0.0, 0.0, 0.0)];
    for (xx, xy, yy, s) in cases {
        let [a, b, c, factor] = lean_lobe([xx, xy, yy], s);
        // (Σ + I/s)·inverse·s = s·I.
        let [sxx, sxy, syy] = [s * xx + 1.0, s * xy, s * yy + 1.0];
        let product = [sxx * a + sxy * b, sxx * b + sxy * c, sxy * a + syy * b, sxy * b + syy * c];
        let off = product.iter().zip([s, 0.0, 0.0, s]).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12 * (1.0 + s), "{xx}, {xy}, {yy}, {s}: {product:?}");
        assert!((factor - (sxx * syy - sxy * sxy).sqrt().recip()).abs() < 1e-12, "{factor}");
    }
    let [a, _, c, factor] = lean_lobe([0.1, 5.0, 0.1], 40.0);
    assert!(a > 0.0 && c > 0.0 && factor > 0.0 && factor <= 1.0);
    let far = slope_covariance([1.0_f32, -2.0], [250.0, 3.0, 256.0], f32::MAX);
    assert!(lean_lobe(far, 1e4).iter().chain(&far).all(|number| number.is_finite()), "{far:?}");
    // Rounding leaves no variance below 0, and steeper slopes have it times the square.
    assert_eq!(slope_covariance([0.5, 0.25], [0.2, 0.125, 0.0625], 1.0), [0.0; 3]);
    assert_eq!(slope_covariance([0.5, 0.25], [0.5, 0.25, 0.5], -2.0), [1.0, 0.5, 1.75]);
    assert_eq!(spread_length([1.0, 7.0, 1.0]), 0.5);
}

/// The variance of slopes that a length stands for is (1 − |n|)/|n|: steeper slopes have it times the square.
#[test]
fn steeper_slopes_shorten_the_mean_by_the_square() {
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
    let even = Pyramid::new(TexelImage::from_fn(4, 4, |_, _| [0.6, 0.5, 0.99, 1.0]).expect("an image"));
    let whole = [[1.0, 0.0], [0.0, 1.0]];
    let spread = SlopeSpread::filtered(&even, &Sampling::default(), [0.3_f64, 0.6], whole);
    let covariance = spread.covariance(1.0);
    assert!(covariance.iter().all(|number| number.abs() < 1e-7), "{spread:?}");
    // (x/z, y/z) of the texel, and the texel of it the same direction.
    assert!((spread.mean[0] - 0.2 / 0.98).abs() < 1e-6 && spread.mean[1].abs() < 1e-6, "{spread:?}");
    let n = unit(spread.texel().map(|number| 2.0 * number - 1.0));
    assert!((dot(n, unit([0.2, 0.0, 0.98])) - 1.0).abs() < 1e-12);
    // The power itself, in any direction.
    for h in [n, unit([n[0] + 0.05, n[1] - 0.03, n[2]])] {
        let [by_axes, by_one] = by_moments(&spread, h, 200.0);
        assert!((by_axes - power(n, h, 200.0)).abs() < 1e-4 && (by_one - power(n, h, 200.0)).abs() < 1e-4);
    }
    // f32 is near f64.
    let single =
        SlopeSpread::filtered(&even, &Sampling::default(), [0.3_f32, 0.6], whole.map(|way| way.map(|x| x as f32)));
    assert!(single.covariance(1.0).iter().all(|number| number.abs() < 1e-6), "{single:?}");
    // Of normals that lie flat, or point inward, slopes are kept within 16.
    let flat = Pyramid::new(TexelImage::from_fn(2, 1, |x, _| [x as f32, 0.5, 0.3, 1.0]).expect("an image"));
    let [slopes, squares] = flat.moments();
    assert_eq!((slopes.level(0)[0], slopes.level(0)[1]), ([-16.0, 0.0, 0.0, 1.0], [16.0, 0.0, 0.0, 1.0]));
    assert_eq!((slopes.level(1)[0][0], squares.level(1)[0]), (0.0, [256.0, 0.0, 0.0, 1.0]));
}

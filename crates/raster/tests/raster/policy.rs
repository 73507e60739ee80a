//! Policies over the finished picture against their equations in f64.

use halfway_lighting::equations::{aces, divisor, reinhard, srgb_encoded};
use halfway_lighting::{CHANNEL_MAX, Intensity};
use halfway_raster::{Output, PixelFormat, RasterError, RasterOptions, Rasterizer, VectorWidth};

/// Pixels of all magnitudes whose largest channel is 50, at an index where no vector begins. More than one part, and no
/// multiple of any width.
fn drawn() -> Vec<f32> {
    let mut state = 7_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0
    };
    let mut values: Vec<f32> = (0..4 * 40_003).map(|i| if i % 4 == 3 { 1.0 } else { 40.0 * next().powi(4) }).collect();
    values[4 * 33_333 + 1] = 50.0;
    values
}

const POLICIES: [(Intensity, Option<f32>); 6] = [
    (Intensity::Renormalize { smoothing: 0.0 }, None),
    (Intensity::Renormalize { smoothing: 0.0 }, Some(9.0)),
    (Intensity::Renormalize { smoothing: 0.75 }, Some(9.0)),
    (Intensity::Reinhard { white: 4.0 }, None),
    (Intensity::Reinhard { white: f32::MAX }, None),
    (Intensity::Aces, None),
];

fn expected(policy: Intensity, before: Option<f32>) -> impl Fn(f32) -> f64 {
    let by = match (policy, before) {
        (Intensity::Renormalize { smoothing }, Some(before)) => divisor(50.0, f64::from(before), f64::from(smoothing)),
        _ => 50.0,
    };
    move |i| match policy {
        Intensity::Reinhard { white } => reinhard(f64::from(i), f64::from(white).powi(-2)),
        Intensity::Aces => aces(f64::from(i)),
        _ => f64::from(i) / by,
    }
}

#[test]
fn each_policy_is_its_equation() {
    let drawn = drawn();
    let rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    for (policy, before) in POLICIES {
        let expected = expected(policy, before);
        let mut floats = vec![0.0; drawn.len()];
        let by = rasterizer.finish(&drawn, policy, before, Output::Floats(&mut floats), PixelFormat::Floats);
        let divides = matches!(policy, Intensity::Renormalize { .. });
        assert_eq!(by.expect("a sound policy").is_some(), divides);
        for (i, (from, to)) in drawn.iter().zip(&floats).enumerate() {
            let should = if i % 4 == 3 { 1.0 } else { expected(*from) };
            // A few roundings, relative to the result.
            assert!((f64::from(*to) - should).abs() <= 1e-6 * should, "{policy:?}: {to} for {should} of {from}");
        }
        for format in [PixelFormat::SrgbBytes, PixelFormat::RawBytes] {
            let mut bytes = vec![0; drawn.len()];
            let found = rasterizer.finish(&drawn, policy, before, Output::Bytes(&mut bytes), format);
            assert!(found.is_ok());
            for (i, (from, to)) in drawn.iter().zip(&bytes).enumerate() {
                let share = expected(*from).min(1.0);
                let share = if format == PixelFormat::SrgbBytes { srgb_encoded(share) } else { share };
                let should = if i % 4 == 3 { 255.0 } else { 255.0 * share };
                // Rounded to the nearest, but for a 400th of a step.
                assert!((f64::from(*to) - should).abs() <= 0.5025, "{policy:?}: {to} for {should}");
            }
        }
    }
}

#[test]
fn no_width_and_no_count_of_threads_changes_a_bit() {
    let drawn = drawn();
    for (policy, before) in POLICIES {
        let mut all = Vec::new();
        for width in VectorWidth::available() {
            for threads in [1, 3] {
                let options = RasterOptions { width: Some(width), threads: Some(threads) };
                let rasterizer = Rasterizer::new(options).expect("threads");
                let (mut bytes, mut floats) = (vec![0; drawn.len()], vec![0.0_f32; drawn.len()]);
                let by = rasterizer.finish(&drawn, policy, before, Output::Floats(&mut floats), PixelFormat::Floats);
                let same = rasterizer.finish(&drawn, policy, before, Output::Bytes(&mut bytes), PixelFormat::SrgbBytes);
                assert_eq!(by, same);
                let bits: Vec<u32> = floats.iter().map(|value| value.to_bits()).collect();
                all.push((bits, bytes, by.expect("a sound policy").map(f32::to_bits)));
            }
        }
        assert!(all.windows(2).all(|pair| pair[0] == pair[1]), "{policy:?}");
    }
}

#[test]
fn extremes_stay_numbers() {
    let drawn = [0.0, f32::MIN_POSITIVE, 1.0, 1.0, CHANNEL_MAX, f32::MAX, 1e19, 1.0];
    let rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    for (policy, before) in POLICIES {
        let mut floats = [0.0; 8];
        let done = rasterizer.finish(&drawn, policy, before, Output::Floats(&mut floats), PixelFormat::Floats);
        assert!(
            done.is_ok() && floats.iter().all(|value| value.is_finite() && *value >= 0.0),
            "{policy:?}: {floats:?}"
        );
    }
}

#[test]
fn invalid_policies_are_refused() {
    let rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    let (mut few, mut floats) = ([0_u8; 4], [0.0; 8]);
    let aces = Intensity::Aces;
    let finish = |policy, output: Output, format| rasterizer.finish(&[0.0; 8], policy, None, output, format);
    let lengths = RasterError::Finish { expected: 8, found: 4 };
    assert_eq!(finish(aces, Output::Bytes(&mut few), PixelFormat::RawBytes), Err(lengths));
    let formats = finish(aces, Output::Floats(&mut floats), PixelFormat::RawBytes);
    assert_eq!(formats, Err(RasterError::Finish { expected: 8, found: 8 }));
    for (policy, reason) in [(Intensity::Clamp, "each surface"), (Intensity::Reinhard { white: 0.0 }, "1 or more")] {
        let refused = finish(policy, Output::Floats(&mut floats), PixelFormat::Floats).expect_err("a bad policy");
        assert!(refused.to_string().contains(reason), "{refused}");
    }
}

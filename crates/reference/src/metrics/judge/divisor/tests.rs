//! Divisors that are right and wrong, with made-up surroundings.

use super::*;
use crate::metrics::judge::judge_with;
use crate::oracle::ColorRange;
use halfway_lighting::Encoding;

const SIZE: u32 = 128;

/// A smooth picture up to about 0.8 · `brightest`, with one pixel that is `brightest`.
fn undivided(seed: f64, brightest: f64) -> Image {
    let pixels = (0..SIZE * SIZE).map(|i| {
        let [x, y] = [i % SIZE, i / SIZE].map(|k| f64::from(k) / f64::from(SIZE));
        let wave = |phase: f64| 0.4 * brightest * (1.0 + (7.0 * x + phase).sin() * (5.0 * y + seed).cos());
        if (i % SIZE, i / SIZE) == BRIGHT { [brightest; 3] } else { [wave(0.0), wave(1.0), wave(seed)] }
    });
    Image::new(SIZE, SIZE, pixels.collect())
}

const BRIGHT: (u32, u32) = (60, 70);

/// The picture as bytes, or floats, store it.
fn written(image: &Image, bars: Bars) -> Image {
    match bars.measure {
        Measure::Range => Image::from_float(&image.to_float()),
        Measure::Steps(encoding) => {
            Image::from_bytes(&image::DynamicImage::from(image.to_bytes(encoding)).into_rgba8(), encoding)
        }
    }
}

const ALL: [Bars; 3] = [Bars::FLOAT, Bars::bytes(Encoding::Raw), Bars::bytes(Encoding::Srgb)];

/// One colour everywhere, except that the bright pixel may show `dim` instead.
fn surroundings(whole: &Image, dim: Option<f64>) -> impl Fn(u32, u32) -> Possible + Sync {
    let whole = whole.clone();
    move |x, y| {
        let alone = |color| ColorRange { low: color, high: color };
        let mut ranges = vec![alone(whole.pixel(x, y))];
        ranges.extend(dim.filter(|_| (x, y) == BRIGHT).map(|dim| alone([dim; 3])));
        Possible { is_edge: ranges.len() > 1, ranges, layers: 0 }
    }
}

fn verdict(whole: &Image, divisor: f64, dim: Option<f64>, actual: &Image, bars: Bars) -> Verdict {
    let expected = whole.clone().divided(divisor);
    judge_divided(surroundings(whole, dim), Samples::One, &expected, actual, bars).expect("one size")
}

/// Factors of the divisor, and whether they are right.
const OFF: [(f64, bool); 3] = [(1.0, true), (1.03, false), (0.97, false)];

#[test]
fn a_divisor_that_is_3_percent_off_is_found() {
    for case in 0..24 {
        let (seed, brightest) = (0.25 * f64::from(case), 1.04 * 1.18f64.powi(case));
        let whole = undivided(seed, brightest);
        for (bars, (off, is_right)) in ALL.into_iter().flat_map(|bars| OFF.map(|off| (bars, off))) {
            let actual = written(&whole.clone().scaled((off * brightest).recip()), bars);
            let alone = verdict(&whole, brightest, None, &actual, bars);
            assert_eq!(alone.is_within(), is_right, "{off} of {brightest}: {alone}");
        }
    }
}

/// The brightest pixel lies on an edge: with and without it, the divisors are both right, and no others are.
#[test]
fn on_an_edge_exactly_two_divisors_are_right() {
    for case in 0..24 {
        let (seed, brightest) = (0.25 * f64::from(case), 1.2 * 1.18f64.powi(case));
        // The rest of the picture reaches 0.8 of the brightest.
        let dim = 0.5 * brightest;
        let whole = undivided(seed, brightest);
        let hidden = |pixel: &[f64; 3]| if largest(*pixel) < brightest { *pixel } else { [dim; 3] };
        let without = Image::new(SIZE, SIZE, whole.pixels().iter().map(hidden).collect());
        let other = without.largest().max(1.0);
        for (bars, (off, is_right)) in ALL.into_iter().flat_map(|bars| OFF.map(|off| (bars, off))) {
            let actual = written(&without.clone().scaled((off * other).recip()), bars);
            let judged = verdict(&whole, brightest, Some(dim), &actual, bars);
            assert_eq!(judged.is_within(), is_right, "not shown, {off} of {other}: {judged}");
            let actual = written(&whole.clone().scaled((off * brightest).recip()), bars);
            let possible = |x, y| {
                let grey = |color| ColorRange { low: color, high: color };
                let is_edge = (x, y) == BRIGHT;
                let both = [grey(without.pixel(x, y)), grey(whole.pixel(x, y))];
                Possible { is_edge, ranges: both[..=usize::from(is_edge)].to_vec(), layers: 0 }
            };
            let expected = without.clone().divided(other);
            let judged = judge_divided(possible, Samples::One, &expected, &actual, bars).expect("one size");
            assert_eq!(judged.is_within(), is_right, "shown, {off} of {brightest}: {judged}");
        }
    }
}

#[test]
fn without_a_divisor_nothing_is_scaled() {
    let whole = undivided(1.0, 0.9);
    let darker = whole.clone().scaled(0.995);
    for (expected, is_right) in [(whole.clone(), false), (darker.clone(), true)] {
        let found = judge_divided(surroundings(&whole, None), Samples::One, &expected, &darker, Bars::FLOAT);
        assert_eq!(found.expect("one size").is_within(), is_right);
    }
    // Below 1 nothing is divided.
    let expected = whole.clone().divided(1.0);
    let found = judge_with(surroundings(&whole, None), Samples::One, &expected, &whole, Bars::FLOAT);
    assert!(found.expect("one size").is_within());
    for off in [0.97, 1.03] {
        let found = verdict(&whole, 1.0, None, &whole.clone().scaled(off), Bars::FLOAT);
        assert!(!found.is_within(), "{off}: {found}");
    }
}

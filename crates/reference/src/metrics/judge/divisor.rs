//! Judges a picture that was divided by its largest channel, by the one number that it was divided by.
//!
//! If the brightest pixel lies on an edge, two right renderers divide by different numbers, and then differ everywhere.
//! If each pixel were allowed any of those numbers, a wrong one would pass too.

use super::{Bars, Measure, Ruler, SizeMismatch, Verdict, judge_with, same_size};
use crate::Image;
use crate::oracle::Possible;
use halfway_lighting::Samples;
use rayon::prelude::*;

/// [`judge_with`], with the expected picture divided as `actual` was. The colours of `possible` are not divided.
pub(super) fn judge_divided(
    possible: impl Fn(u32, u32) -> Possible + Sync,
    samples: Samples,
    expected: &Image,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    same_size(actual, expected)?;
    let Some(divisor) = expected.divisor() else {
        return judge_with(possible, samples, expected, actual, bars);
    };
    let possible = |x, y| possible(x, y).mapped(|channel| channel / divisor);
    let factor = divided_like(&possible, expected, divisor.recip(), actual, bars);
    // An estimated factor is known to some 10⁻⁴, which takes a hundredth of the values across the middle of a step.
    let equal = if factor.to_bits() == 1.0f64.to_bits() { bars.equal } else { bars.equal - 0.05 };
    let bars = Bars { equal, ..bars };
    let scaled = expected.clone().scaled(factor);
    let possible = |x, y| possible(x, y).mapped(|channel| channel * factor);
    judge_with(possible, samples, &scaled, actual, bars)
}

/// The factor for the expected picture to be divided like the actual one; 1 if no picture that may be shown would have
/// been divided so. `one` is the intensity 1, below which nothing is divided, in the expected picture's units.
fn divided_like(
    possible: &(impl Fn(u32, u32) -> Possible + Sync),
    expected: &Image,
    one: f64,
    actual: &Image,
    bars: Bars,
) -> f64 {
    let bright = bright(expected, actual, bars);
    let ruler = Ruler::new(expected, bars);
    // Rounding to bytes blurs the factor: if 1 explains the values, it is 1.
    let is_explained = |(a, b): &&(f64, f64)| ruler.error(*b, *a) <= bars.most + ruler.allowed;
    let explained = bright.iter().filter(is_explained).count() as f64;
    let factor = factor_between(bright.clone());
    if explained >= MOST_EXPLAINED * bright.len() as f64 && matches!(bars.measure, Measure::Steps(_))
        || !factor.is_finite()
        || factor <= 0.0
    {
        return 1.0;
    }
    // The actual divisor relative to the expected one.
    let found = factor.recip();
    let off = within(bars);
    let width = expected.dimensions().0.max(1) as usize;
    if (found - 1.0).abs() <= off {
        return factor;
    }
    // The possible range of the largest channel of a pixel: from and to, one for each colour that it may show.
    let brightness = |i: usize| {
        let possible = possible((i % width) as u32, (i / width) as u32);
        let mut all = vec![[largest(expected.pixels()[i]); 2]];
        if ruler.has_choice(&possible) {
            all.extend(possible.ranges.iter().map(|range| [largest(range.low), largest(range.high)]));
        }
        all
    };
    let pixels = 0..expected.pixels().len();
    // Some pixel shows it, or nothing exceeds 1, and no pixel necessarily exceeds it.
    let [low, high] = [found * (1.0 - off), found * (1.0 + off)];
    let is_shown =
        || pixels.clone().into_par_iter().any(|i| brightness(i).iter().any(|[a, b]| *a <= high && *b >= low));
    let may_exceed = |i: &usize| largest(expected.pixels()[*i]) > high;
    let is_exceeded =
        || pixels.clone().into_par_iter().filter(may_exceed).any(|i| brightness(i).iter().all(|[low, _]| *low > high));
    if ((low..=high).contains(&one) || is_shown()) && !is_exceeded() { factor } else { 1.0 }
}

/// The fraction of bright channels that an error of the bars explains.
const MOST_EXPLAINED: f64 = 0.98;
/// Darker channels, relative to the expected picture's brightness, have quotients too inexact to use.
const DARKEST: f64 = 0.25;
/// Quotients that are farther from the median, relatively, belong to other surfaces.
const STRAY: f64 = 0.02;

/// The relative error of a divisor: the error that the bars allow the brightest channel.
fn within(bars: Bars) -> f64 {
    match bars.measure {
        Measure::Range => bars.worst + bars.steps / 255.0,
        Measure::Steps(encoding) => 1.0 - encoding.decode((1.0 - (bars.worst + bars.steps) / 255.0).max(0.0)),
    }
}

fn largest(pixel: [f64; 3]) -> f64 {
    pixel.into_iter().fold(0.0, f64::max)
}

/// Bright channels, expected and actual: each expected value once, as a large patch of one color is rounded alike
/// everywhere; and none that was clamped, if there are others.
fn bright(expected: &Image, actual: &Image, bars: Bars) -> Vec<(f64, f64)> {
    let least = DARKEST * expected.largest();
    let clamped = if matches!(bars.measure, Measure::Steps(_)) { 1.0 } else { f64::INFINITY };
    let channels = expected.pixels().iter().flatten().zip(actual.pixels().iter().flatten());
    let is_bright = |(a, b): &(f64, f64)| *a > 0.0 && *a >= least && b.is_finite() && *b >= 0.0;
    let mut bright: Vec<(f64, f64)> = channels.map(|(a, b)| (*a, *b)).filter(is_bright).collect();
    if bright.iter().any(|(_, b)| *b < clamped) {
        bright.retain(|(_, b)| *b < clamped);
    }
    bright.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    bright.dedup_by_key(|(a, _)| a.to_bits());
    bright
}

/// The ratio of the brightness of two pictures that are mostly alike: the median quotient of bright channels, refined
/// by least squares over the values near it. 1 if nothing is bright.
fn factor_between(mut bright: Vec<(f64, f64)>) -> f64 {
    bright.sort_unstable_by(|a, b| (a.1 / a.0).total_cmp(&(b.1 / b.0)));
    let Some(median) = bright.get(bright.len() / 2).map(|(a, b)| b / a) else { return 1.0 };
    let near = bright.iter().filter(|(a, b)| (b / a - median).abs() <= STRAY * median);
    let (products, squares) = near.fold((0.0, 0.0), |(ab, aa), (a, b)| (ab + a * b, aa + a * a));
    if squares > 0.0 { products / squares } else { 1.0 }
}

#[cfg(test)]
mod tests;

//! A picture that was divided by its largest channel, judged by the one number that it was divided by.
//!
//! Where the brightest pixel lies on an edge, two drawers that are both right divide by different numbers, and then
//! differ everywhere. Were each pixel allowed any of those numbers, a wrong one would pass too.

use super::{Bars, Measure, Ruler, SizeMismatch, Verdict, judge_with, same_size};
use crate::Image;
use crate::oracle::Possible;
use halfway_lighting::Samples;
use rayon::prelude::*;

/// [`judge_with`], with what is expected divided as `actual` was. What `possible` says has not been divided.
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
    // A factor that was found is known to some 10⁻⁴, which takes a hundredth of the values across the middle of a step.
    let equal = if factor.to_bits() == 1.0f64.to_bits() { bars.equal } else { bars.equal - 0.05 };
    let bars = Bars { equal, ..bars };
    let scaled = expected.clone().scaled(factor);
    let possible = |x, y| possible(x, y).mapped(|channel| channel * factor);
    judge_with(possible, samples, &scaled, actual, bars)
}

/// What the expected picture is multiplied by to be divided like the actual one; 1 where no picture that may be shown
/// would have been divided so. `one` is the intensity 1, below which nothing is divided, as the expected picture shows
/// it.
fn divided_like(
    possible: &(impl Fn(u32, u32) -> Possible + Sync),
    expected: &Image,
    one: f64,
    actual: &Image,
    bars: Bars,
) -> f64 {
    let bright = bright(expected, actual, bars);
    let ruler = Ruler::new(expected, bars);
    // Rounding to bytes blurs the factor: where 1 explains them, it is 1.
    let is_explained = |(a, b): &&(f64, f64)| ruler.error(*b, *a) <= bars.most + ruler.allowed;
    let explained = bright.iter().filter(is_explained).count() as f64;
    let factor = factor_between(bright.clone());
    if explained >= MOST_EXPLAINED * bright.len() as f64 && matches!(bars.measure, Measure::Steps(_))
        || !factor.is_finite()
        || factor <= 0.0
    {
        return 1.0;
    }
    // The actual divisor as a part of the expected one.
    let found = factor.recip();
    let off = within(bars);
    let width = expected.dimensions().0.max(1) as usize;
    if (found - 1.0).abs() <= off {
        return factor;
    }
    // What the largest channel of a pixel may be: from and to, one for each colour that it may show.
    let brightness = |i: usize| {
        let possible = possible((i % width) as u32, (i / width) as u32);
        let mut all = vec![[largest(expected.pixels()[i]); 2]];
        if ruler.has_choice(&possible) {
            all.extend(possible.ranges.iter().map(|range| [largest(range.low), largest(range.high)]));
        }
        all
    };
    let pixels = 0..expected.pixels().len();
    // Some pixel shows it, or nothing exceeds 1, and no pixel cannot but exceed it.
    let [low, high] = [found * (1.0 - off), found * (1.0 + off)];
    let is_shown =
        || pixels.clone().into_par_iter().any(|i| brightness(i).iter().any(|[a, b]| *a <= high && *b >= low));
    let may_exceed = |i: &usize| largest(expected.pixels()[*i]) > high;
    let is_exceeded =
        || pixels.clone().into_par_iter().filter(may_exceed).any(|i| brightness(i).iter().all(|[low, _]| *low > high));
    if ((low..=high).contains(&one) || is_shown()) && !is_exceeded() { factor } else { 1.0 }
}

/// The share of bright channels that an error of the bars explains.
const MOST_EXPLAINED: f64 = 0.98;
/// Of darker channels the quotient says little, as a share of the expected picture's brightness.
const DARKEST: f64 = 0.25;
/// Quotients that are farther from the median are of other things, as a share.
const STRAY: f64 = 0.02;

/// How far a divisor may be off, as a share: what the bars allow the brightest channel.
fn within(bars: Bars) -> f64 {
    match bars.measure {
        Measure::Range => bars.worst + bars.steps / 255.0,
        Measure::Steps(encoding) => 1.0 - encoding.decode((1.0 - (bars.worst + bars.steps) / 255.0).max(0.0)),
    }
}

fn largest(pixel: [f64; 3]) -> f64 {
    pixel.into_iter().fold(0.0, f64::max)
}

/// Bright channels, as they are expected and as they are: each expected value once, as a large patch of one color is
/// rounded alike everywhere; and none that was clamped, where there are others.
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

/// The factor by which one picture is brighter than another where most of both is alike: the median quotient of bright
/// channels, and the least squares of what lies near it. 1 where nothing is bright.
fn factor_between(mut bright: Vec<(f64, f64)>) -> f64 {
    bright.sort_unstable_by(|a, b| (a.1 / a.0).total_cmp(&(b.1 / b.0)));
    let Some(median) = bright.get(bright.len() / 2).map(|(a, b)| b / a) else { return 1.0 };
    let near = bright.iter().filter(|(a, b)| (b / a - median).abs() <= STRAY * median);
    let (products, squares) = near.fold((0.0, 0.0), |(ab, aa), (a, b)| (ab + a * b, aa + a * a));
    if squares > 0.0 { products / squares } else { 1.0 }
}

#[cfg(test)]
mod tests;

//! Pictures of drawers that may move what they draw.

use std::collections::HashMap;

use rayon::prelude::*;

use super::divisor::judge_divided;
use super::{Bars, EDGE_RADIUS, Ruler, SizeMismatch, Verdict};
use crate::oracle::ColorRange;
use crate::{Image, Oracle};

/// [`judge`](super::judge) for a drawer that may move what it draws by N pixels on the picture: each pixel is right
/// that shows, give or take the bars, what lies between the oracle's colours within that distance and half a pixel of
/// its middle. `fine` is the oracle's picture with [`FINENESS`] times as many columns and rows, in which these are
/// found, and in `expected`, which shows what is at the middle itself. Of a pixel that is over the bar by these, the
/// oracle is asked at points 1/16 of a pixel apart, and from the extreme ones on for what is more extreme. As gaps are
/// left all the same, they say less than all that is right.
///
/// # Errors
/// [`SizeMismatch`].
pub fn judge_moved(
    oracle: &Oracle,
    (expected, fine): (&Image, &Image),
    pixels: f64,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    let (width, height) = expected.dimensions();
    if fine.dimensions() != (FINENESS * width, FINENESS * height) {
        return Err(SizeMismatch { actual: fine.dimensions(), expected: (FINENESS * width, FINENESS * height) });
    }
    let alike = expected.divisor().map(|divisor| fine.clone().divided(divisor));
    let radius = pixels + 0.5;
    let mut ranges = ranges_within(expected, alike.as_ref().unwrap_or(fine), radius);
    let divisor = expected.divisor().unwrap_or(1.0);
    let shown = |x, y| oracle.shown(x, y).map(|channel| channel / divisor);
    widen(&mut ranges, shown, (expected, actual), radius, bars)?;
    let possible = |x, y| oracle.possible(x, y, EDGE_RADIUS);
    judge_divided(possible, oracle.samples(), (expected, Some(&ranges)), actual, bars)
}

/// How much finer the picture of [`judge_moved`] is.
pub const FINENESS: u32 = 4;

/// How many points along a pixel the oracle is asked at where that is not fine enough.
const FINEST: u32 = 16;

/// Of each pixel the colours within N pixels of its middle, which lies between pixels of `fine`.
pub(super) fn ranges_within(expected: &Image, fine: &Image, radius: f64) -> Vec<ColorRange> {
    let (width, height) = fine.dimensions();
    let (columns, rows) = (width / FINENESS, height / FINENESS);
    let of_pixel = |i: u32| {
        let near = points_within([i % columns, i / columns], radius, FINENESS, [columns, rows]);
        let near = near.map(|[x, y]| fine.pixel(x, y));
        ColorRange::of(near.chain([expected.pixels()[i as usize]]))
    };
    (0..columns * rows).into_par_iter().map(of_pixel).collect()
}

/// The pixels of a picture so many times as fine of which the middles lie within N pixels of that of a pixel.
fn points_within(pixel: [u32; 2], radius: f64, finer: u32, size: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let finer = f64::from(finer);
    let middle = pixel.map(|at| (f64::from(at) + 0.5) * finer);
    let reach = radius * finer;
    let along = move |axis: usize| {
        let [first, end] = [(middle[axis] - reach).floor().max(0.0), (middle[axis] + reach).ceil()];
        first as u32..(end as u32).min((f64::from(size[axis]) * finer) as u32)
    };
    let near = along(1).flat_map(move |y| along(0).map(move |x| [x, y]));
    near.filter(move |&[x, y]| {
        let [dx, dy] = [(x, middle[0]), (y, middle[1])].map(|(at, middle)| f64::from(at) + 0.5 - middle);
        dx * dx + dy * dy <= reach * reach
    })
}

/// Adds what is `shown` at many more points within N pixels to the ranges of pixels that are over the bar by them, and
/// what is most and least near the points where it is so: corners of triangles are extremes.
pub(super) fn widen(
    ranges: &mut [ColorRange],
    shown: impl Fn(f64, f64) -> [f64; 3] + Sync,
    (expected, actual): (&Image, &Image),
    radius: f64,
    bars: Bars,
) -> Result<(), SizeMismatch> {
    super::same_size(actual, expected)?;
    let ruler = Ruler::new(expected, bars);
    let size @ [columns, _] = <[u32; 2]>::from(expected.dimensions());
    let is_over = |is: &[f64; 3], range: &ColorRange| {
        ruler.errors_outside(*is, range).iter().any(|error| *error > bars.most + ruler.allowed)
    };
    ranges.par_iter_mut().zip(actual.pixels()).enumerate().for_each(|(i, (range, is))| {
        if !is_over(is, range) {
            return;
        }
        let pixel = [i as u32 % columns, i as u32 / columns];
        let points = points_within(pixel, radius, FINEST, size);
        let at = |point: [u32; 2]| point.map(|along| (f64::from(along) + 0.5) / f64::from(FINEST));
        let points: Vec<([f64; 2], [f64; 3])> = points.map(at).map(|[x, y]| ([x, y], shown(x, y))).collect();
        *range = range.with(&ColorRange::of(points.iter().map(|(_, color)| *color)));
        let is_within = |place: [f64; 2]| {
            let [dx, dy] = [0, 1].map(|axis| place[axis] - f64::from(pixel[axis]) - 0.5);
            let is_there = |axis: usize| (0.0..=f64::from(size[axis])).contains(&place[axis]);
            dx * dx + dy * dy <= radius * radius && is_there(0) && is_there(1)
        };
        for (channel, sign) in (0..3).flat_map(|channel| [(channel, 1.0), (channel, -1.0)]) {
            let value = |color: &[f64; 3]| sign * color[channel];
            let is_beyond =
                |range: &ColorRange| value(is) > value(&range.low).max(value(&range.high)) && is_over(is, range);
            if !is_beyond(range) {
                continue;
            }
            for (place, color) in extremes(&points, value).into_iter().take(MOST_CLIMBED) {
                let most = climbed((place, value(&color)), |place| {
                    is_within(place).then(|| shown(place[0], place[1])).map(|color| (value(&color), color))
                });
                *range = range.with(&ColorRange::of(most));
                if !is_beyond(range) {
                    break;
                }
            }
        }
    });
    Ok(())
}

/// Of the points in each pixel of the finer picture the one with the greatest value, the greatest of all first.
fn extremes(points: &[([f64; 2], [f64; 3])], value: impl Fn(&[f64; 3]) -> f64) -> Vec<([f64; 2], [f64; 3])> {
    let cell = |place: [f64; 2]| place.map(|along| (along * f64::from(FINENESS)) as u32);
    let mut greatest: HashMap<[u32; 2], ([f64; 2], [f64; 3])> = HashMap::new();
    for &(place, color) in points {
        let best = greatest.entry(cell(place)).or_insert((place, color));
        if value(&color) > value(&best.1) {
            *best = (place, color);
        }
    }
    let mut greatest: Vec<_> = greatest.into_values().collect();
    // Those of one value by their places, as a table has no order.
    let by_place = |a: [f64; 2], b: [f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    greatest.sort_unstable_by(|a, b| value(&b.1).total_cmp(&value(&a.1)).then_with(|| by_place(a.0, b.0)));
    greatest
}

/// What is met on the way from a place with a value to greater ones, first by half of the way between two points.
fn climbed(
    (mut place, mut most): ([f64; 2], f64),
    shown: impl Fn([f64; 2]) -> Option<(f64, [f64; 3])>,
) -> Option<[f64; 3]> {
    let (mut step, mut found) = (0.5 / f64::from(FINEST), None);
    for _ in 0..TRIALS {
        let ways = (0..9).filter(|way| *way != 4).map(|way| [f64::from(way % 3 - 1), f64::from(way / 3 - 1)]);
        let there = ways.map(|[x, y]| [place[0] + step * x, place[1] + step * y]);
        let there = there.filter_map(|place| shown(place).map(|(value, color)| (place, value, color)));
        match there.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((better, value, color)) if value > most => (place, most, found) = (better, value, Some(color)),
            _ => step *= 0.5,
        }
    }
    found
}

/// How often a greater value is looked for farther on, or half as far.
const TRIALS: u32 = 16;

/// From so many pixels of the finer picture, about a third of those within a pixel.
const MOST_CLIMBED: usize = 16;

//! What an image has at least and at most over a part of it, whatever filter looks it up.

use crate::halves::Level;
use crate::sampling::{LevelFilter, Sampling, TexelFilter, Wrap, wrapped_index};

/// The least and the largest numbers of an image's texels under squares of it, on levels of at most 32 × 32 squares:
/// 43 KiB an image, and less of small ones.
#[derive(Clone, Debug)]
pub struct TexelRanges {
    /// The number in the pyramid of the first level, the others follow; and what each has.
    first: usize,
    levels: Vec<Vec<TexelRange>>,
    /// Of all texels.
    whole: TexelRange,
}

/// The least and the largest of some texels, number by number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelRange {
    /// The least.
    pub least: [f32; 4],
    /// The largest.
    pub most: [f32; 4],
}

/// The most squares along a side.
const SQUARES: u32 = 32;

/// Levels are looked at from the first on of which a part has this number of squares along a side, or fewer.
const LOOKED_AT: i64 = 12;

/// What weights below 0 of Catmull and Rom's filter sum up to: up to 1/8 along an axis, of which the others sum up to
/// 9/8.
const OVERSHOOT: f32 = 2.0 * 0.125 * 1.125;

/// Texels beyond this are not summed up without overflow.
const LARGEST: f32 = 1e30;

/// Coordinates beyond this have no digits left for texels.
const FARTHEST: f32 = 65536.0;

impl TexelRange {
    const NONE: Self = Self { least: [f32::INFINITY; 4], most: [f32::NEG_INFINITY; 4] };

    fn of(texel: [f32; 4]) -> Self {
        Self { least: texel, most: texel }
    }

    fn with(&mut self, other: &Self) {
        for k in 0..4 {
            self.least[k] = self.least[k].min(other.least[k]);
            self.most[k] = self.most[k].max(other.most[k]);
        }
    }

    /// What filters make of such texels: with what overshoots, and what sums round.
    fn filtered(mut self, sampling: Sampling) -> Self {
        let overshoots = [sampling.magnify, sampling.minify].contains(&TexelFilter::CatmullRom);
        for k in 0..4 {
            let (least, most) = (self.least[k], self.most[k]);
            let beyond = if overshoots { OVERSHOOT * (most - least) } else { 0.0 } + 1e-5 * least.abs().max(most.abs());
            (self.least[k], self.most[k]) = (least - beyond, most + beyond);
        }
        self
    }
}

impl TexelRanges {
    pub(crate) fn new(levels: &[Level], texels: &[[f32; 4]]) -> Self {
        let is_small = |level: &Level| level.width.max(level.height) <= SQUARES;
        let first = levels.iter().position(is_small).unwrap_or(levels.len() - 1);
        let texels_of = |level: &Level| &texels[level.start..][..level.width as usize * level.height as usize];
        let mut squares = empty(&levels[first]);
        for level in &levels[..=first] {
            let ranges = texels_of(level).iter().map(|texel| TexelRange::of(*texel));
            gather(&mut squares, &levels[first], ranges, level);
        }
        let mut made = vec![squares];
        for pair in levels[first..].windows(2) {
            let mut squares = empty(&pair[1]);
            gather(&mut squares, &pair[1], made[made.len() - 1].iter().copied(), &pair[0]);
            gather(&mut squares, &pair[1], texels_of(&pair[1]).iter().map(|texel| TexelRange::of(*texel)), &pair[1]);
            made.push(squares);
        }
        let mut whole = TexelRange::NONE;
        made[made.len() - 1].iter().for_each(|range| whole.with(range));
        Self { first, levels: made, whole }
    }

    /// The bytes that it takes.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| size_of_val(&level[..])).sum()
    }

    /// Of the image that it was made of: what [`filtered`](crate::lookup::filtered) may give wherever u and v are from
    /// `low` to `high`, or a texel beside that of the level that is taken, whatever the footprint; a little more.
    /// `None` where texels are too large for sums of them.
    pub(crate) fn within(
        &self,
        (levels, texels): (&[Level], &[[f32; 4]]),
        sampling: Sampling,
        low: [f32; 2],
        high: [f32; 2],
    ) -> Option<TexelRange> {
        if self.whole.least.iter().chain(&self.whole.most).any(|number| number.abs() >= LARGEST) {
            return None;
        }
        let is_known = low.iter().chain(&high).all(|at| at.abs() <= FARTHEST);
        // Filters that go by the footprint's shape reach as far as it.
        if !is_known || sampling.levels != sampling.levels.by_level() {
            return Some(self.whole.filtered(sampling));
        }
        let reach = 1.0 + [sampling.magnify, sampling.minify].map(reach).into_iter().fold(0.0, f64::max);
        let part = |level: &Level| {
            let sides = [level.width, level.height];
            [0, 1].map(|axis| {
                let side = f64::from(sides[axis]);
                // What f32 rounds of coordinates, and of ways on the image.
                let reach = reach + 0.01 + 1e-6 * side * f64::from(low[axis].abs().max(high[axis].abs()));
                let [low, high] = [f64::from(low[axis]) * side - reach, f64::from(high[axis]) * side + reach];
                SpanOfTexels::new(sampling.wrap[axis], low.floor() as i64, high.floor() as i64, sides[axis])
            })
        };
        let is_little = |level: &Level| part(level).iter().all(|span| span.count <= LOOKED_AT);
        let from = levels[self.first..].iter().position(is_little).unwrap_or(levels.len() - 1 - self.first);
        let mut range = TexelRange::NONE;
        let squares = &self.levels[from];
        each(&levels[self.first + from], part(&levels[self.first + from]), |at| range.with(&squares[at]));
        if sampling.levels != LevelFilter::None {
            for level in &levels[self.first + from + 1..] {
                each(level, part(level), |at| range.with(&TexelRange::of(texels[level.start + at])));
            }
        }
        Some(range.filtered(sampling))
    }
}

/// How far from a point there are texels that a filter takes, in texels.
fn reach(filter: TexelFilter) -> f64 {
    match filter {
        TexelFilter::Nearest => 0.0,
        TexelFilter::Bilinear => 0.5,
        TexelFilter::BSpline | TexelFilter::CatmullRom => 1.5,
    }
}

fn empty(level: &Level) -> Vec<TexelRange> {
    vec![TexelRange::NONE; level.width as usize * level.height as usize]
}

/// Widens the squares of a level by the ranges of those of another, finer one that reach into them.
fn gather(squares: &mut [TexelRange], to: &Level, ranges: impl Iterator<Item = TexelRange>, from: &Level) {
    let under = |at: usize, from: u32, to: u32| {
        let (from, to) = (from as usize, to as usize);
        at * to / from..((at + 1) * to).div_ceil(from)
    };
    let (width, columns) = (from.width as usize, to.width as usize);
    for (number, range) in ranges.enumerate() {
        for y in under(number / width, from.height, to.height) {
            for x in under(number % width, from.width, to.width) {
                squares[y * columns + x].with(&range);
            }
        }
    }
}

/// Texels along an axis that follow each other, which may lie beyond the image.
struct SpanOfTexels {
    wrap: Wrap,
    first: i64,
    count: i64,
    side: u32,
}

impl SpanOfTexels {
    fn new(wrap: Wrap, first: i64, last: i64, side: u32) -> Self {
        let (all, period) = match wrap {
            Wrap::Repeat => (0, i64::from(side)),
            Wrap::Mirror => (0, 2 * i64::from(side)),
            Wrap::Clamp => (first.clamp(0, i64::from(side) - 1), i64::MAX),
        };
        let span = |first: i64, count: i64| Self { wrap, first, count, side };
        if wrap == Wrap::Clamp {
            return span(all, last.clamp(0, i64::from(side) - 1) - all + 1);
        }
        let count = last - first + 1;
        if count >= period { span(all, side.into()) } else { span(first, count) }
    }

    fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        (self.first..self.first + self.count).map(|at| wrapped_index(self.wrap, at, self.side))
    }
}

fn each(level: &Level, [columns, rows]: [SpanOfTexels; 2], mut with: impl FnMut(usize)) {
    for y in rows.iter() {
        for x in columns.iter() {
            with(y * level.width as usize + x);
        }
    }
}

//! What an image has at least and at most over a part of it, whatever filter looks it up.

use crate::halves::Level;
use crate::lookup::wrapped_index;
use crate::pyramid::Pyramid;
use crate::sampling::{LevelFilter, Sampling, TexelFilter, Wrap};

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

/// Levels are looked at from the first on of which a part has so many squares along a side, or fewer.
const LOOKED_AT: i64 = 12;

/// What weights below 0 of Catmull and Rom's filter sum up to: up to 1/8 along an axis, of which the others sum up to 9/8.
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
    fn filtered(mut self, sampling: &Sampling) -> Self {
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

    /// Of the image that it was made of: what [`filtered`](crate::lookup::filtered) may give wherever u and v are from `low`
    /// to `high`, or a texel beside that of the level that is taken, whatever the footprint; a little more. `None` where texels are too large for sums of them.
    pub fn within(&self, pyramid: &Pyramid, sampling: &Sampling, low: [f32; 2], high: [f32; 2]) -> Option<TexelRange> {
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
        let levels = pyramid.levels();
        let is_little = |level: &Level| part(level).iter().all(|span| span.count <= LOOKED_AT);
        let from = levels[self.first..].iter().position(is_little).unwrap_or(levels.len() - 1 - self.first);
        let mut range = TexelRange::NONE;
        let squares = &self.levels[from];
        each(&levels[self.first + from], part(&levels[self.first + from]), |at| range.with(&squares[at]));
        if sampling.levels != LevelFilter::None {
            for (number, level) in levels.iter().enumerate().skip(self.first + from + 1) {
                let texels = pyramid.level(number);
                each(level, part(level), |at| range.with(&TexelRange::of(texels[at])));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lookup;
    use crate::texels::TexelImage;

    /// Numbers from 0 to 1 that follow from no other.
    struct Hashed(u64);

    impl Hashed {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f64 / (1_u64 << 24) as f64
        }
    }

    /// Dark to the left, bright to the right, with single texels that are neither.
    fn image(width: u32, height: u32, hashed: &mut Hashed) -> TexelImage {
        let texel = |at: u32| {
            let bright = if 2 * (at % width) < width { 0.05 } else { 0.9 };
            [0; 4].map(|_| if hashed.next() < 0.02 { hashed.next() as f32 } else { bright })
        };
        TexelImage::new(width, height, (0..width * height).map(texel).collect()).expect("an image")
    }

    fn samplings() -> Vec<Sampling> {
        let mut all = Vec::new();
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for filter in [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom] {
                for levels in [LevelFilter::None, LevelFilter::Nearest, LevelFilter::Linear, LevelFilter::Elliptical] {
                    all.push(Sampling { wrap: [wrap; 2], magnify: filter, minify: filter, levels });
                }
            }
        }
        all
    }

    /// How many lookups leave the range that is `made` of that of the part they lie in.
    fn outside(made: impl Fn(TexelRange) -> TexelRange) -> usize {
        let mut hashed = Hashed(7);
        let mut outside = 0;
        for size in [[1, 1], [5, 3], [64, 48], [131, 70], [256, 9]] {
            let pyramid = Pyramid::new(image(size[0], size[1], &mut hashed));
            for sampling in samplings() {
                for _ in 0..60 {
                    let low = [0; 2].map(|_| (hashed.next() * 4.0 - 2.0) as f32);
                    let high = low.map(|low| low + (hashed.next().powi(4) * 1.5) as f32);
                    let range = made(pyramid.ranges().within(&pyramid, &sampling, low, high).expect("small texels"));
                    for _ in 0..8 {
                        let uv = [0, 1].map(|k| f64::from(low[k]) + hashed.next() * f64::from(high[k] - low[k]));
                        let footprint = [0; 2].map(|_| [0; 2].map(|_| hashed.next().powi(6) * 0.7));
                        let found = lookup::filtered(&pyramid, &sampling, uv, footprint).map(|x| x as f32);
                        outside += (0..4).filter(|&k| !(range.least[k]..=range.most[k]).contains(&found[k])).count();
                    }
                }
            }
        }
        outside
    }

    #[test]
    fn no_lookup_leaves_the_range_of_where_it_is() {
        assert_eq!(outside(|range| range), 0);
        // Planted faults.
        assert!(outside(|range| TexelRange { most: range.most.map(|most| 0.5 * most), ..range }) > 1000);
        assert!(outside(|range| TexelRange { least: range.least.map(|least| least + 0.02), ..range }) > 1000);
    }

    #[test]
    fn what_is_far_does_not_widen_the_range() {
        let mut hashed = Hashed(3);
        let pyramid = Pyramid::new(image(512, 512, &mut hashed));
        let edge = TexelImage::from_fn(512, 512, |x, _| [if x < 448 { 0.1 } else { 0.9 }; 4]).expect("an image");
        let edge = Pyramid::new(edge);
        let of = |pyramid: &Pyramid, levels| {
            let sampling = Sampling { levels, ..Sampling::default() };
            pyramid.ranges().within(pyramid, &sampling, [0.36, 0.2], [0.39, 0.4]).expect("small texels").most[0]
        };
        assert!(of(&edge, LevelFilter::None) < 0.1001, "of the image itself");
        // On the level of four columns the last, a texel beside those that are taken, is half bright.
        assert!((of(&edge, LevelFilter::Linear) - 0.5).abs() < 1e-3);
        assert!(of(&pyramid, LevelFilter::None) <= 1.0 && pyramid.ranges().bytes() <= 44 * 1024);
        let large = Pyramid::new(TexelImage::from_fn(4, 4, |_, _| [3e38; 4]).expect("an image"));
        assert_eq!(large.ranges().within(&large, &Sampling::default(), [0.0; 2], [1.0; 2]), None);
    }
}

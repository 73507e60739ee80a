//! A drawn picture against the oracle's.
//!
//! Two drawers that are both right differ on the edges of objects, faces and spot cones: a rasteriser snaps vertices to
//! a grid (Vulkan lets it be as coarse as 1/16 pixel; 1/256 is usual), so that either side may win a pixel whose centre
//! lies beside an edge. Such pixels are told from wrong ones by asking the oracle what is to be seen close by, and are
//! counted apart.

use std::fmt;

use halfway_lighting::Encoding;

use super::comparison::{SizeMismatch, range, same_size};
use super::statistics::{Worst, percentile};
use super::table::Place;
use crate::oracle::Around;
use crate::{Image, Oracle};

/// Within this many pixels of an edge a pixel may belong to either side: eight times the 1/256 pixel to which
/// rasterisers usually snap vertices, since a snapped vertex also tilts long edges.
pub const EDGE_RADIUS: f64 = 1.0 / 32.0;
/// A step of this share of the range within the edge's width is an edge (of a spot's cone, say) and not a slope.
const STEP: f64 = 0.02;
/// The share of pixels that may lie on edges: with more, what is judged is hardly the picture.
const MOST_EDGES: f64 = 0.06;

/// What a picture has to keep to, off edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bars {
    /// What errors are counted in.
    pub measure: Measure,
    /// What 99.9 % of the channels' errors may reach.
    pub most: f64,
    /// What any error may reach.
    pub worst: f64,
    /// The share of pixels that have to show no error at all.
    pub equal: f64,
}

/// What errors are counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Shares of the brightest less the darkest expected channel, linear.
    Range,
    /// Steps of 1/255, both pictures clamped, encoded and rounded to bytes.
    Steps(Encoding),
}

impl Bars {
    /// For pictures in 32-bit floating point: 2·10⁻⁴ of the range for 99.9 %, 2·10⁻³ for all. Single precision over a
    /// few hundred operations, and attributes interpolated between vertices that were snapped.
    pub const FLOAT: Self = Self { measure: Measure::Range, most: 2e-4, worst: 2e-3, equal: 0.0 };

    /// For pictures of 8 bits: 1 step anywhere, and 99 % equal. A value near the middle between two steps may be
    /// rounded to either. Adapters may round values of the sRGB curve less exactly (llvmpipe to steps up to 0.66 away),
    /// where a smaller [`equal`](Self::equal) is due.
    pub const fn bytes(encoding: Encoding) -> Self {
        Self { measure: Measure::Steps(encoding), most: 1.0, worst: 1.0, equal: 0.99 }
    }
}

/// How a drawn picture did. Displayed it is one line.
///
/// Figures are over the pixels that are on no edge and show an object; background that is right is left out, as it would
/// flatter them. Where the expected picture does not know what it covers, all pixels count as showing one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// What it was judged by; errors are in its measure.
    pub bars: Bars,
    /// The least error that 99.9 % of the channels do not exceed.
    pub most: f64,
    /// The largest error.
    pub worst: f64,
    /// The place of the largest error and the values there: linear for [`Measure::Range`], bytes for
    /// [`Measure::Steps`].
    pub at: Option<Worst>,
    /// The share of pixels without any error.
    pub equal: f64,
    /// The share of the picture's pixels that lie on an edge and show something that is to be seen there.
    pub edges: f64,
    /// The share of the picture's pixels that count.
    pub counted: f64,
    /// Pixels of the drawn picture with a NaN, an infinity or a negative channel; they are in no other figure.
    pub bad: usize,
    /// Column and row of the first bad one, row by row, and its channels.
    pub first_bad: Option<((u32, u32), [f64; 3])>,
}

impl Verdict {
    /// Whether the picture keeps to its bars, has no bad pixel, and few enough on edges to be judged by the others.
    pub fn is_within(&self) -> bool {
        let Self { bars, most, worst, equal, .. } = *self;
        most <= bars.most && worst <= bars.worst && equal >= bars.equal && self.bad == 0 && !self.is_mostly_edges()
    }

    /// Whether more than 6 % of the pixels lie on edges.
    pub fn is_mostly_edges(&self) -> bool {
        self.edges > MOST_EDGES
    }
}

/// Judges `actual` by `expected`, which `oracle` has drawn.
///
/// Of a pixel whose error is over `bars.most` the oracle is asked what is to be seen within [`EDGE_RADIUS`] of its
/// centre. Several primitives, or a step of more than 2 % of the range, are an edge; there any value between the least
/// and the largest seen is right, and the pixel is counted apart. Any other error counts.
///
/// # Errors
/// [`SizeMismatch`].
pub fn judge(oracle: &Oracle, expected: &Image, actual: &Image, bars: Bars) -> Result<Verdict, SizeMismatch> {
    judge_with(|x, y| oracle.around(x, y, EDGE_RADIUS), expected, actual, bars)
}

fn judge_with(
    around: impl Fn(u32, u32) -> Around,
    expected: &Image,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    same_size(actual, expected)?;
    let ruler = Ruler::new(expected, bars);
    let mut tally = Tally::default();
    let width = expected.dimensions().0.max(1) as usize;
    for (i, (&should, &is)) in expected.pixels().iter().zip(actual.pixels()).enumerate() {
        let at = ((i % width) as u32, (i / width) as u32);
        if is.iter().any(|channel| !(channel.is_finite() && *channel >= 0.0)) {
            tally.bad += 1;
            tally.first_bad.get_or_insert((at, is));
            continue;
        }
        let errors: [f64; 3] = std::array::from_fn(|k| ruler.error(is[k], should[k]));
        // An error that is no number is over the bar too.
        let over = errors.iter().any(|error| error.is_nan() || *error > bars.most);
        if over && ruler.is_on_edge(is, &around(at.0, at.1)) {
            tally.edges += 1;
        } else if over || expected.covered().is_none_or(|covered| covered[i]) {
            tally.count(at, [is, should].map(|pixel| pixel.map(|channel| ruler.value(channel))), errors);
        }
    }
    Ok(tally.verdict(bars, expected.pixels().len()))
}

/// From intensities to the unit of the bars.
struct Ruler {
    bars: Bars,
    /// The expected range, linear or in steps.
    range: f64,
}

impl Ruler {
    fn new(expected: &Image, bars: Bars) -> Self {
        let brightest = expected.pixels().iter().flatten().copied().filter(|i| i.is_finite()).fold(0.0, f64::max);
        let range = match bars.measure {
            // A picture of one colour has no range of its own: its brightness, or 1 where it is black.
            Measure::Range => [range(expected), brightest, 1.0].into_iter().find(|range| *range > 1e-12).unwrap_or(1.0),
            Measure::Steps(_) => 255.0,
        };
        Self { bars, range }
    }

    /// An intensity as errors are shown: linear, or the nearest whole step.
    fn value(&self, intensity: f64) -> f64 {
        match self.bars.measure {
            Measure::Range => intensity,
            Measure::Steps(encoding) => (encoding.encode(intensity.clamp(0.0, 1.0)) * 255.0).round(),
        }
    }

    /// A difference of two values in the unit of the bars.
    fn in_unit(&self, difference: f64) -> f64 {
        match self.bars.measure {
            Measure::Range => difference / self.range,
            Measure::Steps(_) => difference,
        }
    }

    fn error(&self, actual: f64, expected: f64) -> f64 {
        self.in_unit((self.value(actual) - self.value(expected)).abs())
    }

    /// Whether the surroundings hold an edge, and the pixel a value that is to be seen there.
    fn is_on_edge(&self, actual: [f64; 3], around: &Around) -> bool {
        let [low, high] = [around.low, around.high].map(|pixel| pixel.map(|channel| self.value(channel)));
        let span = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let steep = span > STEP * self.range;
        // An edge may show what is brighter than the whole of the picture, rounded to its own brightness.
        let share = self.range / self.range.max(span);
        let outside = |k: usize| {
            let value = self.value(actual[k]);
            share * self.in_unit((low[k] - value).max(value - high[k]))
        };
        (around.edge || steep) && (0..3).all(|k| outside(k) <= self.bars.worst)
    }
}

/// Counts while the pixels go by.
#[derive(Default)]
struct Tally {
    errors: Vec<f64>,
    pixels: usize,
    equal: usize,
    edges: usize,
    bad: usize,
    first_bad: Option<((u32, u32), [f64; 3])>,
    worst: f64,
    at: Option<Worst>,
}

impl Tally {
    fn count(&mut self, at: (u32, u32), [actual, expected]: [[f64; 3]; 2], errors: [f64; 3]) {
        self.pixels += 1;
        self.equal += usize::from(errors.iter().all(|error| *error == 0.0));
        for (channel, error) in errors.into_iter().enumerate() {
            // NaN, which is the oracle's, is the worst.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            self.errors.push(error);
            if error > self.worst {
                self.worst = error;
                self.at = Some(Worst { at, channel, actual: actual[channel], expected: expected[channel] });
            }
        }
    }

    fn verdict(mut self, bars: Bars, of: usize) -> Verdict {
        self.errors.sort_unstable_by(f64::total_cmp);
        let share = |count: usize, of: usize, none: f64| if of == 0 { none } else { count as f64 / of as f64 };
        Verdict {
            bars,
            most: percentile(&self.errors, 99.9),
            worst: self.worst,
            at: self.at,
            equal: share(self.equal, self.pixels, 1.0),
            edges: share(self.edges, of, 0.0),
            counted: share(self.pixels, of, 0.0),
            bad: self.bad,
            first_bad: self.first_bad,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { most, worst, .. } = self;
        match self.bars.measure {
            Measure::Range => write!(f, "99.9 % within {most:.1e} of the range, all within {worst:.1e}")?,
            Measure::Steps(_) => {
                write!(f, "all within {worst} of 255 steps, {:.2} % of pixels equal", self.equal * 100.0)?;
            }
        }
        write!(f, "; {:.0} % of the picture counts, ", self.counted * 100.0)?;
        write!(f, "{:.2} % lies on edges", self.edges * 100.0)?;
        if self.is_mostly_edges() {
            write!(f, ", too much to judge by the rest (more than {} %)", MOST_EDGES * 100.0)?;
        }
        if let Some(worst) = self.at {
            write!(f, "; the worst is {}", Place(worst))?;
        }
        if let Some((at, pixel)) = self.first_bad {
            write!(f, "; {} pixels are not finite or negative, the first at {at:?}: {pixel:?}", self.bad)?;
        }
        Ok(())
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "whole steps and shares of few pixels are exact")]
mod tests;

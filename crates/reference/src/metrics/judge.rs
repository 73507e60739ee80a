//! Judges a rendered picture by the oracle.
//!
//! Two renderers that are both right differ on the edges of objects, faces and spot cones: a rasteriser snaps vertices
//! to a grid, so that either side may win a pixel whose centre lies beside an edge. For each pixel over the bar, the
//! oracle lists the colours that it may show, and the pixel is right if it shows one of them.

mod divisor;

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use halfway_lighting::{Encoding, Samples};
use image::DynamicImage;
use rayon::prelude::*;

use super::bands::SizeMismatch;
use super::comparison::{range, same_size};
use super::ranks::percentile;
use super::statistics::Worst;
use crate::oracle::{ColorRange, Possible};
use crate::{Image, Oracle};
use divisor::judge_divided;

/// Within this many pixels of an edge a pixel may belong to either side: vertices are snapped to a grid of this width
/// or a finer one (four bits, the least that Vulkan grants; eight are usual).
const EDGE_RADIUS: f64 = 1.0 / 16.0;
/// If a triangle's own colour changes by more than this fraction of the range within the disc of [`EDGE_RADIUS`], any
/// of the colours there is right; on a gentler slope only the one at the centre. A grid of 1/256 of a pixel changes
/// that by less than 1/16 of this fraction, which the bars cover.
const STEEP: f64 = 0.04;

/// The radius if corners are on the renderer's own grid: only single precision can still move an edge.
const RADIUS_ON_GRID: f64 = 1.0 / 64.0;

/// The tolerances of a picture.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::metrics::Bars;
///
/// // A picture of bytes that may be off by two more steps, as after an approximation.
/// let bars = Bars::bytes(Encoding::Srgb).within(2.0);
/// assert_eq!((bars.worst, bars.steps), (1.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bars {
    /// The unit of the errors.
    pub measure: Measure,
    /// The bar for 99.9 % of the channels' errors.
    pub most: f64,
    /// The bar for every error.
    pub worst: f64,
    /// The least fraction of pixels without any error.
    pub equal: f64,
    /// The addition to `worst` for each blended layer in front of a pixel.
    pub layer: f64,
    /// The error that an approximation was allowed, in steps of 1/255 of the picture: added to `most` and `worst`.
    pub steps: f64,
    /// Whether to stop once a pixel is over `worst`. [`is_within`](Verdict::is_within) is the same as without, much
    /// sooner if all is wrong; the other figures then cover only some pixels.
    pub until_wrong: bool,
}

/// The unit of errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Fractions of the brightest minus the darkest expected channel, linear.
    Range,
    /// Steps of 1/255, both pictures clamped, encoded and rounded to bytes.
    Steps(Encoding),
}

impl Bars {
    /// For pictures in 32-bit floating point: 2·10⁻⁴ of the range for 99.9 %, 2·10⁻³ for all. Single precision over a
    /// few hundred operations, and attributes interpolated between vertices that were snapped.
    pub const FLOAT: Self = Self {
        measure: Measure::Range,
        most: 2e-4,
        worst: 2e-3,
        equal: 0.0,
        layer: 0.0,
        steps: 0.0,
        until_wrong: false,
    };

    /// For pictures of 8 bits: 1 step anywhere, and 99 % equal. A value near the middle between two steps may be
    /// rounded to either. Adapters may round values of the sRGB curve less exactly (llvmpipe to steps up to 0.66 away),
    /// where a smaller [`equal`](Self::equal) is due.
    ///
    /// Half a step more for each blended layer: a picture of bytes is rounded whenever something is blended over it, to
    /// at most half a step away, and the layers above let no more of that through.
    pub const fn bytes(encoding: Encoding) -> Self {
        Self { measure: Measure::Steps(encoding), most: 1.0, worst: 1.0, equal: 0.99, layer: 0.5, ..Self::FLOAT }
    }

    /// For a decoded picture of any renderer: [`FLOAT`](Self::FLOAT) in floating point, else
    /// [`bytes`](Self::bytes) without a fraction that must be equal, as the exact curve is unknown. One of 16 bits was
    /// rounded once, whatever the layers.
    pub fn for_decoded(picture: &DynamicImage, encoding: Encoding) -> Self {
        match picture {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => Self::FLOAT,
            DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_) => Self { equal: 0.0, layer: 0.0, ..Self::bytes(encoding) },
            _ => Self { equal: 0.0, ..Self::bytes(encoding) },
        }
    }

    /// For a picture that may be off by N more steps; the fraction of equal pixels is then not checked.
    #[must_use]
    pub fn within(self, steps: f64) -> Self {
        if steps > 0.0 { Self { steps, equal: 0.0, ..self } } else { self }
    }

    /// Stops at the first wrong pixel; see [`until_wrong`](Self::until_wrong).
    #[must_use]
    pub const fn until_wrong(self) -> Self {
        Self { until_wrong: true, ..self }
    }

    /// Whether such pictures hold no intensity above 1, so that the oracle has to
    /// [clamp](Oracle::with_clamping) too.
    pub fn are_clamped(&self) -> bool {
        matches!(self.measure, Measure::Steps(_))
    }
}

/// The result of judging a picture. `Display` writes one line.
///
/// Figures are over the pixels that show an object, except those that show the other side of an edge or the roundings
/// of blended layers; right background is left out, as it would improve the figures. If the coverage of the expected
/// picture is unknown, all pixels count as showing an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The bars; errors are in their measure.
    pub bars: Bars,
    /// [`Bars::steps`] in that measure.
    pub allowed: f64,
    /// The least error that 99.9 % of the channels do not exceed.
    pub most: f64,
    /// The largest error.
    pub worst: f64,
    /// The place of the largest error and the values there: linear for [`Measure::Range`], bytes for
    /// [`Measure::Steps`].
    pub at: Option<Worst>,
    /// The fraction of pixels without any error.
    pub equal: f64,
    /// The fraction of the picture's pixels that rightly show the other side of an edge than the oracle does at their
    /// centres. Each has been judged: the figure excuses nothing.
    pub edges: f64,
    /// The fraction of the picture's pixels that are over the bar by no more than the roundings of the blended layers
    /// there explain.
    pub layered: f64,
    /// The fraction of the picture's pixels that count.
    pub counted: f64,
    /// Pixels of the actual picture with a NaN, an infinity or a negative channel; they are in no other figure.
    pub bad: usize,
    /// Column and row of the first bad one, row by row, and its channels.
    pub first_bad: Option<((u32, u32), [f64; 3])>,
}

impl Verdict {
    /// Whether the picture is within its bars and has no bad pixel.
    pub fn is_within(&self) -> bool {
        let Self { bars, allowed, most, worst, equal, .. } = *self;
        most <= bars.most + allowed && worst <= bars.worst + allowed && equal >= bars.equal && self.bad == 0
    }
}

/// Judges `actual` by `expected`, which `oracle` has drawn with one sample a pixel; `actual` has the camera's number of
/// samples.
///
/// For each pixel whose error is over `bars.most` the oracle lists the colours that it [may show](Oracle::possible)
/// with vertices moved by less than 1/16 of a pixel; with four samples a pixel, also for one beside which something
/// else is visible. On an edge (several triangles, or a jump in the colour of one) and on a slope of more than 4 % of
/// the range within that radius, each of these colours and that at the middle, give or take `bars.worst`, is right, and
/// the pixel is counted separately; the error of a wrong one is its distance from the nearest of them. Behind blended
/// layers, `bars.worst` is larger by `bars.layer` for each. No fraction of pixels is excused.
///
/// If the expected picture has been [divided](Image::divided), the brightest pixel may be one of those. The one number
/// that `actual` was divided by is estimated, and must be the largest channel of a picture that may be shown; the
/// expected picture is divided by that number instead.
///
/// # Errors
/// [`SizeMismatch`].
pub fn judge(oracle: &Oracle, expected: &Image, actual: &Image, bars: Bars) -> Result<Verdict, SizeMismatch> {
    judge_within(EDGE_RADIUS, oracle, expected, actual, bars)
}

/// [`judge`] for a renderer that rounds the corners of triangles to a grid of N bits within a pixel. Some renderers
/// interpolate between the rounded corners and others between the exact ones, so the picture is right if it is right as
/// a whole by either: by `oracle`, which has drawn `expected`, or by the oracle [on the grid](Oracle::on_grid) with
/// vertices moved by less than 1/64 of a pixel. Where a corner lies so near the middle between two grid points that
/// single precision may take it to either, the triangles on it may be moved by a step of the grid. So may edges of
/// triangles that reach beyond the picture: a renderer that clips them at its sides rounds the new corners.
///
/// # Errors
/// [`SizeMismatch`].
pub fn judge_on_grid(
    oracle: &Oracle,
    expected: &Image,
    bits: u32,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    let exact = judge(oracle, expected, actual, bars)?;
    if exact.is_within() {
        return Ok(exact);
    }
    let rounded = oracle.clone().on_grid(bits);
    let verdict = judge_within(RADIUS_ON_GRID, &rounded, &rounded.draw(), actual, bars.until_wrong())?;
    // If the picture is right, all pixels have been judged.
    Ok(if verdict.is_within() { Verdict { bars, ..verdict } } else { exact })
}

/// [`judge`] with another radius in place of [`EDGE_RADIUS`].
fn judge_within(
    radius: f64,
    oracle: &Oracle,
    expected: &Image,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    judge_divided(|x, y| oracle.possible(x, y, radius), oracle.samples(), expected, actual, bars)
}

fn judge_with(
    possible: impl Fn(u32, u32) -> Possible + Sync,
    samples: Samples,
    expected: &Image,
    actual: &Image,
    bars: Bars,
) -> Result<Verdict, SizeMismatch> {
    same_size(actual, expected)?;
    let ruler = Ruler::new(expected, bars);
    let width = expected.dimensions().0.max(1) as usize;
    let is_wrong = AtomicBool::new(false);
    let of_pixel = |i: usize| {
        let at = ((i % width) as u32, (i / width) as u32);
        let (should, is) = (expected.pixels()[i], actual.pixels()[i]);
        if is.iter().any(|channel| !(channel.is_finite() && *channel >= 0.0)) {
            return PixelFinding::Bad(at, is);
        }
        let errors: [f64; 3] = std::array::from_fn(|k| ruler.error(is[k], should[k]));
        // NaN errors are over the bar too.
        let is_over = errors.iter().any(|error| error.is_nan() || *error > bars.most + ruler.allowed);
        let counted = |should, errors| {
            PixelFinding::Counted(
                at,
                [is, should].map(|pixel: [f64; 3]| pixel.map(|channel| ruler.value(channel))),
                errors,
            )
        };
        // With four samples the centre proves nothing if something else is beside it.
        if is_over || (samples == Samples::Four && ruler.differs_beside(expected, at)) {
            if bars.until_wrong && is_wrong.load(Ordering::Relaxed) {
                return PixelFinding::Skipped;
            }
            let possible = possible(at.0, at.1);
            let has_choice = ruler.has_choice(&possible);
            let (nearest, errors) = if has_choice {
                let of_choice = ruler.nearest(is, &possible);
                // The colour of one sample at the middle itself is right, also where its surface is too small to be
                // found around it.
                let is_nearer = samples == Samples::One && largest(&errors) < largest(&of_choice.1);
                if is_nearer { (should, errors) } else { of_choice }
            } else {
                (should, errors)
            };
            let is_within = |bar: f64| errors.iter().all(|error| *error <= bar);
            if !is_within(bars.worst + ruler.allowed) {
                let is_layered = is_within(ruler.bar_through(&possible, samples));
                is_wrong.fetch_or(!is_layered, Ordering::Relaxed);
                return if is_layered { PixelFinding::Layered } else { counted(nearest, errors) };
            }
            if has_choice && is_over {
                return PixelFinding::Edge;
            }
        }
        if is_over || expected.covered().is_none_or(|covered| covered[i]) {
            counted(should, errors)
        } else {
            PixelFinding::Background
        }
    };
    let findings: Vec<PixelFinding> = (0..expected.pixels().len()).into_par_iter().map(of_pixel).collect();
    let mut tally = Tally::default();
    for finding in findings {
        tally.add(finding);
    }
    Ok(tally.verdict(bars, ruler.allowed, expected.pixels().len()))
}

/// The largest of the channels' errors.
fn largest(errors: &[f64; 3]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

/// The finding for a pixel.
enum PixelFinding {
    /// A channel is NaN, infinite or below 0.
    Bad((u32, u32), [f64; 3]),
    /// It is over the bar, and shows another side of an edge.
    Edge,
    /// It is over the bar by no more than the roundings of blended layers.
    Layered,
    /// It shows no object, and is right.
    Background,
    /// It is over the bar, and another pixel is already wrong.
    Skipped,
    /// Its position, its actual and expected colour, and the errors.
    Counted((u32, u32), [[f64; 3]; 2], [f64; 3]),
}

/// Converts intensities to the unit of the bars.
struct Ruler {
    bars: Bars,
    /// The expected range, linear or in steps.
    range: f64,
    /// The least expected value, in the same unit.
    darkest: f64,
    /// [`Bars::steps`] in the unit of the bars.
    allowed: f64,
}

impl Ruler {
    fn new(expected: &Image, bars: Bars) -> Self {
        let brightest = expected.pixels().iter().flatten().copied().filter(|i| i.is_finite()).fold(0.0, f64::max);
        let range = match bars.measure {
            // A picture of one colour has no range: its brightness, or 1 if it is black.
            Measure::Range => [range(expected), brightest, 1.0].into_iter().find(|range| *range > 1e-12).unwrap_or(1.0),
            Measure::Steps(_) => 255.0,
        };
        let darkest = match bars.measure {
            Measure::Range => (brightest - range).max(0.0),
            Measure::Steps(_) => 0.0,
        };
        let allowed = match bars.measure {
            Measure::Range => bars.steps / 255.0 / range,
            Measure::Steps(_) => bars.steps,
        };
        Self { bars, range, darkest, allowed }
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

    /// The bar for the worst pixel behind such layers. If four samples lie under layers, their mean is rounded once
    /// more.
    fn bar_through(&self, possible: &Possible, samples: Samples) -> f64 {
        let roundings = possible.layers + usize::from(samples == Samples::Four && possible.layers > 0);
        self.bars.worst + self.allowed + self.bars.layer * roundings as f64
    }

    /// Whether a pixel lies on an edge or a steep slope, where more than one colour is right.
    fn has_choice(&self, possible: &Possible) -> bool {
        let span = |range: &ColorRange, k: usize| self.value(range.high[k]) - self.value(range.low[k]);
        possible.is_edge || possible.ranges.iter().any(|range| (0..3).any(|k| span(range, k) > STEEP * self.range))
    }

    /// The possible colour nearest to the actual one, and the errors of the channels.
    fn nearest(&self, actual: [f64; 3], possible: &Possible) -> ([f64; 3], [f64; 3]) {
        let of_ranges = possible.ranges.iter().map(|range| {
            let inside = std::array::from_fn(|k| actual[k].max(range.low[k]).min(range.high[k]));
            (inside, self.errors_outside(actual, range))
        });
        let nearest = of_ranges.min_by(|a, b| largest(&a.1).total_cmp(&largest(&b.1)));
        nearest.unwrap_or((actual, [f64::INFINITY; 3]))
    }

    /// How far each channel lies outside a range.
    fn errors_outside(&self, actual: [f64; 3], range: &ColorRange) -> [f64; 3] {
        let [low, high] = [range.low, range.high].map(|color| color.map(|channel| self.value(channel)));
        // An edge may show something brighter than all of the picture, rounded to its own brightness.
        let brightest = high.into_iter().fold(0.0, f64::max) - self.darkest;
        let share = self.range / self.range.max(brightest);
        std::array::from_fn(|k| {
            let value = self.value(actual[k]);
            let outside = [low[k] - value, value - high[k]].map(|outside| share * self.in_unit(outside));
            // NaN is not a color.
            if outside.iter().any(|outside| outside.is_nan()) {
                f64::INFINITY
            } else {
                outside[0].max(outside[1]).max(0.0)
            }
        })
    }

    /// Whether a neighbouring pixel, corners included, shows something else.
    fn differs_beside(&self, expected: &Image, (x, y): (u32, u32)) -> bool {
        let (width, height) = expected.dimensions();
        let here = expected.pixel(x, y);
        let around = |at: u32, size: u32| at.saturating_sub(1)..(at + 2).min(size);
        around(y, height).flat_map(|y| around(x, width).map(move |x| (x, y))).any(|(x, y)| {
            let there = expected.pixel(x, y);
            (0..3).any(|k| self.error(here[k], there[k]) > self.bars.worst)
        })
    }
}

/// Accumulates the findings.
#[derive(Default)]
struct Tally {
    errors: Vec<f64>,
    pixels: usize,
    equal: usize,
    edges: usize,
    layered: usize,
    bad: usize,
    first_bad: Option<((u32, u32), [f64; 3])>,
    worst: f64,
    at: Option<Worst>,
}

impl Tally {
    fn add(&mut self, finding: PixelFinding) {
        match finding {
            PixelFinding::Bad(at, pixel) => {
                self.bad += 1;
                self.first_bad.get_or_insert((at, pixel));
            }
            PixelFinding::Edge => self.edges += 1,
            PixelFinding::Layered => self.layered += 1,
            PixelFinding::Background | PixelFinding::Skipped => {}
            PixelFinding::Counted(at, values, errors) => self.count(at, values, errors),
        }
    }

    fn count(&mut self, at: (u32, u32), [actual, expected]: [[f64; 3]; 2], errors: [f64; 3]) {
        self.pixels += 1;
        self.equal += usize::from(errors.iter().all(|error| *error == 0.0));
        for (channel, error) in errors.into_iter().enumerate() {
            // NaN, which comes from the oracle, is the worst.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            self.errors.push(error);
            if error > self.worst {
                self.worst = error;
                self.at = Some(Worst { at, channel, actual: actual[channel], expected: expected[channel] });
            }
        }
    }

    fn verdict(mut self, bars: Bars, allowed: f64, of: usize) -> Verdict {
        self.errors.sort_unstable_by(f64::total_cmp);
        let share = |count: usize, of: usize, none: f64| if of == 0 { none } else { count as f64 / of as f64 };
        Verdict {
            bars,
            allowed,
            most: percentile(&self.errors, 99.9),
            worst: self.worst,
            at: self.at,
            equal: share(self.equal, self.pixels, 1.0),
            edges: share(self.edges, of, 0.0),
            layered: share(self.layered, of, 0.0),
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
        write!(f, "{:.2} % shows another side of an edge", self.edges * 100.0)?;
        if self.layered > 0.0 {
            write!(f, ", {:.2} % the roundings of blended layers", self.layered * 100.0)?;
        }
        if let Some(worst) = self.at {
            write!(f, "; the worst is {worst}")?;
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

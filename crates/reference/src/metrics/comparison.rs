//! Two pictures, pixel by pixel.

use halfway_lighting::Encoding;
use image::RgbImage;
use rayon::prelude::*;

use super::bands::{Band, BandPairs, PictureRows, SizeMismatch};
use super::coverage::{Coverage, Kind, Pair, pairs};
use super::ranks::{PERCENTILES, nearest_rank, percentile, percentile_of_all};
use super::statistics::{ChannelSums, Errors, Worst};
use crate::Image;

/// The errors of an actual picture relative to an expected one.
///
/// [`linear`](Self::linear), [`steps`](Self::steps) and [`equal`](Self::equal) are over the counted pixels: those that
/// both pictures cover, or all where the coverage of either is unknown; never one that is not finite.
///
/// `Display` writes one line with the largest error and its pixel; [`table`](Self::table) shows every figure.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
/// use halfway_reference::metrics::compare;
///
/// let expected = Image::new(2, 1, vec![[0.5; 3], [0.25; 3]]);
/// let actual = Image::new(2, 1, vec![[0.5; 3], [0.27; 3]]);
/// let comparison = compare(&actual, &expected, Encoding::Srgb)?;
/// assert_eq!((comparison.anywhere.at, comparison.equal), ((1, 0), 0.5));
/// assert!(comparison.is_within(5) && !comparison.is_within(2));
/// # Ok::<(), halfway_reference::metrics::SizeMismatch>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Width and height of both, in pixels.
    pub size: (u32, u32),
    /// The encoding of the steps.
    pub encoding: Encoding,
    /// The number of counted pixels.
    pub counted: usize,
    /// The coverage of the pictures, if it is known for both.
    pub coverage: Option<Coverage>,
    /// Pixels with a NaN or an infinity in either picture, if there are any.
    pub not_finite: Option<NotFinite>,
    /// The brightest minus the darkest channel of the expected picture's finite pixels, linear.
    pub range: f64,
    /// Errors in linear intensity.
    pub linear: Errors,
    /// Errors in steps of 1/255: both pictures are clamped, encoded and rounded to bytes before.
    pub steps: Errors,
    /// The fraction of counted pixels that are equal in all three bytes; 1 where nothing is counted.
    pub equal: f64,
    /// The largest difference in steps at any finite pixel, whatever its coverage.
    pub anywhere: Difference,
}

/// A difference in bytes, and its pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// The largest channel's difference, in steps of 1/255.
    pub steps: u8,
    /// Column and row.
    pub at: (u32, u32),
}

/// Pixels with a NaN or an infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinite {
    /// Their number.
    pub count: usize,
    /// Column and row of the first, row by row.
    pub first: (u32, u32),
    /// The actual picture there.
    pub actual: [f64; 3],
    /// The expected picture there.
    pub expected: [f64; 3],
}

/// Compares `actual` with `expected`; `encoding` is that of 8-bit pictures. The pictures are read a band of rows at a
/// time.
///
/// # Errors
/// [`SizeMismatch`].
pub fn compare(
    actual: &dyn PictureRows,
    expected: &dyn PictureRows,
    encoding: Encoding,
) -> Result<Comparison, SizeMismatch> {
    let bands = BandPairs::new(actual, expected)?;
    let mut sums = PixelSums::new(encoding);
    bands.each().for_each(|band| sums.add_band(&band));
    Ok(sums.comparison(bands.size))
}

/// The sums of one pass over all pixels.
struct PixelSums {
    encoding: Encoding,
    counted: usize,
    equal: usize,
    coverage: Option<Coverage>,
    not_finite: Option<NotFinite>,
    brightest: f64,
    darkest: f64,
    linear: ChannelSums,
    steps: ChannelSums,
    /// The absolute linear errors, by channel.
    errors: [Vec<f64>; 3],
    /// The number of channels that are N steps off.
    by_step: [[u64; 256]; 3],
    anywhere: Difference,
}

impl PixelSums {
    fn new(encoding: Encoding) -> Self {
        Self {
            encoding,
            counted: 0,
            equal: 0,
            coverage: None,
            not_finite: None,
            brightest: f64::NEG_INFINITY,
            darkest: f64::INFINITY,
            linear: ChannelSums::default(),
            steps: ChannelSums::default(),
            errors: Default::default(),
            by_step: [[0; 256]; 3],
            anywhere: Difference::default(),
        }
    }

    fn add_band(&mut self, band: &Band) {
        let bytes = [&band.actual, &band.expected].map(|image| image.to_bytes(self.encoding));
        if band.actual.covered().is_some() && band.expected.covered().is_some() {
            self.coverage.get_or_insert_default();
        }
        for channel in band.expected.pixels().iter().flatten().filter(|channel| channel.is_finite()) {
            self.brightest = self.brightest.max(*channel);
            self.darkest = self.darkest.min(*channel);
        }
        for pair in pairs(band) {
            let Pair { at, actual, expected, kind } = pair;
            let steps = steps(&bytes, (at.0, at.1 - band.first));
            if let Some(coverage) = &mut self.coverage {
                coverage.count(kind, at);
            }
            if kind == Kind::NotFinite {
                let first = NotFinite { count: 0, first: at, actual, expected };
                self.not_finite.get_or_insert(first).count += 1;
                continue;
            }
            let largest = largest(steps);
            if largest > self.anywhere.steps {
                self.anywhere = Difference { steps: largest, at };
            }
            if kind != Kind::Counted {
                continue;
            }
            self.counted += 1;
            self.equal += usize::from(largest == 0);
            for channel in 0..3 {
                let here = |actual, expected| Worst { at, channel, actual, expected };
                let [own, other] = steps[channel];
                let linear = here(actual[channel], expected[channel]);
                self.linear.push(linear);
                self.errors[channel].push(linear.error());
                self.steps.push(here(f64::from(own), f64::from(other)));
                self.by_step[channel][usize::from(own.abs_diff(other))] += 1;
            }
        }
    }

    fn comparison(mut self, size: (u32, u32)) -> Comparison {
        self.errors.iter_mut().for_each(|errors| errors.par_sort_unstable_by(f64::total_cmp));
        let [red, green, blue] =
            self.errors.each_ref().map(|sorted| PERCENTILES.map(|share| percentile(sorted, share)));
        let all = PERCENTILES.map(|share| percentile_of_all(&self.errors, share));
        let linear = [red, green, blue, all];
        let [red, green, blue] = &self.by_step;
        let all = std::array::from_fn(|step| red[step] + green[step] + blue[step]);
        let by_step = [red, green, blue, &all].map(step_percentiles);
        Comparison {
            size,
            encoding: self.encoding,
            counted: self.counted,
            coverage: self.coverage,
            not_finite: self.not_finite,
            range: (self.brightest - self.darkest).max(0.0),
            linear: self.linear.errors(linear),
            steps: self.steps.errors(by_step),
            equal: if self.counted == 0 { 1.0 } else { self.equal as f64 / self.counted as f64 },
            anywhere: self.anywhere,
        }
    }
}

fn step_percentiles(counts: &[u64; 256]) -> [f64; 4] {
    let values = counts.iter().sum();
    PERCENTILES.map(|share| {
        let mut rank = nearest_rank(values, share);
        let found = counts.iter().position(|count| {
            let here = rank < *count;
            rank = rank.saturating_sub(*count);
            here
        });
        found.unwrap_or(0) as f64
    })
}

impl Comparison {
    /// A linear error relative to the expected picture's [`range`](Self::range); unchanged where that is 0.
    pub fn relative(&self, linear: f64) -> f64 {
        if self.range > 0.0 { linear / self.range } else { linear }
    }

    /// Whether no pixel of the whole picture, whatever its coverage, differs by more than `steps` of 1/255, and all are
    /// finite.
    pub fn is_within(&self, steps: u8) -> bool {
        self.anywhere.steps <= steps && self.not_finite.is_none()
    }
}

pub(super) fn same_size(actual: &Image, expected: &Image) -> Result<(), SizeMismatch> {
    let (actual, expected) = (actual.dimensions(), expected.dimensions());
    if actual == expected { Ok(()) } else { Err(SizeMismatch { actual, expected }) }
}

/// The brightest minus the darkest finite channel; 0 where there is none.
pub(super) fn range(image: &Image) -> f64 {
    let finite = || image.pixels().iter().flatten().copied().filter(|channel| channel.is_finite());
    finite().reduce(f64::max).zip(finite().reduce(f64::min)).map_or(0.0, |(high, low)| high - low)
}

/// The bytes of each channel at a pixel.
pub(super) fn steps([a, b]: &[RgbImage; 2], (x, y): (u32, u32)) -> [[u8; 2]; 3] {
    let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
    [0, 1, 2].map(|k| [a[k], b[k]])
}

/// The largest difference of a channel.
pub(super) fn largest(steps: [[u8; 2]; 3]) -> u8 {
    steps.into_iter().map(|[a, b]| a.abs_diff(b)).max().unwrap_or(0)
}

//! Two pictures, pixel by pixel.

use halfway_lighting::Encoding;
use image::RgbImage;
use thiserror::Error;

use super::coverage::{Coverage, Kind, Pair, coverage, pairs};
use super::statistics::Errors;
use crate::Image;

/// Two pictures that cannot be compared.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "the actual picture is {} × {} pixels and the expected one {} × {}; only pictures of one size can be compared",
    actual.0, actual.1, expected.0, expected.1
)]
pub struct SizeMismatch {
    /// Width and height of the actual picture.
    pub actual: (u32, u32),
    /// Width and height of the expected picture.
    pub expected: (u32, u32),
}

/// How far an actual picture is from an expected one.
///
/// The figures in [`linear`](Self::linear) and [`steps`](Self::steps) and [`equal`](Self::equal) are over the pixels that
/// count: those that both pictures cover, or all where either does not know what it covers; never one that is not finite.
///
/// Displayed it is one line that says where and how far off; [`table`](Self::table) shows every figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Width and height of both, in pixels.
    pub size: (u32, u32),
    /// What a step is a step of.
    pub encoding: Encoding,
    /// Pixels that count.
    pub counted: usize,
    /// What the pictures cover, where both know.
    pub coverage: Option<Coverage>,
    /// Pixels with a NaN or an infinity in either picture, if there are any.
    pub not_finite: Option<NotFinite>,
    /// The brightest less the darkest channel of the expected picture's finite pixels, linear.
    pub range: f64,
    /// Errors in linear intensity.
    pub linear: Errors,
    /// Errors in steps of 1/255: both pictures are clamped, encoded and rounded to bytes before.
    pub steps: Errors,
    /// The share of counted pixels that are equal in all three bytes; 1 where nothing is counted.
    pub equal: f64,
    /// The largest difference in steps at any finite pixel, whatever covers it.
    pub anywhere: Difference,
}

/// A difference in bytes, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// The largest channel's difference, in steps of 1/255.
    pub steps: u8,
    /// Column and row.
    pub at: (u32, u32),
}

/// Pixels that hold no number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinite {
    /// How many.
    pub count: usize,
    /// Column and row of the first, row by row.
    pub first: (u32, u32),
    /// The actual picture there.
    pub actual: [f64; 3],
    /// The expected picture there.
    pub expected: [f64; 3],
}

/// Measures how far `actual` is from `expected`; `encoding` says what the bytes of an 8-bit picture mean.
///
/// # Errors
/// [`SizeMismatch`].
pub fn compare(actual: &Image, expected: &Image, encoding: Encoding) -> Result<Comparison, SizeMismatch> {
    same_size(actual, expected)?;
    let bytes = [actual.to_bytes(encoding), expected.to_bytes(encoding)];
    let counted = || pairs(actual, expected).filter(|pair| pair.kind == Kind::Counted);
    let count = counted().count();
    let equal = counted().filter(|pair| step(&bytes, pair.at) == 0).count();
    Ok(Comparison {
        size: actual.dimensions(),
        encoding,
        counted: count,
        coverage: coverage(actual, expected),
        not_finite: not_finite(actual, expected),
        range: range(expected),
        linear: Errors::of(counted().map(|pair| (pair.at, [pair.actual, pair.expected]))),
        steps: Errors::of(counted().map(|pair| (pair.at, in_steps(&bytes, pair.at)))),
        equal: if count == 0 { 1.0 } else { equal as f64 / count as f64 },
        anywhere: anywhere(&bytes, pairs(actual, expected)),
    })
}

impl Comparison {
    /// A linear error as a share of the expected picture's [`range`](Self::range); as it is where that is 0.
    pub fn relative(&self, linear: f64) -> f64 {
        if self.range > 0.0 { linear / self.range } else { linear }
    }

    /// Whether no pixel of the whole picture, whatever covers it, differs by more than `steps` of 1/255, and all are
    /// finite.
    pub fn is_within(&self, steps: u8) -> bool {
        self.anywhere.steps <= steps && self.not_finite.is_none()
    }
}

pub(super) fn same_size(actual: &Image, expected: &Image) -> Result<(), SizeMismatch> {
    let (actual, expected) = (actual.dimensions(), expected.dimensions());
    if actual == expected { Ok(()) } else { Err(SizeMismatch { actual, expected }) }
}

/// The brightest less the darkest finite channel; 0 where there is none.
pub(super) fn range(image: &Image) -> f64 {
    let finite = || image.pixels().iter().flatten().copied().filter(|channel| channel.is_finite());
    finite().reduce(f64::max).zip(finite().reduce(f64::min)).map_or(0.0, |(high, low)| high - low)
}

/// The largest channel's difference at a pixel.
pub(super) fn step([a, b]: &[RgbImage; 2], (x, y): (u32, u32)) -> u8 {
    let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
    (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0)
}

fn in_steps(bytes: &[RgbImage; 2], (x, y): (u32, u32)) -> [[f64; 3]; 2] {
    bytes.each_ref().map(|image| image.get_pixel(x, y).0.map(f64::from))
}

fn anywhere(bytes: &[RgbImage; 2], pairs: impl Iterator<Item = Pair>) -> Difference {
    let mut largest = Difference::default();
    for pair in pairs.filter(|pair| pair.kind != Kind::NotFinite) {
        let steps = step(bytes, pair.at);
        if steps > largest.steps {
            largest = Difference { steps, at: pair.at };
        }
    }
    largest
}

fn not_finite(actual: &Image, expected: &Image) -> Option<NotFinite> {
    let mut bad = pairs(actual, expected).filter(|pair| pair.kind == Kind::NotFinite);
    let Pair { at: first, actual, expected, .. } = bad.next()?;
    Some(NotFinite { count: 1 + bad.count(), first, actual, expected })
}

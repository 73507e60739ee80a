//! Pairs of pictures, a band of rows at a time.

use std::ops::Range;

use thiserror::Error;

use crate::Image;

/// The error of comparing pictures of different sizes.
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

/// A picture that is read by ranges of rows: an [`Image`], or a file that would take too much memory as one.
///
/// ```
/// use std::ops::Range;
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
/// use halfway_reference::metrics::{PictureRows, compare};
///
/// /// A gradient that is never in memory as a whole.
/// struct Gradient;
///
/// impl PictureRows for Gradient {
///     fn dimensions(&self) -> (u32, u32) {
///         (1000, 5000)
///     }
///     fn rows(&self, rows: Range<u32>) -> Image {
///         let row = |y: u32| vec![[f64::from(y) / 5000.0; 3]; 1000];
///         Image::new(1000, rows.len() as u32, rows.flat_map(row).collect())
///     }
/// }
///
/// assert_eq!(compare(&Gradient, &Gradient, Encoding::Raw)?.equal, 1.0);
/// # Ok::<(), halfway_reference::metrics::SizeMismatch>(())
/// ```
pub trait PictureRows {
    /// Width and height in pixels.
    fn dimensions(&self) -> (u32, u32);
    /// The rows `rows.start` to `rows.end` − 1 as a picture. Coverage is known for all rows or for none.
    fn rows(&self, rows: Range<u32>) -> Image;
}

impl PictureRows for Image {
    fn dimensions(&self) -> (u32, u32) {
        self.dimensions()
    }

    fn rows(&self, rows: Range<u32>) -> Image {
        self.cut(rows)
    }
}

/// Two pictures of one size.
#[derive(Clone, Copy)]
pub(super) struct BandPairs<'a> {
    actual: &'a dyn PictureRows,
    expected: &'a dyn PictureRows,
    pub(super) size: (u32, u32),
}

/// A range of rows of both pictures.
pub(super) struct Band {
    /// The first row's number.
    pub(super) first: u32,
    pub(super) actual: Image,
    pub(super) expected: Image,
}

impl<'a> BandPairs<'a> {
    pub(super) fn new(actual: &'a dyn PictureRows, expected: &'a dyn PictureRows) -> Result<Self, SizeMismatch> {
        let (size, other) = (actual.dimensions(), expected.dimensions());
        if size == other {
            Ok(Self { actual, expected, size })
        } else {
            Err(SizeMismatch { actual: size, expected: other })
        }
    }

    /// The rows of bands of about N pixels, from the top.
    pub(super) fn ranges(&self, pixels: u32) -> impl Iterator<Item = Range<u32>> + use<> {
        let (width, height) = self.size;
        let rows = (pixels / width.max(1)).max(1);
        (0..height).step_by(rows as usize).map(move |first| first..height.min(first.saturating_add(rows)))
    }

    pub(super) fn band(&self, rows: Range<u32>) -> Band {
        Band { first: rows.start, actual: self.actual.rows(rows.clone()), expected: self.expected.rows(rows) }
    }

    /// All pixels, band by band from the top.
    pub(super) fn each(&self) -> impl Iterator<Item = Band> + '_ {
        /// 12 MB of three numbers each.
        const PIXELS: u32 = 1 << 19;
        self.ranges(PIXELS).map(|rows| self.band(rows))
    }
}

//! Two pictures, some rows at a time.

use std::ops::Range;

use super::comparison::SizeMismatch;
use crate::Image;

/// A picture whose rows can be had some at a time: an [`Image`], or what is read from a file and would take too much memory as
/// one.
pub trait Rows {
    /// Width and height in pixels.
    fn dimensions(&self) -> (u32, u32);
    /// The rows `rows.start` to `rows.end` − 1 as a picture of their own. What they cover is known of all rows or of none.
    fn rows(&self, rows: Range<u32>) -> Image;
}

impl Rows for Image {
    fn dimensions(&self) -> (u32, u32) {
        self.dimensions()
    }

    fn rows(&self, rows: Range<u32>) -> Image {
        self.cut(rows)
    }
}

/// Two pictures of one size.
#[derive(Clone, Copy)]
pub(super) struct Bands<'a> {
    actual: &'a dyn Rows,
    expected: &'a dyn Rows,
    pub(super) size: (u32, u32),
}

/// Some rows of both pictures.
pub(super) struct Band {
    /// The first row's number.
    pub(super) first: u32,
    pub(super) actual: Image,
    pub(super) expected: Image,
}

impl<'a> Bands<'a> {
    pub(super) fn of(actual: &'a dyn Rows, expected: &'a dyn Rows) -> Result<Self, SizeMismatch> {
        let (size, other) = (actual.dimensions(), expected.dimensions());
        if size == other {
            Ok(Self { actual, expected, size })
        } else {
            Err(SizeMismatch { actual: size, expected: other })
        }
    }

    /// The rows of bands of about so many pixels, from the top.
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

//! The range of numbers that a value may have.

use std::ops::Bound::{self, Excluded, Included, Unbounded};
use std::ops::RangeBounds;

/// The largest value that a colour channel may have: 10¹².
///
/// A reflectance (10¹²) times a light (10¹²) times the largest attenuation (10⁶, see
/// [`ATTENUATION_MAX`](crate::equations::ATTENUATION_MAX)) is 10³⁰, so that the sum over 10⁸ lights still fits in an
/// `f32`. Reflectances are normally at most 1.
pub const CHANNEL_MAX: f32 = 1e12;

/// The numbers that a field takes, all of them finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The lower end.
    pub least: Bound<f32>,
    /// The upper end.
    pub most: Bound<f32>,
    /// One more number, outside the range.
    pub also: Option<f32>,
    /// The range in words that follow "expected".
    pub expected: &'static str,
}

impl Range {
    /// Every finite number.
    pub const FINITE: Self = Self::new(Unbounded, Unbounded, "a finite number of at most 3.4e38");
    /// 0 or more.
    pub const NON_NEGATIVE: Self = Self::new(Included(0.0), Unbounded, "a finite number, 0 or more");
    /// Above 0.
    pub const POSITIVE: Self = Self::new(Excluded(0.0), Unbounded, "a finite number above 0");
    /// 0 to 1.
    pub const UNIT: Self = Self::new(Included(0.0), Included(1.0), "a number from 0 to 1");
    /// A channel of a color: 0 to [`CHANNEL_MAX`].
    pub const CHANNEL: Self = Self::new(Included(0.0), Included(CHANNEL_MAX), "a number from 0 to 1e12");

    /// The numbers between two bounds; `expected` says so in words.
    pub const fn new(least: Bound<f32>, most: Bound<f32>, expected: &'static str) -> Self {
        Self { least, most, also: None, expected }
    }

    /// Whether the number is in the range.
    pub fn contains(self, value: f32) -> bool {
        value.is_finite() && (self.least, self.most).contains(&value) || self.also == Some(value)
    }
}

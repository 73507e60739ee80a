//! Metrics on pictures small enough to be counted by hand.

#![expect(clippy::float_cmp, reason = "what is compared was put there, or is a whole number")]

mod comparison;
mod difference;
mod flip;
mod report;

use halfway_reference::Image;

/// A grey picture, row by row.
fn grey(width: u32, values: &[f64]) -> Image {
    Image::new(width, values.len() as u32 / width, values.iter().map(|value| [*value; 3]).collect())
}

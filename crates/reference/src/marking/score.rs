//! How far pictures differ, robustly.

use super::steps::Steps;

/// Steps that a right picture may be off by: roundings.
const ROUNDING: u8 = 1;
/// The most that a channel counts, in steps: a few pixels that are far off, as on smoothed edges, do not decide.
const MOST: u8 = 64;

/// The difference of two pixels: of each channel, the steps above one, at most 64; their sum.
pub(super) fn error(a: Steps, b: Steps) -> f64 {
    (0..3).map(|k| f64::from(a[k].abs_diff(b[k]).saturating_sub(ROUNDING).min(MOST))).sum()
}

/// The sum of the differences of two pictures.
pub(super) fn total(a: &[Steps], b: &[Steps]) -> f64 {
    a.iter().zip(b).map(|(a, b)| error(*a, *b)).sum()
}

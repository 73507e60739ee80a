//! A mean over the newest frames, whose memory is a time and not a number of frames.

use std::time::Duration;

/// The time over which an old frame's weight falls to 1/e, in seconds.
const MEMORY: f64 = 1.0;

/// The weight of a new frame, which begins `interval` after the one before, when `frames` came earlier. The first
/// one, which is slow, counts only until the second comes.
pub(super) fn weight(frames: u64, interval: Duration) -> f64 {
    if frames < 2 { 1.0 } else { 1.0 - (-interval.as_secs_f64() / MEMORY).exp() }
}

/// Between `old` and `new`, never outside.
pub(super) fn approach(old: f64, new: f64, weight: f64) -> f64 {
    old * (1.0 - weight) + new * weight
}

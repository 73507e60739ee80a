//! A mean over the newest frames, whose memory is a time and not a number of frames.

use std::time::Duration;

/// The time over which an old frame's weight falls to 1/e, in seconds.
const MEMORY: f64 = 1.0;

/// The weights of all frames so far: each begins with 1.
#[derive(Clone, Debug, Default)]
pub struct FrameWeights {
    sum: f64,
    frames: u64,
}

impl FrameWeights {
    /// The share of a new frame, which begins `interval` after the one before, in the mean. The first frame, which is
    /// slow, counts only until the second comes.
    pub fn share(&mut self, interval: Duration) -> f64 {
        let old = if self.frames < 2 { 0.0 } else { self.sum * (-interval.as_secs_f64() / MEMORY).exp() };
        self.sum = old + 1.0;
        self.frames += 1;
        1.0 / self.sum
    }
}

/// Between `old` and `new`, never outside.
pub fn approach(old: f64, new: f64, share: f64) -> f64 {
    old * (1.0 - share) + new * share
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn every_frame_weighs_alike_but_for_its_age() {
        for interval in [Duration::ZERO, MS / 10, MS, 16 * MS, 700 * MS, Duration::MAX] {
            let (mut weights, mut mean) = (FrameWeights::default(), 0.0);
            let values = [1e3, 50.0, 2.0, 7.0, 4.0, 4.0, 9.0];
            for value in values {
                mean = approach(mean, value, weights.share(interval));
            }
            let decay = (-interval.as_secs_f64()).exp();
            // Without the first.
            let ages = values[1..].iter().rev().zip(0..).map(|(value, age)| (value, decay.powi(age)));
            let (sum, total) = ages.fold((0.0, 0.0), |(sum, total), (value, w)| (sum + value * w, total + w));
            // Half a dozen roundings.
            assert!((mean - sum / total).abs() <= 1e-14 * mean, "{interval:?}: {mean}, not {}", sum / total);
        }
    }

    #[test]
    fn a_slow_second_frame_is_soon_outweighed() {
        let (mut weights, mut mean) = (FrameWeights::default(), 0.0);
        for frame in 0..102 {
            mean = approach(mean, if frame < 2 { 101.0 } else { 1.0 }, weights.share(MS));
        }
        // Of 101 frames within a tenth of the memory.
        assert!(mean > 1.0 && mean < 2.0, "{mean}");
    }
}

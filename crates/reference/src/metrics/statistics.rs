//! Statistics of many errors.

use std::fmt;

/// The channels' names, in their order.
pub(super) const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The errors of the three channels, in one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Red, green and blue, each over all counted pixels.
    pub channels: [Statistics; 3],
    /// Over all counted pixels and channels.
    pub all: Statistics,
}

/// Statistics of errors, actual minus expected. All are 0 where nothing is counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// The largest error to either side; the first of equal ones, row by row. `None` where nothing is counted.
    pub worst: Option<Worst>,
    /// Mean of the absolute errors.
    pub mean: f64,
    /// Mean of the errors with their signs: above 0 where the actual picture is too bright.
    pub bias: f64,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// The least absolute error that [`PERCENTILES`](super::PERCENTILES) per cent of the values do not exceed.
    pub percentiles: [f64; 4],
}

/// The place of the largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Column and row.
    pub at: (u32, u32),
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// The actual value.
    pub actual: f64,
    /// The expected value.
    pub expected: f64,
}

impl Worst {
    /// The absolute error.
    pub fn error(&self) -> f64 {
        (self.actual - self.expected).abs()
    }
}

/// The pixel and both values.
impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Worst { at, channel, actual, expected } = *self;
        // Bytes are whole.
        let digits = if actual.fract() == 0.0 && expected.fract() == 0.0 { 0 } else { 6 };
        write!(f, "{at:?} {}: {actual:.digits$} instead of {expected:.digits$}", CHANNELS[channel])
    }
}

impl Statistics {
    /// The largest absolute error.
    pub fn max(&self) -> f64 {
        self.worst.map_or(0.0, |worst| worst.error())
    }
}

/// Sums for all statistics but the percentiles.
#[derive(Clone, Copy, Debug, Default)]
struct ErrorSums {
    count: u64,
    sum: f64,
    absolute: f64,
    squares: f64,
    worst: Option<Worst>,
}

impl ErrorSums {
    /// Adds the values at a pixel.
    fn push(&mut self, here: Worst) {
        let error = here.actual - here.expected;
        self.count += 1;
        self.sum += error;
        self.absolute += error.abs();
        self.squares += error * error;
        if self.worst.is_none_or(|worst| error.abs() > worst.error()) {
            self.worst = Some(here);
        }
    }

    fn statistics(&self, percentiles: [f64; 4]) -> Statistics {
        let count = self.count.max(1) as f64;
        Statistics {
            worst: self.worst,
            mean: self.absolute / count,
            bias: self.sum / count,
            rmse: (self.squares / count).sqrt(),
            percentiles,
        }
    }
}

/// The sums of red, green and blue, and of all of them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ChannelSums([ErrorSums; 4]);

impl ChannelSums {
    /// Adds the values of one channel at a pixel.
    pub(super) fn push(&mut self, here: Worst) {
        self.0[here.channel].push(here);
        self.0[3].push(here);
    }

    /// The statistics, with the percentiles of each channel and of all.
    pub(super) fn errors(&self, percentiles: [[f64; 4]; 4]) -> Errors {
        let statistics = |k: usize| self.0[k].statistics(percentiles[k]);
        Errors { channels: [0, 1, 2].map(statistics), all: statistics(3) }
    }
}

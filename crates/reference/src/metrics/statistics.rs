//! Figures over many errors.

use std::cmp::Ordering;
use std::fmt;

/// The channels' names, in their order.
pub(super) const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The shares of [`Statistics::percentiles`], in per cent.
pub const PERCENTILES: [f64; 4] = [50.0, 95.0, 99.0, 99.9];

/// The errors of the three channels, in one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Red, green and blue, each over all counted pixels.
    pub channels: [Statistics; 3],
    /// Over all counted pixels and channels.
    pub all: Statistics,
}

/// Errors, actual less expected, in figures. All are 0 where nothing is counted.
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
    /// The least absolute error that [`PERCENTILES`] per cent of the values do not exceed.
    pub percentiles: [f64; 4],
}

/// The place of the largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Column and row.
    pub at: (u32, u32),
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// What is there.
    pub actual: f64,
    /// What should be there.
    pub expected: f64,
}

impl Worst {
    /// The absolute error.
    pub fn error(&self) -> f64 {
        (self.actual - self.expected).abs()
    }
}

/// The place and both values.
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

impl Errors {
    /// The figures of the pairs of finite values that `counted` yields, each with its place.
    pub(super) fn of(counted: impl Iterator<Item = ((u32, u32), [[f64; 3]; 2])>) -> Self {
        let mut channels = [const { Sample::new() }; 3];
        for (at, [actual, expected]) in counted {
            for (channel, sample) in channels.iter_mut().enumerate() {
                sample.push(Worst { at, channel, actual: actual[channel], expected: expected[channel] });
            }
        }
        let mut all = Sample::new();
        for sample in &channels {
            all.append(sample);
        }
        Self { channels: channels.map(Sample::finish), all: all.finish() }
    }
}

/// Errors with their signs, as they come in.
struct Sample {
    errors: Vec<f64>,
    worst: Option<Worst>,
}

impl Sample {
    const fn new() -> Self {
        Self { errors: Vec::new(), worst: None }
    }

    fn push(&mut self, here: Worst) {
        self.errors.push(here.actual - here.expected);
        if self.worst.is_none_or(|worst| here.error() > worst.error()) {
            self.worst = Some(here);
        }
    }

    fn append(&mut self, other: &Self) {
        self.errors.extend_from_slice(&other.errors);
        // Of equal errors the first, row by row.
        let before = |a: Worst, b: Worst| match b.error().total_cmp(&a.error()) {
            Ordering::Greater => true,
            Ordering::Equal => (b.at.1, b.at.0) < (a.at.1, a.at.0),
            Ordering::Less => false,
        };
        if let Some(here) = other.worst
            && self.worst.is_none_or(|worst| before(worst, here))
        {
            self.worst = Some(here);
        }
    }

    fn finish(mut self) -> Statistics {
        let count = self.errors.len().max(1) as f64;
        let bias = self.errors.iter().sum::<f64>() / count;
        let rmse = (self.errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
        self.errors.iter_mut().for_each(|error| *error = error.abs());
        let mean = self.errors.iter().sum::<f64>() / count;
        Statistics { worst: self.worst, mean, bias, rmse, percentiles: percentiles(&mut self.errors) }
    }
}

/// The nearest rank of each of [`PERCENTILES`]; 0 where there are no values. Sorts them.
pub(super) fn percentiles(values: &mut [f64]) -> [f64; 4] {
    values.sort_unstable_by(f64::total_cmp);
    PERCENTILES.map(|share| percentile(values, share))
}

/// The least of the sorted values that `share` per cent of them do not exceed; 0 where there are none.
pub(super) fn percentile(sorted: &[f64], share: f64) -> f64 {
    // The product may end a little above a whole number that it stands for.
    let rank = (sorted.len() as f64 * share / 100.0 - 1e-6).ceil().max(1.0);
    sorted.get(rank as usize - 1).copied().unwrap_or(0.0)
}

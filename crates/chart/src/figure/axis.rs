//! Axes: the positions of values, and the ticks.

/// A direction of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub label: String,
    /// The spacing of values.
    pub scale: AxisScale,
}

/// The spacing of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisScale {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long.
    Log,
}

/// A marked value.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Its position ([`Axis::position`]).
    pub position: f64,
    /// Its text.
    pub label: String,
}

/// The mantissas that may be marked in each power of ten, the fewest first.
const MANTISSAS: [&[f64]; 4] = [
    &[1.0],
    &[1.0, 2.0, 5.0],
    &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
    &[1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
];

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: AxisScale::Linear }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: AxisScale::Log }
    }

    /// Whether the axis can show the value: it is finite, and positive on a logarithmic scale.
    pub fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == AxisScale::Linear || value > 0.0)
    }

    /// The position of a value: itself, or its decimal logarithm.
    pub fn position(&self, value: f64) -> f64 {
        match self.scale {
            AxisScale::Linear => value,
            AxisScale::Log => value.log10(),
        }
    }

    /// The least range of positions that contains the values, with a margin of 5 % at each end; (0, 1) for none.
    pub(super) fn range(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        let (low, high) = values
            .map(|value| self.position(value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        if low > high {
            return (0.0, 1.0);
        }
        // A single value still gets a range around it.
        let room = ((high - low) * 0.05).max(high.abs() * 1e-3).max(1e-3);
        (low - room, high + room)
    }

    /// The values to mark between two positions: round numbers, at least three of them where the range allows it.
    pub fn ticks(&self, (low, high): (f64, f64)) -> Vec<Tick> {
        match self.scale {
            AxisScale::Linear => linear_ticks(low, high),
            AxisScale::Log => log_ticks(low, high),
        }
    }
}

fn linear_ticks(low: f64, high: f64) -> Vec<Tick> {
    let power = 10f64.powf(((high - low) / 5.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let step = steps.into_iter().find(|step| (high - low) / step <= 6.0).unwrap_or(steps[3]);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    (first..=last)
        .map(|i| {
            let position = i as f64 * step;
            Tick { position, label: format!("{position:.decimals$}") }
        })
        .collect()
}

fn log_ticks(low: f64, high: f64) -> Vec<Tick> {
    let decades = low.floor() as i32..=high.ceil() as i32;
    let ticks = |mantissas: &[f64]| -> Vec<Tick> {
        decades
            .clone()
            .flat_map(|exponent| mantissas.iter().map(move |mantissa| (*mantissa, exponent)))
            .map(|(mantissa, exponent)| Tick {
                position: mantissa.log10() + f64::from(exponent),
                label: power_of_ten(mantissa, exponent),
            })
            .filter(|tick| (low..=high).contains(&tick.position))
            .collect()
    };
    let choices = MANTISSAS.map(ticks);
    let [.., most] = &choices;
    choices.iter().find(|ticks| ticks.len() >= 3).unwrap_or(most).clone()
}

/// mantissa·10^exponent: plain from 0.001 to 10,000, else with an exponent.
fn power_of_ten(mantissa: f64, exponent: i32) -> String {
    if !(-3..=4).contains(&exponent) {
        return format!("{mantissa}e{exponent}");
    }
    // Rounded once, because 3·10⁻¹ is not 0.3 in binary.
    let decimals = usize::try_from(-exponent).unwrap_or(0) + usize::from(mantissa.fract() != 0.0);
    let text = format!("{:.decimals$}", mantissa * 10f64.powi(exponent));
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: AxisScale, low: f64, high: f64) -> Vec<String> {
        let axis = Axis { label: String::new(), scale };
        axis.ticks((axis.position(low), axis.position(high))).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn log_ticks_are_round_and_enough() {
        assert_eq!(labels(AxisScale::Log, 5e-6, 2.0), ["1e-5", "1e-4", "0.001", "0.01", "0.1", "1"]);
        assert_eq!(labels(AxisScale::Log, 0.015, 0.6), ["0.02", "0.05", "0.1", "0.2", "0.5"]);
        assert_eq!(labels(AxisScale::Log, 0.9, 3.2), ["1", "1.5", "2", "3"]);
        assert!(labels(AxisScale::Log, 0.97, 1.35).len() >= 3);
    }

    #[test]
    fn linear_ticks_are_round_and_enough() {
        assert_eq!(labels(AxisScale::Linear, 0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(AxisScale::Linear, -3.0, 122.0), ["0", "50", "100"]);
        assert_eq!(labels(AxisScale::Linear, 0.981, 1.013), ["0.99", "1.00", "1.01"]);
    }

    #[test]
    fn powers_of_ten_are_written_plainly() {
        for (mantissa, exponent, text) in [
            (1.0, 0, "1"),
            (1.5, 0, "1.5"),
            (2.0, -3, "0.002"),
            (1.5, -1, "0.15"),
            (1.0, 4, "10000"),
            (1.0, -12, "1e-12"),
            (2.0, -4, "2e-4"),
        ] {
            assert_eq!(power_of_ten(mantissa, exponent), text);
        }
    }

    #[test]
    fn only_representable_values_are_shown() {
        let (linear, log) = (Axis::linear(""), Axis::log(""));
        assert!(linear.shows(0.0) && linear.shows(-1.0) && !linear.shows(f64::NAN));
        assert!(log.shows(1e-300) && !log.shows(0.0) && !log.shows(-1.0) && !log.shows(f64::INFINITY));
    }

    #[test]
    fn ranges_are_never_empty() {
        let axis = Axis::linear("");
        assert_eq!(axis.range(std::iter::empty()), (0.0, 1.0));
        for value in [0.0, 1e9, -1e9] {
            let (low, high) = axis.range([value].into_iter());
            assert!(low < value && value < high);
        }
    }
}

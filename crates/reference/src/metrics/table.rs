//! Comparisons as text.

use std::fmt;

use super::comparison::Comparison;
use super::ranks::PERCENTILES;
use super::statistics::{CHANNELS, Errors, Statistics};

/// Every figure of a [`Comparison`], in several lines.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a>(&'a Comparison);

impl Comparison {
    /// Every figure, in several lines.
    pub fn table(&self) -> Table<'_> {
        Table(self)
    }

    fn counted_pixels(&self) -> &'static str {
        if self.coverage.is_some() { "that both cover" } else { "in all" }
    }
}

/// The largest error and its pixel, in one line.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (steps, linear) = (&self.steps.all, &self.linear.all);
        match linear.worst {
            None => write!(f, "no pixel to compare")?,
            Some(worst) if worst.error() == 0.0 => write!(f, "equal")?,
            Some(worst) => {
                write!(f, "up to {} steps of 1/255", steps.max())?;
                let relative = self.relative(worst.error());
                write!(f, " and {relative:.1e} of the range, at {worst}")?;
                write!(f, "; mean {:.3}, RMSE {:.3} steps", steps.mean, steps.rmse)?;
            }
        }
        write!(f, "; {:.2} % of {} pixels {}", self.equal * 100.0, self.counted, self.counted_pixels())?;
        write!(f, " equal in bytes")?;
        if let Some(coverage) = self.coverage
            && let Some(first) = coverage.first_difference
        {
            write!(f, "; coverage differs on {} pixels, first at {first:?}", coverage.different())?;
        }
        if let Some(bad) = self.not_finite {
            write!(f, "; {} pixels are not finite, first at {:?}: {:?}", bad.count, bad.first, bad.actual)?;
            write!(f, " instead of {:?}", bad.expected)?;
        }
        Ok(())
    }
}

impl fmt::Display for Table<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let it = self.0;
        writeln!(f, "size            {} × {} pixels", it.size.0, it.size.1)?;
        writeln!(f, "compared        {} pixels {}", it.counted, it.counted_pixels())?;
        match it.coverage {
            None => writeln!(f, "coverage        not known")?,
            Some(coverage) => {
                write!(f, "coverage        {} pixels are background in both; ", coverage.neither)?;
                let first = coverage.first_difference.map_or(String::new(), |at| format!(", first at {at:?}"));
                let (actual, expected) = (coverage.only_actual, coverage.only_expected);
                writeln!(f, "only the actual picture covers {actual}, only the expected {expected}{first}")?;
            }
        }
        match it.not_finite {
            None => writeln!(f, "not finite      none")?,
            Some(bad) => {
                write!(f, "not finite      {} pixels, first at {:?}: ", bad.count, bad.first)?;
                writeln!(f, "{:?} instead of {:?}", bad.actual, bad.expected)?;
            }
        }
        writeln!(f, "range           {:.6} linear, the brightest less the darkest expected", it.range)?;
        writeln!(f, "equal in bytes  {:.3} %", it.equal * 100.0)?;
        let anywhere = it.anywhere;
        writeln!(f, "anywhere        at most {} steps, at {:?}", anywhere.steps, anywhere.at)?;
        rows(f, "steps of 1/255", &it.steps, 1.0)?;
        rows(f, "linear", &it.linear, 1.0)?;
        if it.range > 0.0 {
            row(f, "of the range", &it.linear.all, 1.0 / it.range)?;
        }
        Ok(())
    }
}

fn rows(f: &mut fmt::Formatter<'_>, unit: &str, errors: &Errors, scale: f64) -> fmt::Result {
    write!(f, "\n{unit:<16}{:>9}{:>9}{:>10}{:>9}", "max", "mean", "bias", "RMSE")?;
    for share in PERCENTILES {
        write!(f, "{:>9}", format!("{share} %"))?;
    }
    writeln!(f, "  where the max is")?;
    for (name, statistics) in CHANNELS.iter().zip(&errors.channels) {
        row(f, name, statistics, scale)?;
    }
    row(f, "all", &errors.all, scale)
}

fn row(f: &mut fmt::Formatter<'_>, name: &str, statistics: &Statistics, scale: f64) -> fmt::Result {
    let Statistics { worst, mean, bias, rmse, percentiles } = statistics;
    let number = |value: f64| figure(value * scale);
    write!(
        f,
        "{name:<16}{:>9}{:>9}{:>10}{:>9}",
        number(statistics.max()),
        number(*mean),
        number(*bias),
        number(*rmse)
    )?;
    for value in percentiles {
        write!(f, "{:>9}", number(*value))?;
    }
    match worst {
        Some(worst) if worst.error() > 0.0 => writeln!(f, "  {worst}"),
        _ => writeln!(f),
    }
}

/// A number in at most nine characters: whole ones and 0 as they are, small ones with an exponent.
fn figure(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (size >= 1.0 && size.fract() == 0.0 && size < 1e6) => format!("{value:.0}"),
        size if (1e-2..1e4).contains(&size) => format!("{value:.3}"),
        _ => format!("{value:.1e}"),
    }
}

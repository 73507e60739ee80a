//! The checks that every value of a scene goes through, and the path to the one that fails.

use std::ops::RangeInclusive;

use halfway_lighting::Range;

/// A value that does not hold: its path inside the scene, and what was expected there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct KeyProblem {
    pub(crate) key: String,
    pub(crate) message: String,
}

/// The result of a check.
pub(crate) type Check = Result<(), KeyProblem>;

impl KeyProblem {
    pub(crate) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into() }
    }
}

/// Puts the path of the enclosing value in front of a problem's path, on the way out.
pub(crate) trait Within {
    /// The same result, with its path seen from the value that holds `parent`.
    fn within(self, parent: &str) -> Self;
    /// The same for element `index` of the list `parent`.
    fn within_item(self, parent: &str, index: usize) -> Self;
}

impl<T> Within for Result<T, KeyProblem> {
    fn within(self, parent: &str) -> Self {
        self.map_err(|KeyProblem { key, message }| {
            let joint = if key.is_empty() || key.starts_with('[') { "" } else { "." };
            KeyProblem { key: format!("{parent}{joint}{key}"), message }
        })
    }

    fn within_item(self, parent: &str, index: usize) -> Self {
        // The path is written only when there is a problem to report.
        if self.is_ok() { self } else { self.within(&format!("{parent}[{index}]")) }
    }
}

/// Every number is finite and, as 32 bits, not beyond the largest.
pub(crate) fn finite(key: &str, values: &[f32]) -> Check {
    each(key, values, Range::FINITE)
}

/// A color: every channel in its range.
pub(crate) fn color(key: &str, rgb: &[f32; 3]) -> Check {
    each(key, rgb, Range::CHANNEL)
}

/// A number in a range.
pub(crate) fn in_range(key: &str, value: f32, range: Range) -> Check {
    test(key, value, range.contains(value), range.expected)
}

/// A vector that has a direction: finite, not zero.
pub(crate) fn direction(key: &str, v: &[f32; 3]) -> Check {
    finite(key, v)?;
    if v.iter().all(|&c| c == 0.0) {
        return Err(KeyProblem::new(key, "is [0, 0, 0]; expected a direction, of any length above 0"));
    }
    Ok(())
}

/// A count within its limits.
pub(crate) fn count(key: &str, value: u32, limits: RangeInclusive<u32>) -> Check {
    if limits.contains(&value) {
        return Ok(());
    }
    let (least, most) = (limits.start(), limits.end());
    Err(KeyProblem::new(key, format!("is {value}; expected {least} to {most}")))
}

/// `value` if `holds`, else what was expected instead.
pub(crate) fn test(key: &str, value: f32, holds: bool, expected: &str) -> Check {
    if holds { Ok(()) } else { Err(KeyProblem::new(key, format!("is {value}; expected {expected}"))) }
}

fn each(key: &str, values: &[f32], range: Range) -> Check {
    let outside = values.iter().position(|&value| !range.contains(value));
    outside.map_or(Ok(()), |i| in_range("", values[i], range).within_item(key, i))
}

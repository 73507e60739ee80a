//! The checks that every value of a scene goes through, and the path to the one that fails.

use bevy_math::DVec4;
use halfway_lighting::Range;

/// A value that the format does not allow: its path inside the scene, and the expected values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct KeyProblem {
    pub(crate) key: String,
    pub(crate) message: String,
}

/// The result of a check.
pub(crate) type Check = Result<(), KeyProblem>;

/// The limits of a number, or of each number of a list.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Limits {
    /// Any finite number.
    Any,
    /// Numbers in a range.
    Numbers(Range),
    /// Whole numbers from the first to the second.
    Counts(u32, u32),
    /// One of a few whole numbers, with the message about others.
    OneOf(&'static [u32], &'static str),
}

impl Limits {
    /// The range of a floating-point number.
    pub(crate) fn range(&self) -> Range {
        match self {
            Self::Numbers(range) => *range,
            _ => Range::FINITE,
        }
    }
}

impl KeyProblem {
    pub(crate) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into() }
    }
}

/// Puts the path of the enclosing value in front of a problem's path, on the way out.
pub(crate) trait Within {
    /// The same result, with its path seen from the value that holds `parent`.
    fn within(self, parent: &str) -> Self;
    /// The same for an item of a list.
    fn within_item(self, index: usize) -> Self;
}

impl<T> Within for Result<T, KeyProblem> {
    fn within(self, parent: &str) -> Self {
        self.map_err(|KeyProblem { key, message }| {
            let joint = if key.is_empty() || key.starts_with('[') { "" } else { "." };
            KeyProblem { key: format!("{parent}{joint}{key}"), message }
        })
    }

    fn within_item(self, index: usize) -> Self {
        // The path is written only when there is a problem to report.
        if self.is_ok() { self } else { self.within(&format!("[{index}]")) }
    }
}

/// A number in a range.
pub(crate) fn in_range(key: &str, value: f32, range: Range) -> Check {
    test(key, value, range.contains(value), range.expected)
}

/// A vector that has a direction; its numbers are finite.
pub(crate) fn direction(key: &str, v: &[f32; 3]) -> Check {
    if v.iter().all(|&c| c == 0.0) {
        return Err(KeyProblem::new(key, "is [0, 0, 0]; expected a direction, of any length above 0"));
    }
    Ok(())
}

/// A rotation, whose length may differ from 1 as that of one printed with two digits does; else what is wrong.
pub(crate) fn unit_rotation(rotation: [f32; 4]) -> Result<(), String> {
    const SLACK: f64 = 0.02;
    let length = DVec4::from(rotation.map(f64::from)).length();
    if (length - 1.0).abs() <= SLACK {
        return Ok(());
    }
    Err(format!("has the length {length:.3}; expected a quaternion [x, y, z, w] of length 1"))
}

/// `value` if `holds`, else what was expected instead.
pub(crate) fn test(key: &str, value: f32, holds: bool, expected: &str) -> Check {
    if holds { Ok(()) } else { Err(KeyProblem::new(key, format!("is {value}; expected {expected}"))) }
}

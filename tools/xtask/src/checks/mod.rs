//! The project's rules that no other tool checks: one file a rule.

pub(crate) mod circles;
pub(crate) mod doors;
pub(crate) mod metadata;
mod source;

use crate::failure::{Failure, Result};

/// The result of a check: fails with the faults found, a line or more each.
fn none_of(faults: &[String]) -> Result {
    if faults.is_empty() { Ok(()) } else { Err(Failure::new(format!("\n    {}", faults.join("\n    ")))) }
}

//! The rules of this house that no other tool keeps: one file a rule.

pub(crate) mod circles;
pub(crate) mod doors;
pub(crate) mod metadata;
mod source;

use crate::failure::{Failure, Result};

/// What a check of this house ends with: the faults that it found, a line or more each.
fn none_of(faults: &[String]) -> Result {
    if faults.is_empty() { Ok(()) } else { Err(Failure::new(format!("\n    {}", faults.join("\n    ")))) }
}

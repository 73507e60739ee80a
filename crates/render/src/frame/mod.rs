//! A frame: its steps, what they did, and how long they took.

pub(crate) mod mean;
pub(crate) mod report;
pub(crate) mod sets;
pub(crate) mod times;
pub(crate) mod told;
pub(crate) mod why_empty;

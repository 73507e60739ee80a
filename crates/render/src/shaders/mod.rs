//! The WGSL texts, and what they read.

pub(crate) mod light_slots;
pub(crate) mod records;
pub(crate) mod text;

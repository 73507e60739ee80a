//! Vectors of lanes, as wide as the CPU has, and functions on them.

pub(crate) mod lanes;
pub(crate) mod lobe;
pub(crate) mod power;
pub(crate) mod width;

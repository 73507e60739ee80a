//! The WGSL texts, and what they read.

pub(crate) mod light_slots;
pub(crate) mod picture;
pub(crate) mod records;
#[cfg(test)]
mod tests;
pub(crate) mod text;

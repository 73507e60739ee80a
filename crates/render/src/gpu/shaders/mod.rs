//! The WGSL texts, and what they read.

pub(crate) mod picture;
pub(crate) mod records;
pub(crate) mod switches;
pub(crate) mod template;
#[cfg(test)]
mod tests;
pub(crate) mod text;

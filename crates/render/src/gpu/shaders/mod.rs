//! The WGSL texts, and the records that they read.

pub(crate) mod picture;
pub(crate) mod records;
pub(crate) mod switches;
pub(crate) mod template;
#[cfg(test)]
mod tests;
pub(crate) mod text;

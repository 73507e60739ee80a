//! Pipelines: their keys, how they are built, and which of them are there.

pub(crate) mod build;
pub(crate) mod cache;
pub(crate) mod compile;
pub(crate) mod key;

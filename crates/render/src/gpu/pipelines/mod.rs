//! Pipelines: their keys, their construction, and their cache.

pub(crate) mod build;
pub(crate) mod cache;
pub(crate) mod compile;
pub(crate) mod key;

//! The lights of a frame, and which of them each patch needs.

pub(crate) mod gather;
pub(crate) mod lists;

//! The lights of a frame, the terms that are shaded of them, and which of them each patch needs.

pub(crate) mod gather;
pub(crate) mod lists;
pub(crate) mod sent;
pub(crate) mod surroundings;
pub(crate) mod terms;

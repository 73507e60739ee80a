//! The lights of a frame, the terms that are shaded of them, and which of them each patch needs.

pub mod gather;
pub mod lists;
pub mod sent;
pub mod slots;
pub mod surroundings;
pub mod terms;

//! The lights of a frame, the terms that are shaded of them, and which of them each patch needs.

pub(crate) mod gains;
pub(crate) mod gather;
pub(crate) mod lists;
pub(crate) mod memory;
pub(crate) mod patch_lights;
pub(crate) mod places;
pub(crate) mod profit;
pub(crate) mod selector;
pub(crate) mod sent;
pub(crate) mod surroundings;
pub(crate) mod terms;

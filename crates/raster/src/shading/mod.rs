//! Covered pixels, shaded, blended and encoded.

pub(crate) mod blend;
pub(crate) mod encode;
pub(crate) mod shade;
pub(crate) mod surroundings;

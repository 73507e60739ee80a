//! The input: passes and meshes as plain data, checked before anything is drawn.

pub(crate) mod attributes;
pub(crate) mod check;
pub(crate) mod pass;
pub(crate) mod pieces;

//! What the camera sees: its matrices, and those of the visible objects.

pub(crate) mod camera;
pub(crate) mod matrices;

//! The view: its matrices, and those of the visible objects.

pub mod camera;
pub mod matrices;

//! The view: its matrices, and those of the visible objects.

pub mod camera;
pub mod looks;
pub mod matrices;
pub mod select;

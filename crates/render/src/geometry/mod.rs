//! Meshes as they are drawn: in patches, and in levels of detail.

pub(crate) mod allowed;
pub(crate) mod corners;
pub(crate) mod detail;
pub(crate) mod families;
pub(crate) mod meshes;
pub(crate) mod near_objects;
pub(crate) mod outlines;
pub(crate) mod patches;
pub(crate) mod seen;
pub(crate) mod shape;
pub(crate) mod turned;
pub(crate) mod uv_boxes;
pub(crate) mod workshop;

//! Where pictures go, and how they are read back.

pub(crate) mod canvas;
pub(crate) mod format;
pub(crate) mod frame;
pub(crate) mod picture;
pub(crate) mod policy;
pub(crate) mod surface;
pub(crate) mod texture;

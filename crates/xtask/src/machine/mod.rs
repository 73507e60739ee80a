//! What the machine has: libraries, a graphics driver, a display, a package manager.

pub(crate) mod display;
pub(crate) mod driver;
pub(crate) mod libraries;
pub(crate) mod packages;
pub(crate) mod programs;
pub(crate) mod screen;

//! Paints the panels: on the CPU into the pixels of a window, or with a graphics card over its picture.

pub(crate) mod cpu;
pub(crate) mod gpu;

use egui::ClippedPrimitive;
use egui::epaint::textures::TexturesDelta;

/// One frame of the panels, as triangles.
#[derive(Default)]
pub(crate) struct Painted {
    pub(crate) primitives: Vec<ClippedPrimitive>,
    /// Physical pixels a logical one.
    pub(crate) scale: f32,
    /// Images that are new or have changed since the last frame that was painted.
    pub(crate) textures: TexturesDelta,
}

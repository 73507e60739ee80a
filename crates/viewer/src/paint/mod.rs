//! Paints the panels: on the CPU into the pixels of a window, or with a graphics card over its picture.

pub(crate) mod cpu;
pub(crate) mod gpu;

use std::collections::HashMap;

use egui::epaint::textures::TexturesDelta;
use egui::epaint::{ImageData, ImageDelta};
use egui::{ClippedPrimitive, ColorImage, TextureId};

/// One frame of the panels, as triangles.
#[derive(Default)]
pub(crate) struct Painted {
    pub(crate) primitives: Vec<ClippedPrimitive>,
    /// Physical pixels a logical one.
    pub(crate) scale: f32,
    /// Images that are new or have changed since the last frame that was painted.
    pub(crate) textures: TexturesDelta,
}

/// The images of the panels, as they have become.
#[derive(Default)]
pub(crate) struct Images(HashMap<TextureId, ColorImage>);

impl Images {
    pub(crate) fn get(&self, id: TextureId) -> Option<&ColorImage> {
        self.0.get(&id)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = (TextureId, &ColorImage)> {
        self.0.iter().map(|(id, image)| (*id, image))
    }

    pub(crate) fn update(&mut self, textures: &TexturesDelta) {
        for (id, deltas) in &textures.set {
            deltas.iter().for_each(|delta| self.change(*id, delta));
        }
    }

    pub(crate) fn free(&mut self, textures: &TexturesDelta) {
        textures.free.iter().for_each(|id| drop(self.0.remove(id)));
    }

    fn change(&mut self, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(part) = &delta.image;
        let Some([left, top]) = delta.pos else {
            self.0.insert(id, ColorImage::clone(part));
            return;
        };
        let Some(image) = self.0.get_mut(&id) else { return };
        let [width, height] = part.size;
        if left + width > image.size[0] || top + height > image.size[1] {
            return;
        }
        for (row, texels) in part.pixels.chunks(width.max(1)).enumerate() {
            let first = (top + row) * image.size[0] + left;
            image.pixels[first..first + width].copy_from_slice(texels);
        }
    }
}

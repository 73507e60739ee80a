//! Text and areas on pictures.

use font8x8::legacy::BASIC_LEGACY;
use image::imageops::{FilterType, replace, resize};
use image::{Rgb, RgbImage};

/// Rows and columns of a glyph before it is enlarged.
const GLYPH: u32 = 8;
/// Pictures with both sides at most this long are enlarged in whole steps, so that pixels can be seen.
const SMALL: u32 = 320;

pub(super) const PAPER: Rgb<u8> = Rgb([24, 24, 27]);
pub(super) const INK: Rgb<u8> = Rgb([235, 235, 235]);

/// The scale of text on a picture of this width: each of a glyph's 8 × 8 dots becomes a square of N × N pixels.
pub fn text_scale(width: u32) -> u32 {
    if width < 2 * SMALL { 1 } else { 2 }
}

/// The height of a line of text of this scale, in pixels.
pub fn text_height(scale: u32) -> u32 {
    GLYPH * scale
}

pub(super) fn text_width(text: &str, scale: u32) -> u32 {
    GLYPH * scale * text.chars().count() as u32
}

/// Writes `text` with its upper left corner at (x, y); glyphs outside are clipped, non-ASCII characters become `?`.
pub fn write_text(image: &mut RgbImage, (x, y): (u32, u32), scale: u32, text: &str) {
    for (column, character) in (0..).zip(text.chars()) {
        let glyph = BASIC_LEGACY.get(character as usize).unwrap_or(&BASIC_LEGACY['?' as usize]);
        for (row, bits) in (0..).zip(glyph) {
            for dot in (0..GLYPH).filter(|dot| bits >> dot & 1 == 1) {
                fill(image, (x + (GLYPH * column + dot) * scale, y + row * scale), (scale, scale), INK);
            }
        }
    }
}

/// Fills the part of a rectangle inside the picture.
pub(super) fn fill(image: &mut RgbImage, (x, y): (u32, u32), (width, height): (u32, u32), color: Rgb<u8>) {
    for y in y..(y + height).min(image.height()) {
        for x in x..(x + width).min(image.width()) {
            image.put_pixel(x, y, color);
        }
    }
}

/// Small pictures with every pixel enlarged to a square of several.
pub(super) fn enlarged(image: &RgbImage) -> RgbImage {
    let (width, height) = image.dimensions();
    let factor = (SMALL / width.max(height).max(1)).max(1);
    resize(image, width * factor, height * factor, FilterType::Nearest)
}

/// Two pictures one below the other, aligned on the left.
pub(super) fn stacked(upper: &RgbImage, lower: &RgbImage) -> RgbImage {
    let width = upper.width().max(lower.width());
    let mut canvas = RgbImage::from_pixel(width, upper.height() + lower.height(), PAPER);
    replace(&mut canvas, upper, 0, 0);
    replace(&mut canvas, lower, 0, upper.height().into());
    canvas
}

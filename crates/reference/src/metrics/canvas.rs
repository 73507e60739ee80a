//! Text and areas on pictures.

use font8x8::legacy::BASIC_LEGACY;
use image::imageops::{FilterType, replace, resize};
use image::{Rgb, RgbImage};

/// Rows and columns of a glyph before it is enlarged.
const GLYPH: u32 = 8;
/// Pictures of which no side is longer are enlarged in whole steps, so that a pixel can be seen.
const SMALL: u32 = 320;

pub(super) const PAPER: Rgb<u8> = Rgb([24, 24, 27]);
pub(super) const INK: Rgb<u8> = Rgb([235, 235, 235]);

/// How large text is on a picture this wide: each of a glyph's 8 × 8 dots becomes a square of N × N pixels.
pub(super) fn text_scale(width: u32) -> u32 {
    if width < 2 * SMALL { 1 } else { 2 }
}

pub(super) fn text_height(scale: u32) -> u32 {
    GLYPH * scale
}

pub(super) fn text_width(text: &str, scale: u32) -> u32 {
    GLYPH * scale * text.chars().count() as u32
}

/// Writes `text` with its upper left corner at (x, y); what has no place is left out, what is not ASCII becomes a `?`.
pub(super) fn write(image: &mut RgbImage, (x, y): (u32, u32), scale: u32, text: &str) {
    for (column, character) in (0..).zip(text.chars()) {
        let glyph = BASIC_LEGACY.get(character as usize).unwrap_or(&BASIC_LEGACY['?' as usize]);
        for (row, bits) in (0..).zip(glyph) {
            for dot in (0..GLYPH).filter(|dot| bits >> dot & 1 == 1) {
                fill(image, (x + (GLYPH * column + dot) * scale, y + row * scale), (scale, scale), INK);
            }
        }
    }
}

/// Fills what lies inside the picture.
pub(super) fn fill(image: &mut RgbImage, (x, y): (u32, u32), (width, height): (u32, u32), color: Rgb<u8>) {
    for y in y..(y + height).min(image.height()) {
        for x in x..(x + width).min(image.width()) {
            image.put_pixel(x, y, color);
        }
    }
}

/// Small pictures with every pixel as a square of several.
pub(super) fn enlarged(image: &RgbImage) -> RgbImage {
    let (width, height) = image.dimensions();
    let factor = (SMALL / width.max(height).max(1)).max(1);
    resize(image, width * factor, height * factor, FilterType::Nearest)
}

/// Two pictures one below the other, the left edges in line.
pub(super) fn stacked(upper: &RgbImage, lower: &RgbImage) -> RgbImage {
    let width = upper.width().max(lower.width());
    let mut canvas = RgbImage::from_pixel(width, upper.height() + lower.height(), PAPER);
    replace(&mut canvas, upper, 0, 0);
    replace(&mut canvas, lower, 0, upper.height().into());
    canvas
}

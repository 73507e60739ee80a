//! A legend in pictures that show numbers by colours.

use crate::picture::Picture;
use font8x8::legacy::BASIC_LEGACY;
use halfway_lighting::{Encoding, Legend};

/// The least picture with a legend.
const LEAST: (u32, u32) = (160, 120);

/// Rows and columns of a glyph, each a square of `scale` pixels.
const GLYPH: u32 = 8;

const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];

/// Draws a legend into a picture of a camera's encoding. [`take_picture`](crate::take_picture) does so by itself; for
/// pictures of other renderers this is the way.
pub fn draw_legend(picture: &mut Picture, legend: &Legend, encoding: Encoding) {
    let (width, height) = picture.dimensions();
    if legend.colors.is_empty() || width < LEAST.0 || height < LEAST.1 {
        return;
    }
    let mut canvas = Canvas { picture, encoding, scale: if height < 480 { 1 } else { 2 } };
    let unit = GLYPH * canvas.scale;
    let labels: Vec<(f64, String)> = ticks(legend.range.map(f64::from));
    let widest = labels.iter().map(|(_, text)| text.len()).max().unwrap_or(0) as u32 * unit;
    let (bar_width, bar_height) = (2 * unit, height / 2);
    let (right, top) = (width.saturating_sub(widest + 2 * unit), (height - bar_height) / 2);
    let left = right.saturating_sub(bar_width + unit / 2);
    // A border of a pixel or two sets the bar off from any background.
    let border = canvas.scale;
    canvas.fill([left.saturating_sub(border), top - border], [bar_width + 2 * border, bar_height + 2 * border], BLACK);
    for row in 0..bar_height {
        let share = 1.0 - (f64::from(row) + 0.5) / f64::from(bar_height);
        let color = legend.colors[((share * legend.colors.len() as f64) as usize).min(legend.colors.len() - 1)];
        canvas.fill([left, top + row], [bar_width, 1], color);
    }
    let [low, high] = legend.range.map(f64::from);
    for (number, text) in &labels {
        let share = if high > low { (number - low) / (high - low) } else { 0.5 };
        let y = f64::from(top) + (1.0 - share) * f64::from(bar_height);
        let y = y.round() as u32;
        canvas.fill([left + bar_width, y.saturating_sub(border / 2)], [unit / 2, border], WHITE);
        canvas.write([left + bar_width + unit, y.saturating_sub(unit / 2)], text);
    }
    let title_width = legend.title.chars().count() as u32 * unit;
    let title_left = left.min(width.saturating_sub(title_width + unit));
    canvas.write([title_left, top.saturating_sub(2 * unit)], &legend.title);
}

/// Some three to six round numbers in a range, in the fewest digits that tell them apart.
fn ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let span = high - low;
    if !span.is_finite() || span <= 0.0 {
        return vec![(low, format!("{low}"))];
    }
    let rough = span / 5.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * power);
    let digits = (-step.log10().floor()).max(0.0) as usize;
    let first = (low / step).ceil() as i64;
    let numbers = (first..).map(|number| number as f64 * step).take_while(|number| *number <= high + 1e-9 * span);
    let is_plain = step >= 1e-4 && low.abs().max(high.abs()) < 1e6;
    // Without a minus before 0.
    let numbers = numbers.map(|number| if number == 0.0 { 0.0 } else { number });
    numbers.map(|n| (n, if is_plain { format!("{n:.digits$}") } else { format!("{n:.2e}") })).take(12).collect()
}

/// A picture that is drawn into.
struct Canvas<'a> {
    picture: &'a mut Picture,
    encoding: Encoding,
    /// Pixels a dot of a glyph.
    scale: u32,
}

impl Canvas<'_> {
    /// Fills the part of a rectangle that is in the picture.
    fn fill(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], color: [u8; 3]) {
        let (columns, rows) = self.picture.dimensions();
        let linear = color.map(|byte| Encoding::Srgb.decode(f64::from(byte) / 255.0));
        for y in y..(y + height).min(rows) {
            for x in x..(x + width).min(columns) {
                match self.picture {
                    Picture::Byte(image) => {
                        let [r, g, b] = linear.map(|i| (self.encoding.encode(i) * 255.0).round() as u8);
                        image.put_pixel(x, y, image::Rgba([r, g, b, 255]));
                    }
                    Picture::Float(image) => {
                        let [r, g, b] = linear.map(|i| i as f32);
                        image.put_pixel(x, y, image::Rgba([r, g, b, 1.0]));
                    }
                }
            }
        }
    }

    /// Writes text in white with a black shadow, its upper left corner at a pixel.
    fn write(&mut self, [x, y]: [u32; 2], text: &str) {
        for (offset, color) in [(self.scale, BLACK), (0, WHITE)] {
            for (column, character) in (0..).zip(text.chars()) {
                let glyph = BASIC_LEGACY.get(character as usize).unwrap_or(&BASIC_LEGACY['?' as usize]);
                for (row, bits) in (0..).zip(glyph) {
                    for dot in (0..GLYPH).filter(|dot| bits >> dot & 1 == 1) {
                        let at = [x + (GLYPH * column + dot) * self.scale + offset, y + row * self.scale + offset];
                        self.fill(at, [self.scale; 2], color);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbaImage;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let text = |range| ticks(range).into_iter().map(|(_, text)| text).collect::<Vec<_>>().join(" ");
        assert_eq!(text([0.0, 1.0]), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(text([-0.35, 0.35]), "-0.2 0.0 0.2");
        assert_eq!(text([3.0, 1003.0]), "200 400 600 800 1000");
        assert_eq!(text([0.0, 2e-9]), "0.00e0 5.00e-10 1.00e-9 1.50e-9 2.00e-9");
        assert_eq!(text([7.0, 7.0]), "7");
    }

    #[test]
    fn the_bar_has_its_colours_from_below_to_above() {
        let legend = Legend { title: "x".into(), range: [0.0, 1.0], colors: vec![[200, 0, 0], [0, 200, 0]] };
        let mut picture = Picture::Byte(RgbaImage::new(320, 240));
        draw_legend(&mut picture, &legend, Encoding::Srgb);
        let Picture::Byte(image) = picture else { panic!("bytes") };
        let column: Vec<u32> = (0..320).filter(|&x| image.get_pixel(x, 70).0 == [0, 200, 0, 255]).collect();
        assert_eq!(column.len(), 16);
        assert!(column.iter().all(|&x| image.get_pixel(x, 170).0 == [200, 0, 0, 255]));
        assert!(image.pixels().filter(|pixel| pixel.0 == [255; 4]).count() > 50, "words");
        // Without room there is none.
        let mut small = Picture::Byte(RgbaImage::new(159, 240));
        draw_legend(&mut small, &legend, Encoding::Srgb);
        assert_eq!(small, Picture::Byte(RgbaImage::new(159, 240)));
    }
}

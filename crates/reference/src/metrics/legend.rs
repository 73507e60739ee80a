//! The legend below a difference picture.

use image::{Rgb, RgbImage};

use super::canvas::{INK, PAPER, fill, text_height, text_scale, text_width, write_text};
use super::scale::{COVERAGE, LegendContent, NOT_FINITE, Unit, color, power_of_ten};

/// The least width, which fits the words.
const LEAST_WIDTH: u32 = 320;

/// The unit, a colour bar with ticks, and the colours beside the scale that occur.
pub(super) fn legend(width: u32, shown: LegendContent) -> RgbImage {
    let width = width.max(LEAST_WIDTH);
    let scale = text_scale(width);
    let (line, margin) = (text_height(scale), 8 * scale);
    let marks = [(shown.coverage, COVERAGE, "coverage differs"), (shown.not_finite, NOT_FINITE, "not finite")];
    let marks = marks.into_iter().filter(|(occurs, ..)| *occurs).map(|(_, color, words)| (color, words));
    let marks: Vec<(Rgb<u8>, &str)> = marks.collect();
    let bar_height = 12 * scale;
    let mut y = margin;
    let rows = if marks.is_empty() { 2 } else { 3 };
    let height = margin + rows * (line + margin / 2) + bar_height + 2 * margin;
    let mut strip = RgbImage::from_pixel(width, height, PAPER);
    let name = match shown.unit {
        Unit::Steps => "largest channel error, steps of 1/255",
        Unit::Linear => "largest channel error, linear",
    };
    write_text(&mut strip, (margin, y), scale, name);
    y += line + margin / 2;
    let length = width - 2 * margin;
    for x in 0..length {
        let share = f64::from(x) / f64::from(length - 1);
        fill(&mut strip, (margin + x, y), (1, bar_height), color(share));
    }
    y += bar_height;
    ticks(&mut strip, (margin, y), length, scale, shown);
    y += line + margin;
    let mut x = margin;
    for (color, words) in marks {
        fill(&mut strip, (x, y), (line, line), color);
        write_text(&mut strip, (x + line + margin / 2, y), scale, words);
        x += line + margin / 2 + text_width(words, scale) + 2 * margin;
    }
    strip
}

/// Ticks and numbers along the bar, whose lower left corner is at (x, y).
fn ticks(strip: &mut RgbImage, (left, y): (u32, u32), length: u32, scale: u32, shown: LegendContent) {
    let parts = parts(shown);
    for i in 0..=parts {
        let share = f64::from(i) / f64::from(parts);
        let x = left + (share * f64::from(length - 1)).round() as u32;
        fill(strip, (x, y), (1, 2 * scale), INK);
        // Errors beyond the end of the scale have the colour of its end.
        let more = if i == parts && shown.beyond { "+" } else { "" };
        let label = format!("{}{more}", number(shown.upper * share));
        let wide = text_width(&label, scale);
        // The numbers at the ends stay inside.
        let x = x.saturating_sub(wide / 2).clamp(left, left + length - wide.min(length));
        write_text(strip, (x, y + 3 * scale), scale, &label);
    }
}

/// The number of parts with round ends.
fn parts(shown: LegendContent) -> u32 {
    let leading = shown.upper / power_of_ten(shown.upper);
    match shown.unit {
        Unit::Steps if shown.upper <= 5.0 && shown.upper.fract() == 0.0 => shown.upper as u32,
        _ if (leading - 2.0).abs() < 1e-9 => 4,
        _ => 5,
    }
}

/// A number in few characters.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value) {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.0e}")
    }
}

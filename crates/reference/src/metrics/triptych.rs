//! Two pictures and their difference, side by side.

use halfway_lighting::Encoding;
use image::RgbImage;

use super::bands::SizeMismatch;
use super::canvas::{PAPER, below_one_another, beside_one_another, enlarged, text_height, text_scale, write};
use super::difference::difference;
use super::scale::Scale;
use crate::Image;

/// The actual picture, the expected one and their [`difference`], side by side under their names.
///
/// # Errors
/// [`SizeMismatch`].
pub fn triptych(actual: &Image, expected: &Image, encoding: Encoding, scale: Scale) -> Result<RgbImage, SizeMismatch> {
    let difference = difference(actual, expected, encoding, scale)?;
    let [actual, expected] = [actual, expected].map(|image| enlarged(&image.to_bytes(encoding)));
    let panels = [("actual", actual), ("expected", expected), ("difference", difference)];
    Ok(beside_one_another(&panels.map(|(name, picture)| under(name, picture)), 8))
}

fn under(name: &str, picture: RgbImage) -> RgbImage {
    let scale = text_scale(picture.width());
    let (margin, line) = (4 * scale, text_height(scale));
    let mut caption = RgbImage::from_pixel(picture.width(), line + 2 * margin, PAPER);
    write(&mut caption, (margin, margin), scale, name);
    below_one_another(&[caption, picture], 0)
}

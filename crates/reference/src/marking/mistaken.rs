//! Pictures with mistakes.

use halfway_lighting::Encoding;
use image::{Rgb, RgbImage};

use super::steps::{encoded, put};
use crate::Oracle;
use crate::mistakes::Mistakes;

/// The picture that somebody would draw who makes these mistakes, as bytes of this encoding.
pub fn mistaken_picture(oracle: &Oracle, mistakes: Mistakes, encoding: Encoding) -> RgbImage {
    let drawn = oracle.draw_mistaken(mistakes);
    let (width, height) = drawn.dimensions();
    let mut picture = RgbImage::new(width, height);
    for y in 0..height {
        for x in 0..width {
            let (to_x, to_y) = put((x, y), (width, height), mistakes);
            picture.put_pixel(to_x, to_y, Rgb(encoded(drawn.pixel(x, y), encoding, mistakes)));
        }
    }
    picture
}

//! Colours laid over a picture.

use crate::picture::Picture;
use halfway_lighting::Encoding;

/// Lays a colour over each pixel of a picture, in linear light: its share from 0 to 1, row by row from the top.
pub(super) fn lay_over(picture: &mut Picture, encoding: Encoding, inks: impl Iterator<Item = ([f32; 3], f32)>) {
    match picture {
        Picture::Float(image) => {
            for (pixel, (ink, share)) in image.pixels_mut().zip(inks).filter(|(_, (_, share))| *share > 0.0) {
                let [r, g, b, a] = pixel.0;
                let mixed = [0, 1, 2].map(|c| [r, g, b][c] + share * (ink[c] - [r, g, b][c]));
                pixel.0 = [mixed[0], mixed[1], mixed[2], a + share * (1.0 - a)];
            }
        }
        Picture::Byte(image) => {
            let decoded: [f64; 256] = std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0));
            for (pixel, (ink, share)) in image.pixels_mut().zip(inks).filter(|(_, (_, share))| *share > 0.0) {
                let share = f64::from(share);
                for (channel, ink) in pixel.0.iter_mut().zip(ink) {
                    let before = decoded[usize::from(*channel)];
                    let mixed = before + share * (f64::from(ink).min(1.0) - before);
                    *channel = (encoding.encode(mixed) * 255.0).round() as u8;
                }
                let alpha = f64::from(pixel.0[3]);
                pixel.0[3] = (alpha + share * (255.0 - alpha)).round() as u8;
            }
        }
    }
}

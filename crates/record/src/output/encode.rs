//! Conversion of intensities to the values of a file, and back.

use halfway_lighting::Encoding;
use halfway_render::Picture;
use image::{Rgb, Rgb32FImage, RgbImage, Rgba, RgbaImage};

/// min(I, 1); NaN and negative numbers become 0.
fn clamp(intensity: f32) -> f32 {
    if intensity.is_nan() { 0.0 } else { intensity.clamp(0.0, 1.0) }
}

/// An intensity as an integer of 0 to `most`: clamped to [0, 1], encoded, rounded to the nearest. NaN gives 0.
pub(super) fn quantise(intensity: f32, encoding: Encoding, most: u16) -> u16 {
    let clamped = f64::from(clamp(intensity));
    (encoding.encode(clamped) * f64::from(most)).round() as u16
}

/// The picture with 8 bits a channel, without its alpha: unchanged if it was drawn in bytes, else clamped and encoded
/// by `encoding`.
pub fn to_bytes(picture: &Picture, encoding: Encoding) -> RgbImage {
    let (width, height) = picture.dimensions();
    match picture {
        Picture::Byte(image) => RgbImage::from_fn(width, height, |x, y| {
            let [r, g, b, _] = image.get_pixel(x, y).0;
            Rgb([r, g, b])
        }),
        Picture::Float(image) => RgbImage::from_fn(width, height, |x, y| {
            let [r, g, b, _] = image.get_pixel(x, y).0;
            Rgb([r, g, b].map(|i| quantise(i, encoding, 255) as u8))
        }),
    }
}

/// The picture with 8 bits a channel, with its alpha.
pub(super) fn to_bytes_with_alpha(picture: &Picture, encoding: Encoding) -> RgbaImage {
    match picture {
        Picture::Byte(image) => image.clone(),
        Picture::Float(image) => {
            let (width, height) = image.dimensions();
            RgbaImage::from_fn(width, height, |x, y| {
                let [r, g, b, alpha] = image.get_pixel(x, y).0;
                let [r, g, b] = [r, g, b].map(|i| quantise(i, encoding, 255) as u8);
                Rgba([r, g, b, quantise(alpha, Encoding::Raw, 255) as u8])
            })
        }
    }
}

/// The intensities of a picture, clamped to [0, 1].
pub(super) fn to_linear(picture: &Picture, encoding: Encoding) -> Rgb32FImage {
    let (width, height) = picture.dimensions();
    match picture {
        Picture::Byte(image) => {
            let table: [f32; 256] = std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0) as f32);
            Rgb32FImage::from_fn(width, height, |x, y| {
                let [r, g, b, _] = image.get_pixel(x, y).0;
                Rgb([r, g, b].map(|byte| table[usize::from(byte)]))
            })
        }
        Picture::Float(image) => Rgb32FImage::from_fn(width, height, |x, y| {
            let [r, g, b, _] = image.get_pixel(x, y).0;
            Rgb([r, g, b].map(clamp))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba32FImage;

    #[test]
    fn quantised_values() {
        use Encoding::{Raw, Srgb};
        for (intensity, encoding, most, expected) in [
            (0.0, Srgb, 255, 0),
            (1.0, Srgb, 255, 255),
            (1.0, Srgb, 65535, 65535),
            // 0.5 linear is 0.735357 encoded (the constants of the standard, by hand).
            (0.5, Srgb, 255, 188),
            (0.5, Srgb, 65535, 48192),
            (0.5, Raw, 255, 128),
            (0.5, Raw, 65535, 32768),
            // On the straight part: 12.92 · 0.001 · 65535 = 846.7.
            (0.001, Srgb, 65535, 847),
            (7.0, Srgb, 255, 255),
            (-1.0, Raw, 255, 0),
            (f32::INFINITY, Srgb, 255, 255),
            (f32::NEG_INFINITY, Srgb, 255, 0),
            (f32::NAN, Srgb, 255, 0),
            (f32::NAN, Raw, 65535, 0),
        ] {
            assert_eq!(quantise(intensity, encoding, most), expected, "{intensity} {encoding:?} {most}");
        }
    }

    #[test]
    fn bytes_survive_decoding_and_encoding() {
        let all = RgbaImage::from_fn(256, 1, |x, _| Rgba([x as u8, 255 - x as u8, 7, 255]));
        for encoding in [Encoding::Srgb, Encoding::Raw] {
            let linear = to_linear(&Picture::Byte(all.clone()), encoding);
            let float = Rgba32FImage::from_fn(256, 1, |x, y| {
                let [r, g, b] = linear.get_pixel(x, y).0;
                Rgba([r, g, b, 1.0])
            });
            let back = to_bytes(&Picture::Float(float), encoding);
            assert_eq!(back, to_bytes(&Picture::Byte(all.clone()), encoding), "{encoding:?}");
        }
    }
}

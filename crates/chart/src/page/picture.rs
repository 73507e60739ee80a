//! Pictures embedded in the page.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageEncoder as _, ImageError, RgbImage};

/// The exact picture, as a PNG in a `data:` address.
///
/// # Errors
/// The encoder's error, which does not occur in memory.
pub fn exact_data_uri(picture: &RgbImage) -> Result<String, ImageError> {
    let mut png = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(picture.as_raw(), picture.width(), picture.height(), image::ExtendedColorType::Rgb8)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(png)))
}

/// The picture as a JPEG in a `data:` address: a tenth of a PNG's size, for pages with hundreds of pictures for
/// display only.
///
/// # Errors
/// The encoder's error, which does not occur in memory.
pub fn data_uri(picture: &RgbImage) -> Result<String, ImageError> {
    const QUALITY: u8 = 85;
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, QUALITY).encode_image(picture)?;
    Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_picture_comes_back() {
        let picture = RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8, y as u8, 200]));
        let uri = exact_data_uri(&picture).unwrap();
        let png = STANDARD.decode(uri.strip_prefix("data:image/png;base64,").unwrap()).unwrap();
        assert_eq!(image::load_from_memory(&png).unwrap().to_rgb8(), picture);
    }

    #[test]
    fn the_picture_comes_nearly_back() {
        let picture = RgbImage::from_fn(32, 16, |x, y| image::Rgb([4 * x as u8, 8 * y as u8, 200]));
        let uri = data_uri(&picture).unwrap();
        let jpeg = STANDARD.decode(uri.strip_prefix("data:image/jpeg;base64,").unwrap()).unwrap();
        let back = image::load_from_memory(&jpeg).unwrap().to_rgb8();
        // Chroma of such gentle slopes is accurate to a few steps at this quality.
        assert!(back.iter().zip(picture.iter()).all(|(a, b)| a.abs_diff(*b) < 16));
    }
}

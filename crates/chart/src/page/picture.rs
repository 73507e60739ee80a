//! Pictures inside the page.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::{ImageError, RgbImage};

/// The picture as a JPEG in a `data:` address: a tenth of a PNG's size, for pages with hundreds of pictures that are looked at
/// and not measured.
///
/// # Errors
/// What the encoder has to say; it has no reason to fail in memory.
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
    fn the_picture_comes_nearly_back() {
        let picture = RgbImage::from_fn(32, 16, |x, y| image::Rgb([4 * x as u8, 8 * y as u8, 200]));
        let uri = data_uri(&picture).unwrap();
        let jpeg = STANDARD.decode(uri.strip_prefix("data:image/jpeg;base64,").unwrap()).unwrap();
        let back = image::load_from_memory(&jpeg).unwrap().to_rgb8();
        // Chroma of slopes as gentle as these keeps to a few steps at this quality.
        assert!(back.iter().zip(picture.iter()).all(|(a, b)| a.abs_diff(*b) < 16));
    }
}

//! Pictures on disk, as intensities.

use std::path::Path;

use halfway::prelude::*;
use halfway::scene::SceneFile;
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};

use crate::failure::Failure;

/// Reads a PNG or an EXR as it is; of an animation it is the first frame.
pub(crate) fn decoded(file: &Path) -> Result<DynamicImage, Failure> {
    let unreadable = |error: &dyn std::fmt::Display| {
        Failure::from(format!("{}: cannot be read as a picture: {error}; expected a PNG or EXR", file.display()))
    };
    let mut reader = ImageReader::open(file).and_then(ImageReader::with_guessed_format).map_err(|e| unreadable(&e))?;
    let mut limits = limits();
    reader.limits(limits.clone());
    let mut decoder = reader.into_decoder().map_err(|error| unreadable(&error))?;
    let bytes = decoder.total_bytes();
    limits.reserve(bytes).and_then(|()| decoder.set_limits(limits)).map_err(|error| unreadable(&error))?;
    // The decoder takes its memory at once, and a program that is refused it ends.
    Vec::<u8>::new().try_reserve_exact(bytes as usize).map_err(|error| unreadable(&error))?;
    DynamicImage::from_decoder(decoder).map_err(|error| unreadable(&error))
}

/// The largest pictures that are drawn, in the format that takes most: four channels of 32 bits.
fn limits() -> Limits {
    const MOST: u32 = SceneFile::MAX_SIDE;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST), Some(MOST));
    limits.max_alloc = Some(16 * u64::from(MOST) * u64::from(MOST));
    limits
}

/// Writes a picture that people look at.
pub(crate) fn write(file: &Path, picture: image::RgbImage) -> Result<(), Failure> {
    use halfway::output::{PictureFormat, write_picture};
    let format = PictureFormat::of(file, Some(8))?;
    let picture = Picture::Byte(DynamicImage::from(picture).into_rgba8());
    Ok(write_picture(&picture, file, format, Encoding::Srgb)?)
}

//! Pictures on disk, as intensities.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use halfway::prelude::*;
use halfway::scene::SceneFile;
use halfway::texture::decode_stored;
use image::{DynamicImage, Limits};

use crate::failure::Failure;

/// Reads a PNG or an EXR without conversion; of an animation, its first frame.
pub(crate) fn decoded(file: &Path) -> Result<DynamicImage, Failure> {
    let name = file.display().to_string();
    let unread = |error| format!("{name}: cannot be read: {error}");
    // Checked before it is opened: opening a pipe waits for its other end.
    if !std::fs::metadata(file).map_err(unread)?.is_file() {
        return Err(format!("{name}: not a regular file; expected a PNG or EXR").into());
    }
    let opened = File::open(file).map_err(unread)?;
    let picture = decode_stored(BufReader::new(opened), &name, limits());
    picture.map_err(|error| format!("{error}; expected a PNG or EXR").into())
}

/// The limits of the largest pictures that can be drawn, in the largest format: four channels of 32 bits.
fn limits() -> Limits {
    const MOST: u32 = SceneFile::MAX_SIDE;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST), Some(MOST));
    limits.max_alloc = Some(16 * u64::from(MOST) * u64::from(MOST));
    limits
}

/// Writes a picture for display.
pub(crate) fn write(file: &Path, picture: image::RgbImage) -> Result<(), Failure> {
    use halfway::output::{PictureFormat, write_picture};
    let format = PictureFormat::from_path(file, Some(8))?;
    let picture = Picture::Byte(DynamicImage::from(picture).into_rgba8());
    Ok(write_picture(&picture, file, format, Encoding::Srgb)?)
}

//! The formats of pictures, told by a file's ending.

use std::path::Path;

use halfway_render::Pixels;

use super::OutputError;

/// A format of still pictures.
///
/// ```
/// use std::path::Path;
/// use halfway_record::output::PictureFormat;
///
/// assert_eq!(PictureFormat::from_path(Path::new("teapot.PNG"), None)?, PictureFormat::Png8);
/// assert_eq!(PictureFormat::from_path(Path::new("teapot.png"), Some(16))?, PictureFormat::Png16);
/// assert_eq!(PictureFormat::from_path(Path::new("teapot.jpg"), None)?, PictureFormat::Jpeg);
/// assert!(PictureFormat::from_path(Path::new("teapot.bmp"), None).is_err());
/// # Ok::<(), halfway_record::output::OutputError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PictureFormat {
    /// PNG, 8 bits a channel: clamped, and encoded as the camera says.
    Png8,
    /// PNG, 16 bits a channel: clamped, and encoded as the camera says.
    Png16,
    /// JPEG of quality 90: clamped, and encoded as the camera says. Its colours are not exact.
    Jpeg,
    /// WebP without loss, 8 bits a channel: clamped, and encoded as the camera says.
    WebP,
    /// `OpenEXR`, 32-bit floating point: linear, and not clamped.
    Exr,
}

impl PictureFormat {
    /// The endings of the formats, in words.
    pub const ENDINGS: &str = ".png, .jpg, .jpeg, .webp or .exr";

    /// The format of a file by its ending, in upper or lower case: `.png` (8 bits unless `bits` says 16), `.jpg` or
    /// `.jpeg`, `.webp` (8 bits) or `.exr` (32 bits).
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`], and [`OutputError::Bits`] where the format has no such number of bits.
    pub fn from_path(file: &Path, bits: Option<u32>) -> Result<Self, OutputError> {
        Self::from_ending(&ending(file), file, bits)
    }

    /// The format of this ending, in lower case and without its dot; `file` is what errors call it.
    pub(crate) fn from_ending(ending: &str, file: &Path, bits: Option<u32>) -> Result<Self, OutputError> {
        let refuse = |bits, expected| Err(OutputError::Bits { file: file.to_owned(), bits, expected });
        match (ending, bits) {
            ("png", None | Some(8)) => Ok(Self::Png8),
            ("png", Some(16)) => Ok(Self::Png16),
            ("png", Some(bits)) => refuse(bits, "8 or 16 in a PNG"),
            ("jpg" | "jpeg", None | Some(8)) => Ok(Self::Jpeg),
            ("jpg" | "jpeg", Some(bits)) => refuse(bits, "8 in a JPEG"),
            ("webp", None | Some(8)) => Ok(Self::WebP),
            ("webp", Some(bits)) => refuse(bits, "8 in a WebP"),
            ("exr", None | Some(32)) => Ok(Self::Exr),
            ("exr", Some(bits)) => refuse(bits, "32 in an EXR, or the bits left out"),
            _ => Err(OutputError::UnknownEnding { file: file.to_owned(), known: Self::ENDINGS }),
        }
    }

    /// The pixels of a headless picture that this format holds without loss.
    pub fn pixels(self) -> Pixels {
        match self {
            Self::Png8 | Self::Jpeg | Self::WebP => Pixels::Byte,
            Self::Png16 | Self::Exr => Pixels::Float,
        }
    }
}

/// The ending of a file's name in lower case, without the dot; empty where there is none.
pub(super) fn ending(file: &Path) -> String {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

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
/// assert!(PictureFormat::from_path(Path::new("teapot.jpg"), None).is_err());
/// # Ok::<(), halfway_record::output::OutputError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PictureFormat {
    /// PNG, 8 bits a channel: clamped, and encoded as the camera says.
    Png8,
    /// PNG, 16 bits a channel: clamped, and encoded as the camera says.
    Png16,
    /// `OpenEXR`, 32-bit floating point: linear, and not clamped.
    Exr,
}

impl PictureFormat {
    /// The format of a file by its ending, in upper or lower case: `.png` (8 bits unless `bits` says 16) or `.exr` (32
    /// bits).
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`], and [`OutputError::Bits`] where the format has no such number of bits.
    pub fn from_path(file: &Path, bits: Option<u32>) -> Result<Self, OutputError> {
        let refuse = |bits, expected| Err(OutputError::Bits { file: file.to_owned(), bits, expected });
        match (ending(file).as_str(), bits) {
            ("png", None | Some(8)) => Ok(Self::Png8),
            ("png", Some(16)) => Ok(Self::Png16),
            ("png", Some(bits)) => refuse(bits, "8 or 16 in a PNG"),
            ("exr", None | Some(32)) => Ok(Self::Exr),
            ("exr", Some(bits)) => refuse(bits, "32 in an EXR, or the bits left out"),
            _ => Err(OutputError::UnknownEnding { file: file.to_owned(), known: ".png or .exr" }),
        }
    }

    /// The pixels of a headless picture that this format holds without loss.
    pub fn pixels(self) -> Pixels {
        match self {
            Self::Png8 => Pixels::Byte,
            Self::Png16 | Self::Exr => Pixels::Float,
        }
    }
}

/// The ending of a file's name in lower case, without the dot; empty where there is none.
pub(super) fn ending(file: &Path) -> String {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

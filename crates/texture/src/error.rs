//! Errors of images.

use thiserror::Error;

use crate::limits::{LONGEST_SIDE, MOST_DECODED, MOST_TEXELS};

/// Why an image was refused. `image` in the messages is the name that the caller gave, such as a path.
///
/// ```
/// use halfway_texture::{TexelImage, TextureError};
///
/// let error = TexelImage::from_fn(2, 2, |x, _| [x as f32, f32::NAN, 0.0, 1.0]).unwrap_err();
/// assert!(matches!(error, TextureError::NotFinite { x: 0, y: 0, .. }));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The file could not be read.
    #[error("{image}: cannot be read: {reason}")]
    Read {
        /// The file.
        image: String,
        /// The system's message.
        reason: String,
    },
    /// The path leads to a folder, a pipe or a device.
    #[error("{image}: not a regular file")]
    NotAFile {
        /// The path.
        image: String,
    },
    /// The file is longer than the limit.
    #[error("{image}: is longer than {limit} bytes, the most that is read of an image")]
    TooLong {
        /// The file.
        image: String,
        /// The limit in bytes.
        limit: u64,
    },
    /// The bytes are not an image, or a broken one.
    #[error("{image}: is no image that can be read: {reason}")]
    Decode {
        /// The file.
        image: String,
        /// The decoder's message.
        reason: String,
    },
    /// The image has no texels.
    #[error("{image}: is {width} × {height} texels; at least 1 × 1 is expected")]
    Empty {
        /// The file.
        image: String,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The image is larger than the limits.
    #[error(
        "{image}: is {width} × {height} texels; at most {} along a side and {} in all are expected",
        LONGEST_SIDE,
        MOST_TEXELS
    )]
    TooLarge {
        /// The file.
        image: String,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The image in a file is too large to be decoded.
    #[error(
        "{image}: is {width} × {height} texels, {bytes} bytes when decoded; at most {} bytes are expected",
        MOST_DECODED
    )]
    TooLargeDecoded {
        /// The file.
        image: String,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// The bytes of its values.
        bytes: u64,
    },
    /// The allocation failed.
    #[error("{image}: {bytes} bytes of memory are refused")]
    Memory {
        /// The file.
        image: String,
        /// The bytes asked for.
        bytes: u64,
    },
    /// A texel holds NaN or an infinite number.
    #[error("{image}: texel ({x}, {y}) holds {value}; finite numbers are expected")]
    NotFinite {
        /// The file.
        image: String,
        /// The texel's column.
        x: u32,
        /// The texel's row.
        y: u32,
        /// The value found.
        value: f32,
    },
    /// The images do not make up an environment.
    #[error("images of {found} texels for an environment; {expected} expected")]
    Environment {
        /// The images expected for its shape, in words.
        expected: &'static str,
        /// The sizes of the images.
        found: String,
    },
    /// The number of texels does not fit the size.
    #[error("{found} texels for an image of {width} × {height}")]
    Count {
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// How many texels were given.
        found: usize,
    },
}

impl TextureError {
    /// The error with the name of an image, in variants that name a texel; its rows are counted from `first`.
    pub(crate) fn named(self, name: &str, first: u32) -> Self {
        match self {
            Self::NotFinite { x, y, value, .. } => Self::NotFinite { image: name.into(), x, y: first + y, value },
            other => other,
        }
    }
}

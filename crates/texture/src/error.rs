//! Why an image was refused.

use thiserror::Error;

use crate::limits::{LONGEST_SIDE, MOST_TEXELS};

/// Why an image was refused. `image` in the messages is the name that the caller gave, such as a path.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The file could not be read.
    #[error("{image}: cannot be read: {reason}")]
    Read {
        /// The file.
        image: String,
        /// What the system says.
        reason: String,
    },
    /// The path leads to a folder, a pipe or a device.
    #[error("{image}: not a regular file")]
    NotAFile {
        /// The path.
        image: String,
    },
    /// The file holds more bytes than are read.
    #[error("{image}: is longer than {limit} bytes, the most that is read of an image")]
    TooLong {
        /// The file.
        image: String,
        /// How many bytes are read.
        limit: u64,
    },
    /// The bytes are no image, or a broken one.
    #[error("{image}: is no image that can be read: {reason}")]
    Decode {
        /// The file.
        image: String,
        /// What the decoder says.
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
    /// The image has more texels than are taken.
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
    /// The system refuses the memory.
    #[error("{image}: {bytes} bytes of memory are refused")]
    Memory {
        /// The file.
        image: String,
        /// How many were asked for.
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
        /// What was found.
        value: f32,
    },
    /// Images that do not make up an environment.
    #[error("images of {found} texels for an environment; {expected} expected")]
    Environment {
        /// What is expected of its shape, in words.
        expected: &'static str,
        /// The sizes of the images.
        found: String,
    },
    /// Not one texel for each place.
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
    /// The same of an image that has a name, where it says which texel is wrong.
    pub(crate) fn named(self, name: &str) -> Self {
        match self {
            Self::NotFinite { x, y, value, .. } => Self::NotFinite { image: name.into(), x, y, value },
            other => other,
        }
    }
}

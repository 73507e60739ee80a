//! Errors of writing pictures.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a picture could not be written. No partial file is left.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The file's ending names no format that is written.
    #[error("{}: unknown ending; expected a file that ends in {known}", file.display())]
    UnknownEnding {
        /// The file.
        file: PathBuf,
        /// The known endings, in words.
        known: &'static str,
    },
    /// The format does not support this number of bits.
    #[error("{}: {bits} bits a channel were asked for; expected {expected}", file.display())]
    Bits {
        /// The file.
        file: PathBuf,
        /// The number of bits.
        bits: u32,
        /// The bits that the format supports, in words.
        expected: &'static str,
    },
    /// A picture of 8 bits a channel in a format of more.
    #[error(
        "{}: the picture was drawn with 8 bits a channel, which this format would only pretend to refine; \
         draw it in floating point (`Headless {{ pixels: Pixels::Float, .. }}`)",
        file.display()
    )]
    TooCoarse {
        /// The file.
        file: PathBuf,
    },
    /// A quantity that a PNG cannot hold.
    #[error("{}: a PNG cannot hold a {quantity} exactly; expected .exr", file.display())]
    NotForPng {
        /// The file.
        file: PathBuf,
        /// The quantity.
        quantity: &'static str,
    },
    /// A number that 16 bits do not hold.
    #[error("{}: the {quantity} {number} is more than 65535, which is the most that a PNG holds; expected .exr", file.display())]
    NumberTooLarge {
        /// The file.
        file: PathBuf,
        /// The quantity.
        quantity: &'static str,
        /// The number.
        number: u32,
    },
    /// Two quantities in one file that cannot hold both.
    #[error("{}: a PNG holds one quantity; expected a file for each, or one .exr for all", file.display())]
    Twice {
        /// The file.
        file: PathBuf,
    },
    /// A picture that is not opaque in a format that has no opacity.
    #[error("{}: the background is not opaque, and {format} has no opacity; expected {expected}", file.display())]
    NotOpaque {
        /// The file.
        file: PathBuf,
        /// The format, in words.
        format: &'static str,
        /// The formats that have opacity, in words.
        expected: &'static str,
    },
    /// The picture has no pixels.
    #[error("{}: the picture is {width} × {height} pixels; expected at least 1 × 1", file.display())]
    Empty {
        /// The file.
        file: PathBuf,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
    },
    /// A frame of an animation differs in size from the first.
    #[error(
        "{}: frame {frame} is {found_width} × {found_height} pixels; expected {width} × {height} as announced",
        file.display()
    )]
    FrameSize {
        /// The file.
        file: PathBuf,
        /// The frame, counted from 0.
        frame: u32,
        /// The frame's width in pixels.
        found_width: u32,
        /// The frame's height in pixels.
        found_height: u32,
        /// The animation's width in pixels.
        width: u32,
        /// The animation's height in pixels.
        height: u32,
    },
    /// An animation got more or fewer frames than announced.
    #[error("{}: {found} frames were given; expected {expected} as announced, and at least 1", file.display())]
    FrameCount {
        /// The file.
        file: PathBuf,
        /// The number of frames given.
        found: u32,
        /// The number announced.
        expected: u32,
    },
    /// The path exists but is not a file, such as a folder.
    #[error("{}: is there already, and is not a file", file.display())]
    NotAFile {
        /// The file.
        file: PathBuf,
    },
    /// The system refused to write it.
    #[error("{}: cannot be written: {source}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The encoder failed.
    #[error("{}: cannot be encoded: {message}", file.display())]
    Encode {
        /// The file.
        file: PathBuf,
        /// The encoder's message.
        message: String,
    },
}

impl OutputError {
    pub(super) fn io(file: &Path, source: io::Error) -> Self {
        Self::Io { file: file.to_owned(), source }
    }

    pub(super) fn png(file: &Path, error: png::EncodingError) -> Self {
        match error {
            png::EncodingError::IoError(source) => Self::io(file, source),
            other => Self::Encode { file: file.to_owned(), message: other.to_string() },
        }
    }

    pub(super) fn image(file: &Path, error: image::ImageError) -> Self {
        match error {
            image::ImageError::IoError(source) => Self::io(file, source),
            other => Self::Encode { file: file.to_owned(), message: other.to_string() },
        }
    }
}

//! The errors of the viewer.

use std::fmt;
use std::path::PathBuf;

use halfway::scene::SceneError;

/// Why the viewer cannot do what it was asked for.
#[derive(Debug)]
pub enum ViewerError {
    /// A scene cannot be read, shown or written.
    Scene(SceneError),
    /// A model cannot be read; the sentence says why.
    Model(String),
    /// A scene file with relative paths would be saved elsewhere.
    OtherFolder {
        /// Where it should be saved.
        file: PathBuf,
        /// The folder of its paths.
        expected: PathBuf,
    },
    /// A picture cannot be drawn or written; the sentence says why.
    Picture(String),
}

impl fmt::Display for ViewerError {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(error) => error.fmt(to),
            Self::Model(sentence) | Self::Picture(sentence) => to.write_str(sentence),
            Self::OtherFolder { file, expected } => write!(
                to,
                "{}: the scene's paths are relative to its folder; expected a file in {}",
                file.display(),
                expected.display()
            ),
        }
    }
}

impl std::error::Error for ViewerError {}

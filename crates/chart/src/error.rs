//! The error of making charts.

use halfway::reference::OracleError;
use halfway::reference::metrics::SizeMismatch;
use halfway::render::RenderError;
use thiserror::Error;

/// Why a measurement failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ChartError {
    /// The adapter could not draw.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The oracle could not draw.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// Pictures of different sizes; the adapter drew another size than asked for.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
    /// A scene cannot be set up, or not as asked.
    #[error("{0}")]
    Scene(String),
    /// A picture could not be put on the page.
    #[error("a picture for the page: {0}")]
    Picture(#[from] image::ImageError),
}

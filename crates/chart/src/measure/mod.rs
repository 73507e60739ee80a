//! The sweeps.

pub mod convergence;
mod fit;
pub mod highlight;
mod progress;
pub mod scaling;
mod stage;

use halfway::prelude::Shading;
use halfway::reference::OracleError;
use halfway::reference::metrics::SizeMismatch;
use halfway::render::RenderError;
use thiserror::Error;

pub use fit::Line;
pub use progress::MeasureProgress;
pub use stage::{ChartObject, ChartScene, SceneApp, longest_edge};

/// The shadings that are compared, the cheapest first.
pub const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

/// A measurement that could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// The adapter could not draw.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The oracle could not draw.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// Pictures of different sizes; the adapter drew what was not asked for.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
    /// A scene cannot be set up, or not as asked.
    #[error("{0}")]
    Scene(String),
    /// What was measured could not be kept.
    #[error("what was measured cannot be kept: {0}")]
    Keep(String),
    /// A picture could not be put on the page.
    #[error("a picture for the page: {0}")]
    Picture(image::ImageError),
}

/// The name of a shading, as a reader knows it.
pub fn shading_name(shading: Shading) -> &'static str {
    match shading {
        Shading::Flat => "flat",
        Shading::Gouraud => "Gouraud",
        Shading::Phong => "Phong",
        _ => "another",
    }
}

//! What shading costs and what it loses: error against time with its Pareto fronts, pages of known failures, and
//! filters of images, measured and charted.
//!
//! [`Report`] is everything that is measured of the project's scenes, [`front::Fronts`] the error and time of chosen
//! scenes, [`filters::Filters`] what filters of images cost and lose. Each says what it found as [`page::Page`]s, which
//! become HTML, SVG and Markdown.

mod error;
pub mod failures;
pub mod figure;
pub mod filters;
pub mod front;
pub mod page;
mod pareto;
mod progress;
mod report;
pub mod timing;

pub use error::ChartError;
pub use progress::Progress;
pub use report::Report;

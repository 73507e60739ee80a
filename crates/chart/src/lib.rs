//! Measures and charts the cost and the error of shading: error against time with its Pareto fronts, known failure
//! modes, and texture filters.
//!
//! [`Report`] measures all of the project's scenes, [`front::Fronts`] the error and time of chosen scenes,
//! [`filters::Filters`] the cost and the error of texture filters. Each makes [`page::Page`]s, which become HTML, SVG
//! and Markdown.

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

//! What shading costs and what it loses: error against time, rates of convergence, how steady highlights are, and how
//! the time of a frame grows.
//!
//! [`ReportPlan`] says how much is measured, [`measure()`] does it, [`Report`] holds what was found, and
//! [`Report::files`] makes a page, tables and drawings of it. The parts can be had alone: error against time in
//! [`front`] and [`Fronts`], the other sweeps in [`mod@measure`], the charts in
//! [`figure`], [`filters`] of images, the page in [`page`].

pub mod failures;
pub mod figure;
pub mod filters;
pub mod front;
pub mod measure;
pub mod page;
mod report;
pub mod timing;

pub use report::{EarlierRun, Filters, Fronts, NamedFile, Report, ReportError, ReportPlan, Scaling, measure};

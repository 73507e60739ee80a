//! The pages of a small report and of small filters, measured once for all tests.

mod browser;
mod filters;
mod report;

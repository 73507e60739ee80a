//! The book in `docs/book`: what its chapters contain, and what mdBook makes of them.

pub(crate) mod chapters;
pub(crate) mod formulas;
pub(crate) mod markdown;
pub(crate) mod questions;
pub(crate) mod site;

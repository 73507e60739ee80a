//! One file a chore.

pub(crate) mod chart;
pub(crate) mod check;
pub(crate) mod demo;
pub(crate) mod docs;
pub(crate) mod fuzz;
pub(crate) mod readme;
pub(crate) mod screen;
pub(crate) mod test;

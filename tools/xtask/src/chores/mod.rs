//! One file a chore.
//!
//! A chore that is a program of the workspace, an example with arguments of its own, say, is a variant of `Chore` in
//! `main.rs` and a function of [`program`].

pub(crate) mod adapters;
pub(crate) mod arm;
pub(crate) mod book;
pub(crate) mod chart;
pub(crate) mod check;
pub(crate) mod demo;
pub(crate) mod docs;
pub(crate) mod fuzz;
pub(crate) mod install_desktop;
pub(crate) mod instructions;
pub(crate) mod program;
pub(crate) mod readme;
pub(crate) mod screen;
pub(crate) mod test;
pub(crate) mod wheel;

//! Random scenes, each drawn by an adapter and judged by the oracle, and failures made small.
//!
//! [`scene`] draws a scene file by numbers: the same one for the same numbers on every machine. [`Judge`] draws it with
//! an adapter and judges it as `halfway verify` does; [`shrink()`] makes what fails small. `cargo xtask wild` does all
//! three.
//! Environments, and normals on objects, are a few small [`IMAGES`], which have to lie in the judge's folder.

mod judge;
mod random;
mod scenery;
mod shrink;

pub use judge::{Fault, Figures, Finding, Judge};
pub use scenery::{IMAGES, scene};
pub use shrink::{shrink, written};

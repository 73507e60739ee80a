//! Random scenes, each drawn by an adapter and judged by the oracle, and failures reduced to small ones.
//!
//! [`scene`] generates a scene file from numbers: the same one for the same numbers on every machine. [`Judge`] draws
//! it with an adapter and judges it as `halfway verify` does; [`shrink()`] reduces failures. `cargo xtask wild` does
//! all three. Environments, and normal maps on objects, are a few small [`IMAGES`], and models a few [`MODELS`], which
//! must lie in the judge's folder.

mod judge;
mod random;
mod scenery;
mod shrink;

pub use judge::{Fault, Figures, Finding, Judge};
pub use scenery::{IMAGES, MODELS, scene};
pub use shrink::{shrink, written};

//! Draws passes and judges the pictures: by an exact fill rule, by the equations in f64, by closed forms, by their
//! bits.

mod bits;
#[path = "../../examples/common/mod.rs"]
mod common;
mod coverage;
mod pass;
mod policy;
mod shading;

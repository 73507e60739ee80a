//! That no point of a patch is lit by more than its bounds say, and that the bounds are of use.

// Equality is meant where it is asserted: exact values, infinities, the very place of a light.
#![allow(clippy::float_cmp)]

mod conservative;
mod exact;
mod many_lights;
mod reach;
mod select;
mod support;
mod tolerance;
mod tree;

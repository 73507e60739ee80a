//! That no point of a patch is lit by more than its bounds say, and that the bounds are of use.

mod conservative;
mod exact;
mod many_lights;
mod select;
mod support;
mod tolerance;
mod tree;

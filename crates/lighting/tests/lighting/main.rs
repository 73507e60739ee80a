//! The promises of `halfway_lighting`, a test each.

// Equality is meant where it is asserted: constants, exact edges, one path equal to another.
#![allow(clippy::float_cmp)]

mod bounds;
mod components;
mod degenerate;
mod ecs;
mod edges;
mod falloff;
mod homework;
mod magnitudes;
mod matched;
mod normals;
mod place;
mod precision;
mod projection;
mod properties;
mod reflectance;
mod shade;
mod support;
mod vectors;
mod visibility;

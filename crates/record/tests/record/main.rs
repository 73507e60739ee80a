//! Recordings: in parts, with smoothing, and invalid ones.

mod parts;
mod refused;
mod smoothing;

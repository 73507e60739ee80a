//! Recordings: what they write, in parts and with smooth motion, and what they refuse.

mod parts;
mod refused;
mod smoothing;

//! The scene as a student draws it who makes mistakes.
//!
//! `hits` finds what the rays through chosen pixels meet, once; `plan` changes lights, materials, normals and
//! frequencies as some mistakes do; `shade` evaluates the lighting, written apart from the oracle's so that every step
//! can go wrong on purpose. Without a mistake it is the oracle's picture.

mod hits;
mod plan;
mod shade;

pub(crate) use hits::HitSheet;

//! Scene files from outside: read, refused, written, spawned.

#![allow(clippy::float_cmp, reason = "what is read and written has to be exact")]

mod bad;
mod bad_keys;
mod bad_values;
mod defaults;
mod documented;
mod examples;
mod spawned;

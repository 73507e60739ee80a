//! Scene files and models from outside: read, refused, written, spawned.

#![allow(clippy::float_cmp, reason = "what is read and written has to be exact")]

mod animation;
mod bad;
mod bad_entries;
mod bad_keys;
mod bad_values;
mod cameras;
mod defaults;
mod documented;
mod environment;
mod examples;
mod far;
mod fuzzed;
mod import;
mod maps;
mod model_animation;
mod model_root;
mod part_of_light;
mod past_failures;
mod retired;
mod scalars;
mod solid;
mod spawned;
mod surfaces;
mod unshown;

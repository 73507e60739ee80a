//! Images in linear light: files, filters, normals, environments, solids.

#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

mod environment;
mod files;
mod footprints;
#[path = "../common/fuzzed.rs"]
mod fuzzed;
mod images;
mod noise;
mod normals;
mod past_failures;
mod plugin;
mod solid;
mod truth;

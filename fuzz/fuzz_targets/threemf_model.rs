//! The model of a 3MF, which the target packs into an archive.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfway_fuzz::feed("threemf_model", bytes));

//! OFF.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfway_fuzz::feed("off", bytes));

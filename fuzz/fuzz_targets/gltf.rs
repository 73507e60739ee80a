//! glTF in text.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfway_fuzz::feed("gltf", bytes));

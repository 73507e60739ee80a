//! The parts of binary glTF: JSON, a zero byte, the buffer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfway_fuzz::feed("glb_chunks", bytes));

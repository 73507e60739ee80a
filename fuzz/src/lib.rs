//! The checks shared by the fuzz targets and the tests of past failures of the crates mesh, scene and texture.

#[path = "../../crates/mesh/tests/common/mod.rs"]
mod common;
#[path = "../../crates/mesh/tests/common/counting.rs"]
mod counting;
#[path = "../../crates/scene/tests/scene/fuzzed.rs"]
mod fuzzed;
#[path = "../../crates/mesh/tests/common/targets.rs"]
mod targets;
#[path = "../../crates/texture/tests/common/fuzzed.rs"]
mod texture;

use counting::Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting::new();

/// Feeds the reader that a target is named after.
///
/// # Panics
/// The reader broke a promise: it panicked, gave a model that is not sound, or took more memory than the bytes warrant.
pub fn feed(target: &str, bytes: &[u8]) {
    targets::feed(target, bytes, &ALLOCATOR);
}

/// Feeds the reader of scene files.
///
/// # Panics
/// As [`feed`].
pub fn feed_scene(bytes: &[u8]) {
    fuzzed::feed(bytes);
}

/// Feeds the reader of images.
///
/// # Panics
/// As [`feed`].
pub fn feed_image(bytes: &[u8]) {
    // The fuzzer's hook ends the program at any panic, even at one of a decoder that the reader turns into an error.
    // Panics that leave this function still end the program with their message.
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    if let Err(panic) = std::panic::catch_unwind(|| texture::feed(bytes)) {
        eprintln!("{}", panic.downcast_ref::<String>().map_or("a panic without a text", String::as_str));
        std::process::abort();
    }
}

//! Limits of the size of images.

/// The most texels along a side of an image: the default limit of WebGPU adapters.
pub const LONGEST_SIDE: u32 = 8192;

/// The most texels of an image, 2²⁵: 512 MiB, and a third more with its pyramid.
pub const MOST_TEXELS: u64 = 1 << 25;

/// The most bytes of an image's values as its decoder gives them, 2³⁰: of 8 bits a channel, 16384 × 16384 texels.
pub(crate) const MOST_DECODED: u64 = 1 << 30;

//! Limits of the size of images.

/// The most texels along a side of an image: the default limit of WebGPU adapters.
pub const LONGEST_SIDE: u32 = 8192;

/// The most texels of an image, 2²⁵: 512 MiB, and a third more with its pyramid.
pub const MOST_TEXELS: u64 = 1 << 25;

#![doc = include_str!("../README.md")]
#![expect(clippy::inline_always, reason = "what is not inlined is not compiled for the CPU's vectors")]
#![expect(
    clippy::needless_range_loop,
    reason = "an index runs over several vectors; an iterator's closures would not be inlined"
)]
#![expect(clippy::too_many_arguments, reason = "vectors are passed in registers, and not in structs in memory")]

mod error;
mod input;
mod lighting;
mod pixels;
mod policy;
mod rasterizer;
mod shading;
mod simd;
mod threads;
mod tiles;
mod triangles;
mod vertices;

pub use error::{LARGEST_SIDE, RasterError};
pub use input::pass::{DrawCall, DrawMaps, MapCall, MapData, Output, Pass, PixelFormat};
pub use input::pieces::{Pieces, TriangleOrder, VertexLists};
pub use rasterizer::{RasterOptions, Rasterizer};
pub use simd::width::{VectorWidth, WIDTH_VARIABLE};
pub use threads::Threads;
pub use tiles::bands::ClearTiles;

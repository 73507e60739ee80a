#![doc = include_str!("../README.md")]
#![expect(clippy::inline_always, reason = "what is not inlined is not compiled for the CPU's vectors")]
#![expect(
    clippy::needless_range_loop,
    reason = "an index runs over several vectors; an iterator's closures would not be inlined"
)]
#![expect(clippy::too_many_arguments, reason = "vectors are passed in registers, and not in structs in memory")]

mod attributes;
mod bands;
mod bins;
mod blend;
mod check;
mod clip;
mod cover;
mod encode;
mod error;
mod faces;
mod four;
mod hidden;
mod lane_triangles;
mod lanes;
mod lighting;
mod lobe;
mod look;
mod mapped;
mod mapped_pixels;
mod mapped_vertices;
mod pass;
mod pieces;
mod placed;
mod planes;
mod policy;
mod power;
mod rasterizer;
mod samples;
mod screen;
mod shade;
mod state;
mod surroundings;
mod threads;
mod tile;
mod triangle;
mod vertices;
mod width;

pub use bands::ClearTiles;
pub use error::{LARGEST_SIDE, RasterError};
pub use pass::{DrawCall, DrawMaps, MapCall, MapData, Output, Pass, PixelFormat};
pub use pieces::{Pieces, TriangleOrder, VertexLists};
pub use rasterizer::{RasterOptions, Rasterizer};
pub use threads::Threads;
pub use width::{VectorWidth, WIDTH_VARIABLE};

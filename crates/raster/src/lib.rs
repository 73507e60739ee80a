//! Draws on the CPU, without a graphics driver: lit triangles in tiles of the picture, with vectors as wide as the CPU
//! has. It knows neither a graphics interface nor an ECS; what is drawn is plain data, a [`Pass`].
//!
//! ```
//! use halfway_lighting::{Lens, Samples};
//! use halfway_lighting::record::{InstanceRecord, MaterialRecord, SurfaceRecord};
//! use halfway_raster::{ClearTiles, DrawCall, Output, Pass, Pieces, PixelFormat, Rasterizer, RasterOptions};
//! use halfway_raster::{TriangleOrder, VertexLists};
//!
//! # fn main() -> Result<(), halfway_raster::RasterError> {
//! let triangle = [[-1.0, -1.0, -3.0], [1.0, -1.0, -3.0], [0.0, 1.0, -3.0]];
//! let mesh = Pieces::new(&triangle, VertexLists::default(), &[0, 1, 2], &[], TriangleOrder::Clustered)?;
//! let red = MaterialRecord { base: [1.0, 0.0, 0.0], ..MaterialRecord::default() };
//! let mut bytes = vec![0; 64 * 64 * 4];
//! Rasterizer::new(RasterOptions::default())?.draw(
//!     &Pass {
//!         size: [64, 64],
//!         samples: Samples::One,
//!         pixels: PixelFormat::SrgbBytes,
//!         clear: [0.0; 3],
//!         lens: Lens::perspective([2.0, 2.0], 0.1),
//!         local_viewer: true,
//!         lights: &[],
//!         lists: &[],
//!         surfaces: &[SurfaceRecord { front: red, ..SurfaceRecord::default() }],
//!         instances: &[InstanceRecord {
//!             eye_from_model: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
//!             normal: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
//!             surface: 0,
//!         }],
//!         meshes: &[&mesh],
//!         maps: &[],
//!         surroundings: None,
//!         draws: &[DrawCall { indices: 0..3, instances: 0..1, ..DrawCall::default() }],
//!     },
//!     Output::Bytes(&mut bytes),
//!     &mut ClearTiles::default(),
//! )?;
//! assert_eq!(bytes[4 * (32 * 64 + 32)..][..4], [255, 0, 0, 255]);
//! # Ok(())
//! # }
//! ```
//!
//! The same pass gives the same bits on every width of vectors, with any number of threads and on every machine.
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
pub use pass::{Cull, DrawCall, DrawMaps, MapCall, MapData, Output, Pass, PixelFormat, SurroundingsData};
pub use pieces::{Pieces, TriangleOrder, VertexLists};
pub use rasterizer::{RasterOptions, Rasterizer};
pub use threads::Threads;
pub use width::{VectorWidth, WIDTH_VARIABLE};

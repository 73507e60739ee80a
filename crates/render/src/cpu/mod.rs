//! How the CPU draws batches: meshes are cut into pieces, the frame's records become a pass, and the pass is drawn.

pub(crate) mod draw;
pub(crate) mod meshes;
pub(crate) mod pass;

use halfway_frame::error::RenderError;
use halfway_raster::RasterError;

/// The error of a frame for one of the rasterizer's.
pub(crate) fn raster_error(error: RasterError) -> RenderError {
    match error {
        RasterError::Memory { what, bytes } => RenderError::Memory { what: what.into(), bytes },
        other => RenderError::Cpu(other.to_string()),
    }
}

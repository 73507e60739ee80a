//! Converts errors of the rasterizer to errors of a frame.

use halfway_frame::error::RenderError;
use halfway_raster::RasterError;

/// The error of a frame for one of the rasterizer's.
pub(crate) fn raster_error(error: RasterError) -> RenderError {
    match error {
        RasterError::Memory { what, bytes } => RenderError::Memory { what: what.into(), bytes },
        other => RenderError::Cpu(other.to_string()),
    }
}

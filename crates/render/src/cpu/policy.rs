//! The camera's intensity policy, over the finished picture.

use crate::cpu::canvas::Canvas;
use halfway_lighting::{Camera, Intensity};
use halfway_raster::{RasterError, Rasterizer};

/// How often a policy passes over the memory of a picture.
pub(crate) fn passes(policy: Intensity) -> u32 {
    match policy {
        Intensity::Clamp => 0,
        Intensity::Renormalize { .. } => 2,
        _ => 1,
    }
}

/// Makes the picture of what was drawn.
pub(crate) fn finish(canvas: &mut Canvas, rasterizer: &Rasterizer, camera: &Camera) -> Result<(), RasterError> {
    canvas.finish(rasterizer, camera.intensity, camera.encoding)
}

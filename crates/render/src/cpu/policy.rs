//! The camera's intensity policy, over the finished picture.

use crate::cpu::canvas::Canvas;
use halfway_lighting::{Camera, Intensity};
use halfway_raster::{RasterError, Rasterizer};

/// The number of passes of a policy over a picture.
pub(crate) fn passes(policy: Intensity) -> u32 {
    match policy {
        Intensity::Clamp => 0,
        Intensity::Renormalize { .. } => 2,
        _ => 1,
    }
}

/// Applies the camera's policy to the drawn picture.
pub(crate) fn finish(canvas: &mut Canvas, rasterizer: &Rasterizer, camera: &Camera) -> Result<(), RasterError> {
    canvas.finish(rasterizer, camera.intensity, camera.encoding)
}

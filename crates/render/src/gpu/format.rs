//! The formats of targets, and the device's support for them.

use crate::gpu::device::Gpu;
use crate::picture::Pixels;
use halfway_frame::error::RenderError;
use halfway_lighting::Samples;

pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The format that a scene is drawn into before passes over the finished picture: 32-bit floats, or 16-bit ones if the
/// adapter lacks an operation on those that the frame needs and the target holds bytes.
pub(super) fn drawn_format(
    gpu: &Gpu,
    pixels: Pixels,
    samples: Samples,
    blends: bool,
) -> Result<wgpu::TextureFormat, RenderError> {
    let full = wgpu::TextureFormat::Rgba32Float;
    let half = wgpu::TextureFormat::Rgba16Float;
    match floats_lack(gpu, full, samples, blends) {
        None => Ok(full),
        Some(_) if pixels == Pixels::Byte && floats_lack(gpu, half, samples, blends).is_none() => Ok(half),
        Some(cannot) => Err(RenderError::FloatTarget { cannot: cannot.into() }),
    }
}

/// The format of a picture that is read back.
pub(super) fn headless_format(
    gpu: &Gpu,
    pixels: Pixels,
    samples: Samples,
    blends: bool,
    encodes: bool,
) -> Result<wgpu::TextureFormat, RenderError> {
    match pixels {
        Pixels::Byte if encodes => Ok(wgpu::TextureFormat::Rgba8UnormSrgb),
        Pixels::Byte => Ok(wgpu::TextureFormat::Rgba8Unorm),
        Pixels::Float => match floats_lack(gpu, wgpu::TextureFormat::Rgba32Float, samples, blends) {
            None => Ok(wgpu::TextureFormat::Rgba32Float),
            Some(cannot) => Err(RenderError::FloatTarget { cannot: cannot.into() }),
        },
    }
}

/// Whether a target of the format takes floating point.
pub(super) fn is_float(format: wgpu::TextureFormat) -> bool {
    matches!(format, wgpu::TextureFormat::Rgba32Float | wgpu::TextureFormat::Rgba16Float)
}

/// The operation that the frame needs and the device cannot do with floats of a format.
fn floats_lack(gpu: &Gpu, format: wgpu::TextureFormat, samples: Samples, blends: bool) -> Option<&'static str> {
    use wgpu::TextureFormatFeatureFlags as Flags;
    // The adapter may support more than WebGPU guarantees, but only if the device requested it.
    let can = gpu.format_features(format);
    if !can.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        return Some("draw them");
    }
    if blends && !can.flags.contains(Flags::BLENDABLE) {
        return Some("blend them");
    }
    let four = Flags::MULTISAMPLE_X4 | Flags::MULTISAMPLE_RESOLVE;
    (samples == Samples::Four && !can.flags.contains(four)).then_some("take four samples of them")
}

//! What a target holds, and what the device can do with it.

use crate::device::gpu::Gpu;
use halfway_frame::error::RenderError;
use halfway_lighting::Samples;
use image::{Rgba32FImage, RgbaImage};

/// What a pixel of a headless picture holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Pixels {
    /// 8 bits a channel, encoded as the camera says.
    #[default]
    Byte,
    /// Linear I in 32-bit floating point; not clamped, but after a policy that acts on the finished picture. An adapter
    /// may be unable to blend them, or to take four samples of them: then a frame with
    /// [`Blend`](halfway_lighting::Blend) objects, or with [`Samples::Four`], is
    /// [`RenderError::FloatTarget`], and others are drawn.
    Float,
}

/// A picture, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// 8 bits a channel, encoded as the camera says.
    Byte(RgbaImage),
    /// Linear I, as [`Pixels::Float`] has it.
    Float(Rgba32FImage),
}

impl Picture {
    /// Width and height in pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        match self {
            Self::Byte(image) => image.dimensions(),
            Self::Float(image) => image.dimensions(),
        }
    }
}

/// The format that a scene is drawn into before passes over the finished picture: 32-bit floats, or where the adapter
/// cannot do with them what the frame needs, and bytes are made of them, 16-bit ones.
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

/// What the device cannot do with floats of a format, of what the frame needs.
fn floats_lack(gpu: &Gpu, format: wgpu::TextureFormat, samples: Samples, blends: bool) -> Option<&'static str> {
    use wgpu::TextureFormatFeatureFlags as Flags;
    // The adapter may say more than WebGPU grants, but a device has to have been asked for it.
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

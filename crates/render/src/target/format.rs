//! What a target holds, and what the device can do with it.

use crate::device::gpu::Gpu;
use crate::error::RenderError;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use halfway_lighting::{Encoding, Samples};
use image::{Rgba32FImage, RgbaImage};

/// What a pixel of a headless picture holds.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Pixels {
    /// 8 bits a channel, encoded as the camera says.
    #[default]
    Byte,
    /// Linear I in 32-bit floating point, before the intensity policy. An adapter may be unable to blend them, or to take
    /// four samples of them: then a frame with [`Blend`](halfway_lighting::Blend) objects, or with [`Samples::Four`], is
    /// [`RenderError::FloatTarget`], and others are drawn.
    Float,
}

/// A picture, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// 8 bits a channel, encoded as the camera says.
    Byte(RgbaImage),
    /// Linear I, before the intensity policy.
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

/// What the values of a target's pixels are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PixelValues {
    Bytes(Encoding),
    /// Linear I.
    Floats,
}

impl PixelValues {
    /// What the bytes hold; `None` for floating point.
    pub(crate) fn encoding(self) -> Option<Encoding> {
        match self {
            Self::Bytes(encoding) => Some(encoding),
            Self::Floats => None,
        }
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
        Pixels::Float => match what_floats_lack(gpu, samples, blends) {
            None => Ok(wgpu::TextureFormat::Rgba32Float),
            Some(cannot) => Err(RenderError::FloatTarget { cannot: cannot.into() }),
        },
    }
}

/// Whether a target of the format takes floating point.
pub(super) fn is_float(format: wgpu::TextureFormat) -> bool {
    matches!(format, wgpu::TextureFormat::Rgba32Float | wgpu::TextureFormat::Rgba16Float)
}

/// What the device cannot do with 32-bit floats, of what the frame needs.
fn what_floats_lack(gpu: &Gpu, samples: Samples, blends: bool) -> Option<&'static str> {
    use wgpu::TextureFormatFeatureFlags as Flags;
    let format = wgpu::TextureFormat::Rgba32Float;
    let device = gpu.device.features();
    // The adapter may say more than WebGPU grants, but a device has to have been asked for it.
    let can = if device.contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES) {
        gpu.adapter.get_texture_format_features(format)
    } else {
        format.guaranteed_format_features(device)
    };
    if !can.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        return Some("draw them");
    }
    if blends && !can.flags.contains(Flags::BLENDABLE) {
        return Some("blend them");
    }
    let four = Flags::MULTISAMPLE_X4 | Flags::MULTISAMPLE_RESOLVE;
    (samples == Samples::Four && !can.flags.contains(four)).then_some("take four samples of them")
}

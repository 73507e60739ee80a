//! Pictures, and the values of their pixels.

#[cfg(doc)]
use halfway_frame::error::RenderError;
#[cfg(doc)]
use halfway_lighting::Samples;
use image::{Rgba32FImage, RgbaImage};

/// The values of a pixel of a headless picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Pixels {
    /// 8 bits a channel, in the camera's encoding.
    #[default]
    Byte,
    /// Linear I in 32-bit floating point; not clamped, but after a policy that acts on the finished picture. An adapter
    /// may be unable to blend them, or to take four samples of them: then a frame with
    /// [blended](halfway_lighting::AlphaMode) objects, or with [`Samples::Four`], is
    /// [`RenderError::FloatTarget`], and others are drawn.
    Float,
}

/// A picture, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// 8 bits a channel, in the camera's encoding.
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

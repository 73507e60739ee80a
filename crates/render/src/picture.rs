//! Pictures, and the values of their pixels.

use bevy_math::UVec2;
use halfway_frame::error::RenderError;
#[cfg(doc)]
use halfway_lighting::Samples;
use image::imageops::crop_imm;
use image::{GenericImage, ImageBuffer, Rgba32FImage, RgbaImage};

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

    /// An opaque black picture of the same kind of values.
    #[must_use]
    pub fn black(&self, UVec2 { x, y }: UVec2) -> Self {
        match self {
            Self::Byte(_) => Self::Byte(ImageBuffer::from_pixel(x, y, [0, 0, 0, u8::MAX].into())),
            Self::Float(_) => Self::Float(ImageBuffer::from_pixel(x, y, [0.0, 0.0, 0.0, 1.0].into())),
        }
    }

    /// The part of the picture with this upper left corner and size, as far as the picture reaches.
    #[must_use]
    pub fn part(&self, corner: UVec2, size: UVec2) -> Self {
        match self {
            Self::Byte(image) => Self::Byte(crop_imm(image, corner.x, corner.y, size.x, size.y).to_image()),
            Self::Float(image) => Self::Float(crop_imm(image, corner.x, corner.y, size.x, size.y).to_image()),
        }
    }

    /// Puts another picture over this one, with its upper left corner here.
    ///
    /// # Errors
    /// [`RenderError::NoPicture`] if it has other values or reaches beyond.
    pub fn put(&mut self, UVec2 { x, y }: UVec2, part: &Self) -> Result<(), RenderError> {
        let put = match (self, part) {
            (Self::Byte(whole), Self::Byte(part)) => whole.copy_from(part, x, y).ok(),
            (Self::Float(whole), Self::Float(part)) => whole.copy_from(part, x, y).ok(),
            _ => None,
        };
        put.ok_or(RenderError::NoPicture)
    }
}

//! Images that materials refer to.

use std::sync::Arc;

/// An image that a material refers to: the bytes of its file, not decoded, and how the material looks it up.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceMap {
    /// Its name in messages: its path, or the element of the file.
    pub name: String,
    /// The bytes of a PNG or JPEG file, shared with other materials; empty if it could not be read, in which case the
    /// model has a warning.
    pub bytes: Arc<[u8]>,
    /// The continuation beyond the image along u, and along v.
    pub wrap: [SourceWrap; 2],
    /// Whether magnified texels are interpolated; else they are squares.
    pub smooth: bool,
    /// Whether minified texels are interpolated.
    pub smooth_levels: bool,
    /// The mipmap levels used for minification.
    pub levels: SourceLevels,
    /// The set of texture coordinates, 0 or 1.
    pub uv_set: usize,
    /// The translation of texture coordinates, after `rotation` and `scale`; (0, 0) is the image's top left corner.
    pub offset: [f32; 2],
    /// The rotation in radians, counter-clockwise as the image is seen; after `scale`.
    pub rotation: f32,
    /// The scale.
    pub scale: [f32; 2],
    /// The channel, for maps that use one; `None` if the file does not name it.
    pub channel: Option<SourceChannel>,
    /// The strength of an occlusion map, the scale of a normal map, the height of a bump map. Otherwise 1.
    pub amount: f32,
}

/// One of the four numbers of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceChannel {
    /// The first.
    Red,
    /// The second.
    Green,
    /// The third.
    Blue,
    /// The fourth.
    Alpha,
}

/// The continuation beyond an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SourceWrap {
    /// Repeats the image.
    #[default]
    Repeat,
    /// Repeats the image, mirrored every other time.
    Mirror,
    /// Repeats its outermost texels.
    Clamp,
}

/// The mipmap levels of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SourceLevels {
    /// No mipmaps.
    None,
    /// The level nearest in size.
    Nearest,
    /// Interpolates the two levels nearest in size.
    #[default]
    Linear,
}

impl SourceMap {
    /// The whole image, repeated and smooth.
    pub fn new(name: String, bytes: Arc<[u8]>) -> Self {
        Self {
            name,
            bytes,
            wrap: [SourceWrap::Repeat; 2],
            smooth: true,
            smooth_levels: true,
            levels: SourceLevels::Linear,
            uv_set: 0,
            offset: [0.0; 2],
            rotation: 0.0,
            scale: [1.0; 2],
            channel: None,
            amount: 1.0,
        }
    }
}

//! Images that materials refer to.

use std::sync::Arc;

/// An image that a material refers to: the bytes of its file, not decoded, and how the material looks it up.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceMap {
    /// What messages call it: its path, or its place in the file.
    pub name: String,
    /// The bytes of a PNG or JPEG file, shared with other materials; none where it could not be read, of which a
    /// warning of the model tells.
    pub bytes: Arc<[u8]>,
    /// What is beyond the image along u, and along v.
    pub wrap: [SourceWrap; 2],
    /// Whether texels that are larger than pixels are blurred into each other; else they are squares.
    pub smooth: bool,
    /// Whether texels that are smaller than pixels are.
    pub smooth_levels: bool,
    /// Which smaller images stand for the image there.
    pub levels: SourceLevels,
    /// The number of the set of texture coordinates that it takes, 0 or 1.
    pub uv_set: usize,
    /// Texture coordinates are moved by this, after `rotation` and `scale`; (0, 0) is the image's top left corner.
    pub offset: [f32; 2],
    /// Turned by, in radians, counter-clockwise as the image is seen; after `scale`.
    pub rotation: f32,
    /// Stretched by.
    pub scale: [f32; 2],
    /// The number of a texel that counts where one does; `None` where the file does not say.
    pub channel: Option<SourceChannel>,
    /// How much it counts: the strength of an occlusion, the scale of a normal map, the height of a bump map.
    /// Otherwise 1.
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

/// What is beyond an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SourceWrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and then again.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

/// Which smaller images stand for an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SourceLevels {
    /// None.
    None,
    /// The one nearest in size.
    Nearest,
    /// The two nearest in size, mixed.
    #[default]
    Linear,
}

impl SourceMap {
    /// The whole image, repeated and smooth.
    pub(crate) fn new(name: String, bytes: Arc<[u8]>) -> Self {
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

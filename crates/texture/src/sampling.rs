//! How an image is looked up.

use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// What is beyond the image.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and then again.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

/// How the texels of one image become a value between them. `f` is the part of the way from one texel's center to the next.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum TexelFilter {
    /// The texel that the point lies in.
    Nearest,
    /// The mean of four, weighted by 1 − f and f along each axis.
    #[default]
    Bilinear,
    /// The uniform cubic B-spline over sixteen (Hou and Andrews 1978): smooth, softer than the texels, never beyond them.
    BSpline,
    /// The cubic through the texels with slopes half their neighbours' difference (Catmull and Rom 1974), over sixteen:
    /// sharper; it overshoots at edges.
    CatmullRom,
}

/// Which levels of the pyramid a point whose footprint is larger than a texel takes.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum LevelFilter {
    /// The image itself, whose texels are then skipped.
    None,
    /// The one nearest to D (Williams 1983).
    Nearest,
    /// The two around D, weighted by the distance from it.
    #[default]
    Linear,
}

/// How an image is looked up: a value of each point and its footprint.
///
/// D = log₂ of the longer side of the footprint in texels. Where D ≤ 0 the image is enlarged, by `magnify`. Elsewhere it is
/// reduced: `levels` says which levels count, and `minify` how each of them is looked up. The default is trilinear.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub struct Sampling {
    /// What is beyond the image along u, and along v.
    pub wrap: [Wrap; 2],
    /// The filter where D ≤ 0.
    pub magnify: TexelFilter,
    /// The filter in each level where D > 0.
    pub minify: TexelFilter,
    /// The levels where D > 0.
    pub levels: LevelFilter,
}

impl Sampling {
    /// One texel a point, whatever its size.
    pub const NEAREST: Self = Self {
        wrap: [Wrap::Repeat; 2],
        magnify: TexelFilter::Nearest,
        minify: TexelFilter::Nearest,
        levels: LevelFilter::None,
    };
}

/// The number of a texel that counts where one does.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Channel {
    /// The first; of a grey image any of three.
    #[default]
    Red,
    /// The second.
    Green,
    /// The third.
    Blue,
    /// The fourth.
    Alpha,
}

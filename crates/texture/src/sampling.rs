//! How an image is looked up.

/// What is beyond the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and then again.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

/// How the texels of one image become a value between them. `f` is the part of the way from one texel's center to the
/// next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelFilter {
    /// The texel that the point lies in.
    Nearest,
    /// The mean of four, weighted by 1 − f and f along each axis.
    #[default]
    Bilinear,
    /// The uniform cubic B-spline over sixteen (Hou and Andrews 1978): smooth, softer than the texels, never beyond
    /// them.
    BSpline,
    /// The cubic through the texels with slopes half their neighbours' difference (Catmull and Rom 1974), over sixteen:
    /// sharper; it overshoots at edges.
    CatmullRom,
}

/// What is taken of an image at a point whose footprint is larger than a texel.
///
/// The first three go by D, the level of a square footprint. The others go by the footprint's shape: the ellipse of the
/// points a·x + b·y with x² + y² ≤ 1, where a and b say how (u, v), in texels, change from a pixel to the next along x
/// and along y. Its semiaxes are σ₁ ≥ σ₂, the singular values of the matrix (a b). Where σ₁ ≤ 1 the image is enlarged.
///
/// Slopes of heights go by D under all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LevelFilter {
    /// The image itself, whose texels are then skipped.
    None,
    /// The level nearest to D (Williams 1983).
    Nearest,
    /// The two levels around D, weighted by the distance from it.
    #[default]
    Linear,
    /// The images of a [`Ripmap`](crate::Ripmap) around log₂ of √(aᵤ² + bᵤ²) along u and of √(aᵥ² + bᵥ²) along v: the
    /// sides of a rectangle along the axes that is as spread out as the footprint.
    Ripmap,
    /// The mean of that rectangle, at least a texel wide and high, by [`SummedAreas`](crate::SummedAreas).
    SummedArea,
    /// Up to 2 probes along the ellipse's long axis: N = min(σ₁/max(σ₂, 1), 2), the level is log₂(σ₁/N) by
    /// [`Linear`](Self::Linear), and the probes lie σ₁/N apart: one in the middle, and pairs around it, of which the
    /// outermost has what is left of the weight N. With N growing, pairs come in with weight 0, so that nothing jumps.
    Anisotropic2,
    /// Up to 4 probes' weight, likewise.
    Anisotropic4,
    /// Up to 8 probes' weight, likewise.
    Anisotropic8,
    /// Up to 16 probes' weight, likewise.
    Anisotropic16,
    /// All texels in the ellipse, weighted by a Gaussian: the elliptical weighted average of Heckbert 1989, in the two
    /// levels around log₂ of the short semiaxis. That is lengthened where it is less than 1/16 of the long one or than
    /// a texel.
    Elliptical,
}

impl LevelFilter {
    /// Itself where it goes by D alone, else [`Linear`](Self::Linear): what stands for it where only D is known.
    #[must_use]
    pub fn by_level(self) -> Self {
        match self {
            Self::None | Self::Nearest | Self::Linear => self,
            _ => Self::Linear,
        }
    }

    /// What of an image it reads.
    pub fn form(self) -> ImageForm {
        match self {
            Self::Ripmap => ImageForm::Ripmap,
            Self::SummedArea => ImageForm::SummedAreas,
            _ => ImageForm::Pyramid,
        }
    }

    /// N at most, of those with probes.
    pub(crate) fn most_probes(self) -> Option<u8> {
        match self {
            Self::Anisotropic2 => Some(2),
            Self::Anisotropic4 => Some(4),
            Self::Anisotropic8 => Some(8),
            Self::Anisotropic16 => Some(16),
            _ => None,
        }
    }
}

/// What of an image a [`LevelFilter`] reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImageForm {
    /// The levels of its [`Pyramid`](crate::Pyramid).
    Pyramid,
    /// Its [`Ripmap`](crate::Ripmap).
    Ripmap,
    /// The image itself, and its [`SummedAreas`](crate::SummedAreas).
    SummedAreas,
}

/// How an image is looked up: a value of each point and its footprint.
///
/// D = log₂ of the longer side of the footprint in texels. Where D ≤ 0 the image is enlarged, by `magnify`. Elsewhere
/// it is reduced: `levels` says what is taken of it, and `minify` how its levels are looked up between texels; summed
/// areas and ellipses need no such filter. The default is trilinear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
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

/// The texel that a number stands for that may lie beyond the image.
pub(crate) fn wrapped_index(wrap: Wrap, at: i64, side: u32) -> usize {
    let side = i64::from(side);
    let index = match wrap {
        Wrap::Repeat => at.rem_euclid(side),
        Wrap::Mirror => {
            let there_and_back = at.rem_euclid(2 * side);
            there_and_back.min(2 * side - 1 - there_and_back)
        }
        Wrap::Clamp => at.clamp(0, side - 1),
    };
    index as usize
}

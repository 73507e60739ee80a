//! Filter settings of an image.

/// How an image continues beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Repeats the image.
    #[default]
    Repeat,
    /// Repeats the image, mirrored every other time.
    Mirror,
    /// Repeats its outermost texels.
    Clamp,
}

/// The filter between the texels of one image. `f` is the fraction of the way from one texel's center to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelFilter {
    /// The texel that contains the point.
    Nearest,
    /// Bilinear: the mean of four, weighted by 1 − f and f along each axis.
    #[default]
    Bilinear,
    /// The uniform cubic B-spline over sixteen (Hou and Andrews 1978): smooth, softer than the texels, never beyond
    /// them.
    BSpline,
    /// The cubic through the texels with slopes half their neighbours' difference (Catmull and Rom 1974), over sixteen:
    /// sharper; it overshoots at edges.
    CatmullRom,
}

/// The minification filter, for footprints larger than a texel.
///
/// The first three go by D, the level of a square footprint. The others go by the footprint's shape: the ellipse of the
/// points a·x + b·y with x² + y² ≤ 1, where a and b are the derivatives of (u, v), in texels, along x and y of the
/// picture. Its semiaxes are σ₁ ≥ σ₂, the singular values of the matrix (a b). Where σ₁ ≤ 1 the image is magnified.
///
/// Slopes of heights go by D under all filters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LevelFilter {
    /// The image itself, which aliases.
    None,
    /// The level nearest to D (Williams 1983).
    Nearest,
    /// Trilinear: interpolates the two levels around D.
    #[default]
    Linear,
    /// The images of a [`Ripmap`](crate::Ripmap) around log₂ of √(aᵤ² + bᵤ²) along u and of √(aᵥ² + bᵥ²) along v: the
    /// sides of a rectangle along the axes with the variance of the footprint.
    Ripmap,
    /// The mean of that rectangle, at least a texel wide and high, by [`SummedAreas`](crate::SummedAreas).
    SummedArea,
    /// Up to 2 probes along the ellipse's long axis: N = min(σ₁/max(σ₂, 1), 2), the level is log₂(σ₁/N) by
    /// [`Linear`](Self::Linear), and the probes lie σ₁/N apart: one in the middle, and pairs around it, of which the
    /// outermost has the rest of the weight N. As N grows, pairs begin with weight 0, so that nothing jumps.
    Anisotropic2,
    /// Up to 4 probes.
    Anisotropic4,
    /// Up to 8 probes.
    Anisotropic8,
    /// Up to 16 probes.
    Anisotropic16,
    /// All texels in the ellipse, weighted by a Gaussian: the elliptical weighted average of Heckbert 1989, in the two
    /// levels around log₂ of the short semiaxis, which is lengthened to at least 1/16 of the long one and to a texel.
    Elliptical,
}

impl LevelFilter {
    /// Itself if it goes by D alone, else [`Linear`](Self::Linear): the fallback where only D is known.
    #[must_use]
    pub fn by_level(self) -> Self {
        match self {
            Self::None | Self::Nearest | Self::Linear => self,
            _ => Self::Linear,
        }
    }

    /// The form of an image that it reads.
    pub fn form(self) -> ImageForm {
        match self {
            Self::Ripmap => ImageForm::Ripmap,
            Self::SummedArea => ImageForm::SummedAreas,
            _ => ImageForm::Pyramid,
        }
    }

    /// The largest N, for filters with probes.
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

/// The form of an image that a [`LevelFilter`] reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImageForm {
    /// The levels of its [`Pyramid`](crate::Pyramid).
    Pyramid,
    /// Its [`Ripmap`](crate::Ripmap).
    Ripmap,
    /// The image itself, and its [`SummedAreas`](crate::SummedAreas).
    SummedAreas,
}

/// The filters and the wrapping of an image: its value at a point with a footprint.
///
/// D = log₂ of the longer side of the footprint in texels. Where D ≤ 0 the image is magnified, by `magnify`. Elsewhere
/// it is minified: `levels` chooses the levels, and `minify` interpolates within them; summed areas and ellipses need
/// no such filter. The default is trilinear.
///
/// ```
/// use halfway_texture::{LevelFilter, Pyramid, Sampling, TexelImage, Wrap, lookup};
///
/// let checker = Pyramid::new(TexelImage::from_fn(8, 8, |x, y| [((x + y) % 2) as f32; 4])?);
/// let sampling = Sampling { wrap: [Wrap::Mirror; 2], levels: LevelFilter::Elliptical, ..Sampling::default() };
/// // A long, thin footprint, as of a floor seen from the side.
/// let [gray, ..] = lookup::filtered(&checker, &sampling, [0.4_f64, 0.4], [[0.5, 0.0], [0.0, 0.2]]);
/// assert!((gray - 0.5).abs() < 0.1);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// How the image continues along u, and along v.
    pub wrap: [Wrap; 2],
    /// The filter where D ≤ 0.
    pub magnify: TexelFilter,
    /// The filter in each level where D > 0.
    pub minify: TexelFilter,
    /// The levels where D > 0.
    pub levels: LevelFilter,
}

impl Sampling {
    /// Unfiltered: the nearest texel, whatever its size.
    pub const NEAREST: Self = Self {
        wrap: [Wrap::Repeat; 2],
        magnify: TexelFilter::Nearest,
        minify: TexelFilter::Nearest,
        levels: LevelFilter::None,
    };
}

/// The channel of a texel, for maps that use one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Channel {
    /// The first; in a grey image equal to the next two.
    #[default]
    Red,
    /// The second.
    Green,
    /// The third.
    Blue,
    /// The fourth.
    Alpha,
}

/// The index of a texel that may lie beyond the image, wrapped.
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

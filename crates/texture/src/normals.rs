//! Normals in images: made of heights, and looked up from afar without losing their roughness.
//!
//! A normal (x, y, z) in the surface's own axes, x along u, y upward on the image, against v, and z out of the surface, stands
//! in the first three numbers of a texel as (x, y, z)/2 + ½, as files have it.

use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::error::TextureError;
use crate::lookup::{self, Number, wrapped_index};
use crate::pyramid::Pyramid;
use crate::sampling::{Sampling, Wrap};
use crate::texels::TexelImage;

/// The normals of the heights in the first numbers of an image's texels: (−∂h/∂x, −∂h/∂y, 1) at length 1, y upward. Slopes are
/// half the difference of the two neighbours, wrapped as said. `strength` is the height of 1 in widths of a texel; negative
/// ones turn bumps into dents.
///
/// # Errors
/// A strength that is not finite: [`TextureError::NotFinite`].
pub fn from_heights(heights: &TexelImage, wrap: [Wrap; 2], strength: f32) -> Result<TexelImage, TextureError> {
    let [width, height] = heights.size();
    let at = |x: i64, y: i64| {
        let [x, y] = [wrapped_index(wrap[0], x, width), wrapped_index(wrap[1], y, height)];
        f64::from(heights.texels()[y * width as usize + x][0])
    };
    TexelImage::from_fn(width, height, |x, y| {
        let [x, y] = [i64::from(x), i64::from(y)];
        let slope = |difference: f64| 0.5 * f64::from(strength) * difference;
        // Rows run downward.
        let [a, b] = [slope(at(x + 1, y) - at(x - 1, y)), slope(at(x, y - 1) - at(x, y + 1))];
        let length = (a * a + b * b + 1.0).sqrt();
        let [x, y, z] = [-a / length, -b / length, 1.0 / length].map(|number| (0.5 * number + 0.5) as f32);
        [x, y, z, 1.0]
    })
}

/// The normal that a texel, or a mean of texels, stands for. Means are shorter than 1.
pub fn decoded<T: Number>([x, y, z, _]: [T; 4]) -> [T; 3] {
    [x, y, z].map(|number| T::of(2.0) * number - T::one())
}

/// What highlights take of a map of normals that are smaller than a pixel.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum FarNormals {
    /// Where their mean points: highlights from afar are too sharp and too bright, and they flicker.
    #[default]
    Mean,
    /// And how long it is: wider and fainter highlights, by [`toksvig`] of [`mean_length`].
    Toksvig,
}

/// How long the mean of normals is that a texel stands for, 0 to 1, had their slopes been `s` times as steep: with |n| the
/// length that it has, |n|/(|n| + s²·(1 − |n|)). For (1 − |n|)/|n| is the variance of their slopes in [`toksvig`].
///
/// A vector that is mirrored by the normals turns twice as far as they do: for the exponent of (r·v)^s take 2·s.
pub fn mean_length<T: Number>(texel: [T; 3], s: T) -> T {
    let [x, y, z] = texel.map(|number| T::of(2.0) * number - T::one());
    let length = (x * x + y * y + z * z).sqrt();
    if length >= T::one() {
        return T::one();
    }
    length / (length + s * s * (T::one() - length)).max(T::of(f64::from(f32::MIN_POSITIVE)))
}

/// What Toksvig, "Mipmapping Normal Maps", 2005, makes of a highlight (n·h)^s where the mean of the normals has this length:
/// the exponent f·s and the factor (1 + f·s)/(1 + s), with f = |n|/(|n| + s(1 − |n|)).
pub fn toksvig<T: Number>(length: T, exponent: T) -> [T; 2] {
    let length = length.max(T::zero()).min(T::one());
    let f = length / (length + exponent * (T::one() - length)).max(T::of(f64::from(f32::MIN_POSITIVE)));
    [f * exponent, (T::one() + f * exponent) / (T::one() + exponent)]
}

/// The moments of an image of normals, with their pyramids: what Olano and Baker, "LEAN Mapping", 2010, keep.
///
/// Of each normal the slopes b = (x/z, y/z), and b·bᵀ. Their means over a part of the image are means of texels, so that every
/// filter does; and the covariance is what roughness the part has.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMoments {
    slopes: Pyramid,
    squares: Pyramid,
}

/// What a part of an image of normals has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeSpread<T> {
    /// The mean slopes, x/z and y/z.
    pub mean: [T; 2],
    /// Their covariance: of x with x, x with y, y with y.
    pub covariance: [T; 3],
}

/// Slopes are kept up to this, 86° from the surface's normal: so steep ones would outweigh all others.
const STEEPEST: f64 = 16.0;

impl NormalMoments {
    /// Of an image of normals. Slopes of normals that lie flat or point into the surface
    /// are kept within the steepest.
    ///
    /// # Errors
    /// As of [`TexelImage::new`].
    pub fn new(normals: &TexelImage) -> Result<Self, TextureError> {
        let slopes: Vec<[f64; 2]> = normals
            .texels()
            .iter()
            .map(|texel| {
                let [x, y, z] = decoded(texel.map(f64::from));
                [x, y].map(|side| (side / z.max(1e-9)).clamp(-STEEPEST, STEEPEST))
            })
            .collect();
        let [width, height] = normals.size();
        let image = |texel: fn([f64; 2]) -> [f64; 3]| {
            let texels = slopes.iter().map(|slopes| {
                let [a, b, c] = texel(*slopes).map(|number| number as f32);
                [a, b, c, 1.0]
            });
            TexelImage::new(width, height, texels.collect()).map(Pyramid::new)
        };
        Ok(Self { slopes: image(|[x, y]| [x, y, 0.0])?, squares: image(|[x, y]| [x * x, x * y, y * y])? })
    }

    /// What a footprint sees of it, by the filters of [`lookup::filtered`].
    pub fn at<T: Number>(&self, sampling: &Sampling, uv: [T; 2], footprint: [[T; 2]; 2]) -> SlopeSpread<T> {
        let [x, y, ..] = lookup::filtered(&self.slopes, sampling, uv, footprint);
        let [xx, xy, yy, _] = lookup::filtered(&self.squares, sampling, uv, footprint);
        let zero = T::zero();
        SlopeSpread { mean: [x, y], covariance: [(xx - x * x).max(zero), xy - x * y, (yy - y * y).max(zero)] }
    }
}

impl<T: Number> SlopeSpread<T> {
    /// The normal of the mean slopes, of length 1.
    pub fn normal(&self) -> [T; 3] {
        let [x, y] = self.mean;
        let length = (x * x + y * y + T::one()).sqrt();
        [x / length, y / length, length.recip()]
    }

    /// The exponent of a highlight (n·h)^s that is as wide as that of all normals: 1/(1/s + ½ tr Σ), and the factor that keeps
    /// its energy, that over s. For whoever has no highlight of two axes.
    pub fn exponent(&self, s: T) -> [T; 2] {
        let wider = (T::one() + T::of(0.5) * s * (self.covariance[0] + self.covariance[2])).recip();
        [s * wider, wider]
    }

    /// The mean of (n·h)^s over the normals, h the half vector in the surface's axes: with d the slopes of h less the mean, and
    /// C = Σ + 1/s, it is e^(−½ dᵀC⁻¹d)/(s·√det C). For one normal this is e^(−s·tan²/2), which is near the power for large s.
    pub fn highlight(&self, h: [T; 3], s: T) -> T {
        if h[2] <= T::zero() {
            return T::zero();
        }
        let own = s.recip();
        let [xx, xy, yy] = [self.covariance[0] + own, self.covariance[1], self.covariance[2] + own];
        let determinant = (xx * yy - xy * xy).max(own * own);
        let [x, y] = [h[0] / h[2] - self.mean[0], h[1] / h[2] - self.mean[1]];
        let squared = (yy * x * x - T::of(2.0) * xy * x * y + xx * y * y) / determinant;
        (-T::of(0.5) * squared).exponential() / (s * determinant.sqrt())
    }
}

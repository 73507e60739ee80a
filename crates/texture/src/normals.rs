//! Normal maps: made from heights, and filtered without losing their roughness.
//!
//! A normal (x, y, z) in tangent space, x along u, y upward on the image, against v, and z out of the surface, is
//! stored in the first three values of a texel as (x, y, z)/2 + ½, as files have it.
//!
//! ```
//! use halfway_texture::normals::{from_heights, toksvig};
//! use halfway_texture::{TexelImage, Wrap};
//!
//! let waves = TexelImage::from_fn(16, 1, |x, _| [(x as f32 * 0.4).sin(); 4])?;
//! let normals = from_heights(&waves, [Wrap::Repeat; 2], 2.0)?;
//! assert!(normals.texels()[0][0] < 0.5); // It rises to the right, so the normal leans to the left.
//!
//! // From afar, shorter mean normals make wider and fainter highlights.
//! let [exponent, factor] = toksvig(0.9_f64, 100.0);
//! assert!(exponent < 100.0 && factor < 1.0);
//! # Ok::<(), halfway_texture::TextureError>(())
//! ```

use crate::error::TextureError;
use crate::lookup::{self, Number, wrapped_index};
use crate::pyramid::Pyramid;
use crate::sampling::{Sampling, Wrap};
use crate::texels::TexelImage;

/// The normals of the heights in the first channel of an image: (−∂h/∂x, −∂h/∂y, 1), normalized, y upward. Slopes are
/// half the difference of the two neighbours, wrapped by `wrap`. `strength` is the height of 1 in widths of a texel;
/// negative ones turn bumps into dents.
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

/// The treatment of highlights on a normal map whose texels are smaller than a pixel, where light is shaded at the
/// fragments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FarNormals {
    /// The direction of their mean only: highlights from afar are too sharp and too bright, and they flicker.
    #[default]
    Mean,
    /// The length of their mean too: wider and fainter highlights, by [`toksvig`] of [`mean_length`].
    Toksvig,
    /// The covariance of their slopes (Olano and Baker, "LEAN Mapping", 2010): anisotropic highlights, by [`lean_lobe`]
    /// about the normal of the mean slopes. Reads [`Pyramid::moments`], two images of the same size, in place of the
    /// normals. The reflection of an environment stays isotropic: one exponent, by [`spread_length`].
    Lean,
}

impl FarNormals {
    /// All, cheapest first.
    pub const ALL: [Self; 3] = [Self::Mean, Self::Toksvig, Self::Lean];
}

/// The length of the mean of a texel's normals, 0 to 1, had their slopes been `s` times as steep: with |n| the length
/// that it has, |n|/(|n| + s²·(1 − |n|)), since (1 − |n|)/|n| is the variance of their slopes in [`toksvig`].
///
/// A vector that is reflected at the normals turns twice as far as they do: for the exponent of (r·v)^s take 2·s.
pub fn mean_length<T: Number>(texel: [T; 3], s: T) -> T {
    let [x, y, z] = texel.map(|number| T::from_f64(2.0) * number - T::one());
    let length = (x * x + y * y + z * z).sqrt();
    if length >= T::one() {
        return T::one();
    }
    length / (length + s * s * (T::one() - length)).max(T::from_f64(f64::from(f32::MIN_POSITIVE)))
}

/// The correction of Toksvig, "Mipmapping Normal Maps", 2005, for a highlight (n·h)^s where the mean of the normals has
/// this length: the exponent f·s and the factor (1 + f·s)/(1 + s), with f = |n|/(|n| + s(1 − |n|)).
pub fn toksvig<T: Number>(length: T, exponent: T) -> [T; 2] {
    let length = length.max(T::zero()).min(T::one());
    let f = length / (length + exponent * (T::one() - length)).max(T::from_f64(f64::from(f32::MIN_POSITIVE)));
    [f * exponent, (T::one() + f * exponent) / (T::one() + exponent)]
}

/// The mean slopes of a part of a normal map, by its [moments](Pyramid::moments): Olano and Baker, "LEAN Mapping",
/// 2010.
///
/// Each normal has the slopes b = (x/z, y/z), and b·bᵀ. Their means over a part of the image are means of texels, so
/// that every filter applies; and the covariance, the mean of b·bᵀ minus the square of that of b, is the roughness of
/// that part along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeSpread<T> {
    /// The mean slopes, x/z and y/z.
    pub mean: [T; 2],
    /// The means of their products: x·x, x·y, y·y.
    pub squares: [T; 3],
}

impl<T: Number> SlopeSpread<T> {
    /// The mean slopes and products under a footprint, by the filters of [`lookup::filtered`].
    pub fn filtered(pyramid: &Pyramid, sampling: &Sampling, uv: [T; 2], footprint: [[T; 2]; 2]) -> Self {
        let [slopes, squares] = pyramid.moments();
        let [x, y, ..] = lookup::filtered(slopes, sampling, uv, footprint);
        let [xx, xy, yy, _] = lookup::filtered(squares, sampling, uv, footprint);
        Self { mean: [x, y], squares: [xx, xy, yy] }
    }

    /// The normal of the mean slopes, encoded as in texels, but not normalized: (x, y, 1)/2 + ½.
    pub fn texel(&self) -> [T; 3] {
        let [x, y] = self.mean.map(|slope| T::from_f64(0.5) * slope + T::from_f64(0.5));
        [x, y, T::one()]
    }

    /// Its [`slope_covariance`].
    pub fn covariance(&self, s: T) -> [T; 3] {
        slope_covariance(self.mean, self.squares, s)
    }
}

/// The covariance of slopes that are `s` times as steep, from the mean slopes and the means of their products: of x
/// with x, of x with y, of y with y. `s` is clamped to 10⁶, so that all of it is finite.
pub fn slope_covariance<T: Number>([x, y]: [T; 2], [xx, xy, yy]: [T; 3], s: T) -> [T; 3] {
    let s = s.max(T::from_f64(-1e6)).min(T::from_f64(1e6));
    let [xx, yy] = [xx - x * x, yy - y * y].map(|variance| variance.max(T::zero()));
    [xx, xy - x * y, yy].map(|number| s * s * number)
}

/// The length of the mean of normals whose slopes have this covariance, as [`toksvig`] takes it: 1/(1 + ½ tr Σ). Used
/// by isotropic highlights.
pub fn spread_length<T: Number>([xx, _, yy]: [T; 3]) -> T {
    (T::one() + T::from_f64(0.5) * (xx + yy)).recip()
}

/// The lobe of a highlight (n·h)^s over normals whose slopes have this covariance Σ. Its width is Σ + I/s, whose
/// inverse comes first (of x with x, of x with y, of y with y); the last number is 1/(s·√det(Σ + I/s)), which keeps its
/// energy. Along a direction d, of length 1, the exponent is dᵀ(Σ + I/s)⁻¹d, as Ashikhmin and Shirley, "An Anisotropic
/// Phong BRDF Model", 2000, have it: `halfway_lighting::equations::axial_exponent`. Without roughness it is s in all
/// directions.
pub fn lean_lobe<T: Number>(covariance: [T; 3], s: T) -> [T; 4] {
    // Of s·Σ + I, which is finite for each s; clamped to the range of squares of f32.
    let [xx, xy, yy] = covariance.map(|number| (s * number).max(T::from_f64(-1e12)).min(T::from_f64(1e12)));
    let [xx, yy] = [xx + T::one(), yy + T::one()];
    // Filters with negative weights may leave no valid covariance; the determinant of a valid one is not less.
    let determinant = (xx * yy - xy * xy).max(xx + yy - T::one());
    let over = s / determinant;
    [over * yy, -over * xy, over * xx, determinant.sqrt().recip()]
}

//! The filters: the value of an image at a point, given its footprint.
//!
//! | case | result |
//! |---|---|
//! | u or v is not finite | as 0 |
//! | an infinite footprint, or one of more than 10⁹ texels under a filter by shape | the last level |
//! | a footprint that is NaN | the image is magnified |
//! | a level of one texel along an axis | that texel, whatever the wrap |
//!
//! ```
//! use halfway_texture::lookup::{filtered, level};
//! use halfway_texture::{Pyramid, Sampling, TexelImage};
//!
//! let ramp = Pyramid::new(TexelImage::from_fn(64, 64, |x, _| [x as f32 / 63.0; 4])?);
//! // A pixel that covers 4 × 2 texels: the level of its longer side is 2.
//! let footprint = [[4.0 / 64.0, 0.0], [0.0, 2.0 / 64.0]];
//! assert_eq!(level(ramp.size(), footprint), 2.0_f64);
//! let [gray, ..] = filtered(&ramp, &Sampling::default(), [0.5_f64, 0.5], footprint);
//! assert!((gray - 0.5).abs() < 0.01);
//! # Ok::<(), halfway_texture::TextureError>(())
//! ```

mod axes;
mod ellipse;
mod footprint;
mod probes;

use std::fmt::Debug;

use num_traits::Float;

use self::footprint::FootprintShape;
use crate::halves::Level;
use crate::pyramid::Pyramid;
pub(crate) use crate::sampling::wrapped_index;
use crate::sampling::{Channel, LevelFilter, Sampling, TexelFilter, Wrap};

/// The floating-point types that filters run in: `f32` and `f64`.
pub trait Number: Float + Debug + Send + Sync + 'static {
    /// `value` rounded to this type.
    fn from_f64(value: f64) -> Self;
    /// log₂, equal to the bit on every machine.
    #[must_use]
    fn binary_logarithm(self) -> Self;
    /// The sine, equal to the bit on every machine.
    #[must_use]
    fn sine(self) -> Self;
    /// The cosine, likewise.
    #[must_use]
    fn cosine(self) -> Self;
    /// The angle of the point (`x`, self), in −π to π, likewise.
    #[must_use]
    fn arc_tangent(self, x: Self) -> Self;
    /// 2 to this power, equal to the bit on every machine.
    #[must_use]
    fn binary_power(self) -> Self;
}

impl Number for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    fn binary_logarithm(self) -> Self {
        libm::log2f(self)
    }

    fn sine(self) -> Self {
        libm::sinf(self)
    }

    fn cosine(self) -> Self {
        libm::cosf(self)
    }

    fn arc_tangent(self, x: Self) -> Self {
        libm::atan2f(self, x)
    }

    fn binary_power(self) -> Self {
        libm::exp2f(self)
    }
}

impl Number for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn binary_logarithm(self) -> Self {
        libm::log2(self)
    }

    fn sine(self) -> Self {
        libm::sin(self)
    }

    fn cosine(self) -> Self {
        libm::cos(self)
    }

    fn arc_tangent(self, x: Self) -> Self {
        libm::atan2(self, x)
    }

    fn binary_power(self) -> Self {
        libm::exp2(self)
    }
}

/// D = log₂ of the longer side of a footprint, in texels of an image of this size: `footprint` holds the derivatives of
/// (u, v) along x and along y of the picture.
pub fn level<T: Number>(size: [u32; 2], footprint: [[T; 2]; 2]) -> T {
    let [width, height] = size.map(|side| T::from_f64(side.into()));
    let [x, y] = footprint.map(|[u, v]| (u * width) * (u * width) + (v * height) * (v * height));
    T::from_f64(0.5) * x.max(y).binary_logarithm()
}

/// The value of an image at a point, by its [`Sampling`]; `footprint` as in [`level`].
pub fn filtered<T: Number>(pyramid: &Pyramid, sampling: &Sampling, uv: [T; 2], footprint: [[T; 2]; 2]) -> [T; 4] {
    if sampling.levels == sampling.levels.by_level() {
        return at_level(pyramid, sampling, uv, level(pyramid.size(), footprint));
    }
    let shape = FootprintShape::new(pyramid.size(), footprint);
    let uv = uv.map(finite);
    if !shape.is_bounded() {
        return at_level(pyramid, sampling, uv, level(pyramid.size(), footprint));
    }
    if shape.long <= T::one() {
        return in_level(pyramid, 0, sampling.wrap, sampling.magnify, uv);
    }
    match sampling.levels {
        LevelFilter::Ripmap => axes::in_ripmap(pyramid.ripmap(), *sampling, uv, &shape),
        LevelFilter::SummedArea => axes::mean(pyramid.summed_areas(), pyramid.size(), sampling.wrap, uv, &shape),
        LevelFilter::Elliptical => ellipse::mean(pyramid, sampling.wrap, uv, &shape),
        filter => probes::mean(pyramid, *sampling, uv, &shape, filter.most_probes().unwrap_or(1)),
    }
}

/// The value at a point of level D; filters by the footprint's shape become [`LevelFilter::Linear`].
pub fn at_level<T: Number>(pyramid: &Pyramid, sampling: &Sampling, uv: [T; 2], d: T) -> [T; 4] {
    let Sampling { wrap, magnify, minify, levels } = *sampling;
    let uv = uv.map(finite);
    let last = T::from_f64((pyramid.levels().len() - 1) as f64);
    // NaN magnifies.
    if d.is_nan() || d <= T::zero() {
        return in_level(pyramid, 0, wrap, magnify, uv);
    }
    let number = |d: T| d.to_usize().unwrap_or_default();
    match levels.by_level() {
        LevelFilter::None => in_level(pyramid, 0, wrap, minify, uv),
        LevelFilter::Nearest => in_level(pyramid, number((d + T::from_f64(0.5)).floor().min(last)), wrap, minify, uv),
        _ => between_levels(pyramid, wrap, minify, uv, d),
    }
}

/// Interpolates the two levels around D; the first level if D ≤ 0.
fn between_levels<T: Number>(pyramid: &Pyramid, wrap: [Wrap; 2], filter: TexelFilter, uv: [T; 2], d: T) -> [T; 4] {
    between(pyramid.levels().len(), d, |level| in_level(pyramid, level, wrap, filter, uv))
}

/// Interpolates the values of two of so many levels around D.
pub(crate) fn between<T: Number, const N: usize>(levels: usize, d: T, level: impl Fn(usize) -> [T; N]) -> [T; N] {
    // `max` drops NaN.
    let d = d.max(T::zero()).min(T::from_f64((levels - 1) as f64));
    let (finer, part) = (d.floor(), d - d.floor());
    let finer = finer.to_usize().unwrap_or_default();
    let a = level(finer);
    if part == T::zero() { a } else { mixed(a, level(finer + 1), part) }
}

fn finite<T: Number>(x: T) -> T {
    if x.is_finite() { x } else { T::zero() }
}

/// Linear interpolation from `a` to `b`.
fn mixed<T: Number, const N: usize>(a: [T; N], b: [T; N], part: T) -> [T; N] {
    std::array::from_fn(|channel| a[channel] + part * (b[channel] - a[channel]))
}

/// The bilinear mean of four texels, numbered 0 and 1 along each axis, by the fractions of the way from 0 to 1.
pub(crate) fn mean_of_four<T: Number, const N: usize>(parts: [T; 2], texel: impl Fn([usize; 2]) -> [T; N]) -> [T; N] {
    let row = |j: usize| mixed(texel([0, j]), texel([1, j]), parts[0]);
    mixed(row(0), row(1), parts[1])
}

/// The derivatives of one channel along u and along v at a point of level D, per unit of u and v: the difference half a
/// texel of the level to either side. In one level and with a bilinear filter that is the derivative of the quadratic
/// B-spline through the texels, which is continuous.
pub fn gradient<T: Number>(pyramid: &Pyramid, sampling: &Sampling, uv: [T; 2], d: T, channel: Channel) -> [T; 2] {
    let reduced = sampling.levels != LevelFilter::None && d > T::zero();
    let last = T::from_f64((pyramid.levels().len() - 1) as f64);
    let texel = if reduced { d.min(last).binary_power() } else { T::one() };
    let number = |uv: [T; 2]| at_level(pyramid, sampling, uv, d)[channel as usize];
    let sides = pyramid.size();
    std::array::from_fn(|axis| {
        let across = texel / T::from_f64(sides[axis].into());
        let half = |sign: f64| {
            let mut there = uv;
            there[axis] = there[axis] + T::from_f64(sign) * across;
            number(there)
        };
        (half(0.5) - half(-0.5)) / across
    })
}

/// The value of one level at a point.
pub fn in_level<T: Number>(
    pyramid: &Pyramid,
    level: usize,
    wrap: [Wrap; 2],
    filter: TexelFilter,
    uv: [T; 2],
) -> [T; 4] {
    let Level { width, height, .. } = pyramid.levels()[level];
    in_image(pyramid.level(level), [width, height], wrap, filter, uv)
}

/// The value of texels that are not a level of a pyramid.
fn in_image<T: Number>(
    texels: &[[f32; 4]],
    [width, height]: [u32; 2],
    wrap: [Wrap; 2],
    filter: TexelFilter,
    uv: [T; 2],
) -> [T; 4] {
    let columns = taps(filter, wrap[0], uv[0], width);
    let rows = taps(filter, wrap[1], uv[1], height);
    let mut sum = [T::zero(); 4];
    for (y, of_row) in rows.iter() {
        for (x, of_column) in columns.iter() {
            let texel = texels[y * width as usize + x];
            for (sum, number) in sum.iter_mut().zip(texel) {
                *sum = *sum + of_row * of_column * T::from_f64(number.into());
            }
        }
    }
    sum
}

/// The texels along an axis that a filter reads, and their weights.
struct Taps<T> {
    each: [(usize, T); 4],
    count: usize,
}

impl<T: Copy> Taps<T> {
    fn iter(&self) -> impl Iterator<Item = (usize, T)> + '_ {
        self.each[..self.count].iter().copied()
    }
}

fn taps<T: Number>(filter: TexelFilter, wrap: Wrap, u: T, side: u32) -> Taps<T> {
    let texels = wrapped(wrap, u, T::from_f64(side.into()));
    if filter == TexelFilter::Nearest {
        let at = wrapped_index(Wrap::Clamp, texels.floor().to_i64().unwrap_or(0), side);
        return Taps { each: [(at, T::one()); 4], count: 1 };
    }
    let x = texels - T::from_f64(0.5);
    let (first, f) = (x.floor().to_i64().unwrap_or(0), x - x.floor());
    let (weights, count) = weights(filter, f);
    let first = if count == 2 { first } else { first - 1 };
    let each = std::array::from_fn(|k| (wrapped_index(wrap, first + k as i64, side), weights[k]));
    Taps { each, count }
}

/// The weights of the texels around a point at the fraction `f` between two, and how many there are.
fn weights<T: Number>(filter: TexelFilter, f: T) -> ([T; 4], usize) {
    let cubic = |[c3, c2, c1, c0]: [f64; 4]| {
        ((T::from_f64(c3) * f + T::from_f64(c2)) * f + T::from_f64(c1)) * f + T::from_f64(c0)
    };
    let sixth = |c: [f64; 4]| cubic(c) / T::from_f64(6.0);
    let half = |c: [f64; 4]| cubic(c) * T::from_f64(0.5);
    match filter {
        TexelFilter::Nearest => ([T::one(), T::zero(), T::zero(), T::zero()], 1),
        TexelFilter::Bilinear => ([T::one() - f, f, T::zero(), T::zero()], 2),
        TexelFilter::BSpline => {
            let of = [[-1.0, 3.0, -3.0, 1.0], [3.0, -6.0, 0.0, 4.0], [-3.0, 3.0, 3.0, 1.0], [1.0, 0.0, 0.0, 0.0]];
            (of.map(sixth), 4)
        }
        TexelFilter::CatmullRom => {
            let of = [[-1.0, 2.0, -1.0, 0.0], [3.0, -5.0, 0.0, 2.0], [-3.0, 4.0, 1.0, 0.0], [1.0, -1.0, 0.0, 0.0]];
            (of.map(half), 4)
        }
    }
}

/// A coordinate in texels, wrapped into the image, or clamped to within two texels of it, the reach of filters.
fn wrapped<T: Number>(wrap: Wrap, u: T, side: T) -> T {
    let (one, two) = (T::one(), T::from_f64(2.0));
    match wrap {
        Wrap::Repeat => (u - u.floor()) * side,
        Wrap::Mirror => {
            let there_and_back = u - two * (u / two).floor();
            side * if there_and_back > one { two - there_and_back } else { there_and_back }
        }
        Wrap::Clamp => (u * side).max(-two).min(side + two),
    }
}

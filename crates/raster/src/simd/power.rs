//! Powers of cosines, from polynomials of our own, so that no library decides their last bits.

use crate::simd::lanes::{F, I, Simd, fma, max, min, saturate, splat, splat_i};
use fearless_simd::prelude::*;

/// log₂ x for x from 10⁻³⁸ to 10³⁸, with a relative error below 3·10⁻⁷, also near 1.
#[inline(always)]
pub(crate) fn log2<S: Simd>(simd: S, x: F<S>) -> F<S> {
    // x = 2^k·m with m from √½ to √2.
    let bits: I<S> = x.bitcast();
    let shifted = bits - splat_i(simd, 0x3f35_04f3);
    let k = shifted >> 23;
    let m: F<S> = (bits - (k << 23)).bitcast();
    // log₂ m = 2/ln 2 · artanh s with s = (m − 1)/(m + 1), |s| < 0.172: the series to s⁹ leaves 2·10⁻⁹.
    let one = splat(simd, 1.0);
    let s = (m - one) / (m + one);
    let square = s * s;
    let mut series = splat(simd, ARTANH[0]);
    for c in &ARTANH[1..] {
        series = fma::<S>(series, square, splat(simd, *c));
    }
    let log_m = s * series;
    k.to_float::<F<S>>() + log_m
}

/// 2/ln 2 over 9, 7, 5, 3 and 1.
const ARTANH: [f32; 5] = {
    const TWICE: f64 = 2.0 * std::f64::consts::LOG2_E;
    [(TWICE / 9.0) as f32, (TWICE / 7.0) as f32, (TWICE / 5.0) as f32, (TWICE / 3.0) as f32, TWICE as f32]
};

/// 2^y for y from −126 to 127 (lower values count as −126), with a relative error below 2·10⁻⁷.
#[inline(always)]
pub(crate) fn exp2<S: Simd>(simd: S, y: F<S>) -> F<S> {
    let y = min::<S>(max::<S>(y, splat(simd, -126.0)), splat(simd, 127.0));
    let k = y.round_ties_even();
    // The series of e^t for |t| ≤ ½·ln 2, to t⁷, leaves 6·10⁻⁹.
    let t = (y - k) * splat(simd, std::f32::consts::LN_2);
    let mut series = splat(simd, 1.0 / 5040.0);
    for c in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        series = fma::<S>(series, t, splat(simd, c));
    }
    let power: F<S> = ((k.to_int::<I<S>>() + splat_i(simd, 127)) << 23).bitcast();
    series * power
}

/// An exponent of cosines, 0 or more, the same for all lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exponent {
    /// 2 to this power, computed by this number of squarings.
    Squarings(u32),
    /// Any other.
    Any(f32),
}

impl Exponent {
    pub(crate) fn new(exponent: f32) -> Self {
        let whole = exponent as u32;
        if whole.is_power_of_two() && whole <= 4096 && exponent.fract() == 0.0 {
            Self::Squarings(whole.trailing_zeros())
        } else {
            Self::Any(exponent)
        }
    }

    /// The exponent that x² takes instead of x.
    pub(crate) fn halved(self) -> Self {
        match self {
            Self::Squarings(0) => Self::Any(0.5),
            Self::Squarings(squarings) => Self::Squarings(squarings - 1),
            Self::Any(exponent) => Self::Any(0.5 * exponent),
        }
    }
}

/// An exponent for all lanes, or one for each.
#[derive(Clone, Copy)]
pub(crate) enum Power<S: Simd> {
    One(Exponent),
    Each(F<S>),
}

impl<S: Simd> Power<S> {
    /// `max(x, 0)` raised to it.
    #[inline(always)]
    pub(crate) fn raise(self, simd: S, x: F<S>) -> F<S> {
        match self {
            Self::One(exponent) => power(simd, x, exponent),
            Self::Each(exponents) => powers(simd, x, exponents),
        }
    }
}

/// `max(x, 0)^exponent` for x up to 1, with 0⁰ = 1, of an exponent a lane, 0 or more.
#[inline(always)]
fn powers<S: Simd>(simd: S, x: F<S>, exponents: F<S>) -> F<S> {
    let (x, zero) = (saturate(simd, x), splat(simd, 0.0));
    let y = log2(simd, max::<S>(x, splat(simd, f32::MIN_POSITIVE))) * exponents;
    let vanishes = y.simd_lt(splat(simd, -126.0)) | x.simd_le(zero);
    exponents.simd_le(zero).select(splat(simd, 1.0), vanishes.select(zero, exp2(simd, y)))
}

/// `max(x, 0)^exponent` for x up to 1, with 0⁰ = 1.
#[inline(always)]
pub(crate) fn power<S: Simd>(simd: S, x: F<S>, exponent: Exponent) -> F<S> {
    let x = saturate(simd, x);
    match exponent {
        Exponent::Squarings(squarings) => {
            let mut result = x;
            for _ in 0..squarings {
                result = result * result;
            }
            result
        }
        Exponent::Any(0.0) => splat(simd, 1.0),
        Exponent::Any(exponent) => {
            let zero = splat(simd, 0.0);
            let y = log2(simd, max::<S>(x, splat(simd, f32::MIN_POSITIVE))) * splat(simd, exponent);
            let vanishes = y.simd_lt(splat(simd, -126.0)) | x.simd_le(zero);
            vanishes.select(zero, exp2(simd, y))
        }
    }
}

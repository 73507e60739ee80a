//! Powers on vectors, to a few millionths: for bounds from above and below. The exact ones take half of the time of a
//! bound.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8};

/// How far [`power`] is off at most, relative to itself. For y = `e`·log₂ x from −126 to 0 that is |y|·ln 2 times the
/// error of the logarithm and of the product, 4·10⁻⁷, and that of [`exp2`]; twice as much as was found.
pub(super) const POWER_ERROR: f32 = 8e-5;

/// `x` to the power of `e` for x from the smallest normal number to 1 and e of 0 or more; what is below 2⁻¹²⁶ is taken
/// as that.
#[inline(always)]
pub(super) fn power<S: Simd>(simd: S, x: f32x8<S>, e: f32) -> f32x8<S> {
    exp2(simd, log2(simd, x) * f32x8::splat(simd, e))
}

/// log₂ x, also near 1 with a small relative error.
#[inline(always)]
fn log2<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    // x = 2^k·m with m from √½ to √2.
    let bits: i32x8<S> = x.bitcast();
    let k = (bits - i32x8::splat(simd, 0x3f35_04f3)) >> 23;
    let m: f32x8<S> = (bits - (k << 23)).bitcast();
    // log₂ m = 2/ln 2 · artanh s with s = (m − 1)/(m + 1), |s| < 0.172: the series to s⁹ leaves 2·10⁻⁹.
    let one = f32x8::splat(simd, 1.0);
    let s = (m - one) / (m + one);
    let square = s * s;
    let mut series = f32x8::splat(simd, ARTANH[0]);
    for c in &ARTANH[1..] {
        series = series * square + f32x8::splat(simd, *c);
    }
    k.to_float::<f32x8<S>>() + s * series
}

/// 2/ln 2 over 9, 7, 5, 3 and 1.
const ARTANH: [f32; 5] = {
    const TWICE: f64 = 2.0 * core::f64::consts::LOG2_E;
    [(TWICE / 9.0) as f32, (TWICE / 7.0) as f32, (TWICE / 5.0) as f32, (TWICE / 3.0) as f32, TWICE as f32]
};

/// 2^y for y up to 0; what is below −126 is taken as that.
#[inline(always)]
fn exp2<S: Simd>(simd: S, y: f32x8<S>) -> f32x8<S> {
    let y = SimdBase::max(y, f32x8::splat(simd, -126.0));
    let k = y.round_ties_even();
    // The series of e^t for |t| ≤ ½·ln 2, to t⁷, leaves 6·10⁻⁹.
    let t = (y - k) * f32x8::splat(simd, core::f32::consts::LN_2);
    let mut series = f32x8::splat(simd, 1.0 / 5040.0);
    for c in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        series = series * t + f32x8::splat(simd, c);
    }
    let power: f32x8<S> = ((k.to_int::<i32x8<S>>() + i32x8::splat(simd, 127)) << 23).bitcast();
    series * power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::chunk::CHUNK;
    use fearless_simd::{Level, dispatch};

    fn powers(x: [f32; CHUNK], e: f32) -> [f32; CHUNK] {
        let mut found = [0.0; CHUNK];
        dispatch!(Level::new(), simd => power(simd, f32x8::from_slice(simd, &x), e).store_slice(&mut found));
        found
    }

    /// Every 64th number up to 1, and every number near 1, for exponents of all sizes.
    #[test]
    fn a_power_is_off_by_no_more_than_is_said() {
        let mut largest = 0.0f64;
        for e in [1e-3f32, 0.3, 1.0, 2.5, 27.8974, 32.0, 100.5, 1000.3, 65536.0, 1e7] {
            let near_1 = 1.0f32.to_bits() - 4096..=1.0f32.to_bits();
            let all = (f32::MIN_POSITIVE.to_bits()..1.0f32.to_bits()).step_by(4099);
            let bits: Vec<u32> = all.chain(near_1).collect();
            for bits in bits.as_chunks::<CHUNK>().0 {
                let x = bits.map(f32::from_bits);
                for (x, found) in x.into_iter().zip(powers(x, e)) {
                    let exact = f64::from(x).powf(f64::from(e)).max(f64::from(f32::MIN_POSITIVE));
                    largest = largest.max((f64::from(found) / exact - 1.0).abs());
                }
            }
        }
        println!("off by {largest:.1e}");
        assert!(largest <= 0.5 * f64::from(POWER_ERROR), "off by {largest:e}");
    }
}

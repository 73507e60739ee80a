//! Powers to a ten-thousandth, in a fifth of the time of exact ones: for bounds.

use crate::equations::Real;

/// How far [`quick_power`] is off at most, relative to itself; as much as was found.
const OFF: f32 = 1e-4;

/// What `max(x, 0)` to the power of `e`, 0 or more, is at least and at most, for x up to 1; what is below 2⁻¹²⁶ may
/// count as 0.
pub(super) fn power_within<T: Real>(x: T, e: T) -> [T; 2] {
    if e == T::zero() || x >= T::one() {
        return [T::one(); 2];
    }
    if x <= T::zero() {
        return [T::zero(); 2];
    }
    // Both types convert; 1 − 10⁻⁸ in f64 is 1 in f32, and nothing else is that much larger.
    let (near, e) = (x.to_f32().unwrap_or(1.0), e.to_f32().unwrap_or(0.0));
    let power = quick_power(near, e);
    let [least, most] = [T::of(f64::from(power * (1.0 - OFF))), T::of(f64::from((power * (1.0 + OFF)).min(1.0)))];
    if power > f32::MIN_POSITIVE { [least, most] } else { [T::zero(), most] }
}

/// `x`ᵉ for x above 0 and up to 1.
fn quick_power(x: f32, e: f32) -> f32 {
    // x = 2ᵏ·m with m from √½ to √2, and log₂ m = 2/ln 2·artanh s with s = (m − 1)/(m + 1): the series to s⁹.
    let bits = x.max(f32::MIN_POSITIVE).to_bits() as i32;
    let k = (bits - 0x3f35_04f3) >> 23;
    let m = f32::from_bits((bits - (k << 23)) as u32);
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let twice = 2.0 * core::f64::consts::LOG2_E;
    let series = [twice / 9.0, twice / 7.0, twice / 5.0, twice / 3.0, twice];
    let series = series.into_iter().fold(0.0, |sum, c| sum * square + c as f32);
    // 2ʸ = 2ᵏ·eᵗ with t from −½·ln 2 to ½·ln 2: the series to t⁶.
    let y = ((k as f32 + s * series) * e).max(-126.0);
    let k = (y - 0.5) as i32;
    let t = (y - k as f32) * core::f32::consts::LN_2;
    let series = [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    let series = series.into_iter().fold(0.0, |sum, c: f32| sum * t + c);
    f32::from_bits(((k + 127) << 23) as u32) * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "the ends are exact")]
    fn powers_lie_between_what_is_said() {
        for e in [1e-3f32, 0.3, 1.0, 2.5, 27.8974, 32.0, 100.5, 1000.3, 65536.0, 1e7] {
            let near_1 = 1.0f32.to_bits() - 4096..=1.0f32.to_bits();
            let all = (f32::MIN_POSITIVE.to_bits()..1.0f32.to_bits()).step_by(4099);
            for x in all.chain(near_1).map(f32::from_bits) {
                let exact = f64::from(x).powf(f64::from(e));
                let [least, most] = power_within(x, e).map(f64::from);
                assert!(
                    least <= exact && exact <= most.max(f64::from(f32::MIN_POSITIVE)),
                    "{x:e}^{e}: {exact:e} {most:e}"
                );
                assert!(exact < 1e-37 || most - least <= 2.1 * f64::from(OFF) * exact, "{x:e}^{e}");
            }
        }
        assert_eq!(power_within(0.0, 0.0), [1.0; 2]);
        assert_eq!(power_within(-0.5, 3.0), [0.0; 2]);
        assert_eq!(power_within(1.5, 3.0), [1.0; 2]);
    }
}

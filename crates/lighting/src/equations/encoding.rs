//! The curve of 8-bit pictures.

use super::Real;

/// The sRGB curve (IEC 61966-2-1) of one channel in [0, 1]: 12.92·I up to 0.0031308, then 1.055·I^(1/2.4) − 0.055; 1 is
/// reached exactly.
pub fn srgb_encoded<T: Real>(linear: T) -> T {
    if linear <= T::from_f64(0.003_130_8) {
        T::from_f64(12.92) * linear
    } else {
        T::from_f64(1.055) * linear.pow(T::from_f64(1.0 / 2.4)) - T::from_f64(0.055)
    }
}

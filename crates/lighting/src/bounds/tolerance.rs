//! From a difference that nobody sees to the intensity that makes it.

use crate::Encoding;

/// A step of an 8-bit picture: 1/255 of white.
pub const STEP: f64 = 1.0 / 255.0;

/// The largest ΔI, in linear intensity, that changes a channel by at most `tolerance` in `encoding`, where the channel
/// keeps at least the intensity `at_least` without it: emission and ambient, say; 0 where nothing is known.
///
/// The sRGB curve f is concave, so f(I + ΔI) − f(I) is largest at the smallest I, and ΔI = f⁻¹(f(I) + tolerance) − I
/// there. With nothing known that is tolerance/12.92 for sRGB (up to a tolerance of 0.04, where the curve's straight
/// part ends) and the tolerance itself for raw pictures.
///
/// Infinite where the channel reaches white without more light, since the picture is clamped there: not for
/// floating-point pictures. A tolerance of 0 or less gives 0.
pub fn linear_tolerance(encoding: Encoding, tolerance: f64, at_least: f64) -> f64 {
    let (known, tolerance) = (at_least.max(0.0), tolerance.max(0.0));
    if tolerance == 0.0 {
        return 0.0;
    }
    if known >= 1.0 {
        return f64::INFINITY;
    }
    let brighter = encoding.encode(known) + tolerance;
    if brighter > 1.0 { f64::INFINITY } else { (encoding.decode(brighter) - known).max(0.0) }
}

//! How much of a light arrives at a point: distance, range and cone.

use super::{Real, power};

/// The largest attenuation: `1 / (a + b·d + c·d²)` is capped here, so that a light without a constant term stays finite
/// at d = 0. It matters only within the distance at which the divisor falls below 10⁻⁶: a thousandth of a world unit
/// for an inverse-square light.
pub const ATTENUATION_MAX: f32 = 1e6;

/// A cone, ready for evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeTerms<T> {
    /// The way the light travels along the axis, unit length, in the space of the evaluation.
    pub direction: [T; 3],
    /// cos(cutoff). Differences below the resolution of `T` near 1 are lost: in `f32` a cutoff under 2.4e-4 rad is 0.
    pub cos_cutoff: T,
    /// cos(inner), where an inner cone is given.
    pub cos_inner: Option<T>,
    /// e, 0 or more.
    pub exponent: T,
}

/// `1 / max(a + b·d + c·d², 10⁻⁶)` for the constants `[a, b, c]` and the distance d, all 0 or more.
///
/// With a = 0 and d = 0 it is [`ATTENUATION_MAX`]. Where the divisor overflows it is 0.
pub fn attenuation<T: Real>([a, b, c]: [T; 3], d: T) -> T {
    // Horner's form, and a finite d, keep 0·∞ out: with c = 0 and a huge d, c·d² would be NaN.
    let d = d.min(T::max_value());
    (a + d * (b + c * d)).max(T::of(f64::from(ATTENUATION_MAX)).recip()).recip()
}

/// `clamp(1 − (d/R)⁴, 0, 1)²` for a distance d and a range R > 0 (`KHR_lights_punctual`).
pub fn range_window<T: Real>(d: T, range: T) -> T {
    let ratio = d / range;
    let square = ratio * ratio;
    let window = (T::one() - square * square).max(T::zero()).min(T::one());
    window * window
}

/// `max(cos φ, 0)^e` inside the cone and 0 outside, where `cos_phi` is the cosine of the angle between the axis and the
/// ray to the lit point; OpenGL 2.1 §2.14.1.
///
/// Where an inner cone is given the factor is also multiplied by s² (`KHR_lights_punctual`): s is 1 inside the inner
/// cone and (cos φ − cos cutoff) / (cos inner − cos cutoff) between the two. There cos φ lies below cos inner, so the
/// divisor is above 0, and an inner cone equal to the cutoff is a hard edge. (The extension's sample code bounds the
/// divisor by 10⁻³ instead, which would dim a cone narrower than 2.5° even on its axis.)
pub fn spot_factor<T: Real>(cos_phi: T, cone: &ConeTerms<T>) -> T {
    if cos_phi < cone.cos_cutoff {
        return T::zero();
    }
    let factor = power(cos_phi, cone.exponent);
    match cone.cos_inner {
        Some(cos_inner) if cos_phi < cos_inner => {
            let s = (cos_phi - cone.cos_cutoff) / (cos_inner - cone.cos_cutoff);
            factor * s * s
        }
        _ => factor,
    }
}

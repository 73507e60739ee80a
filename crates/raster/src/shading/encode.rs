//! Encodes linear intensities as the values of pixels.

use crate::input::pass::PixelFormat;
use crate::simd::lanes::{F, I, Simd, V3, each, fma, max, min, saturate, splat, splat_i, splat3};
use fearless_simd::prelude::*;

/// The sRGB curve (IEC 61966-2-1) of a clamped intensity. Its upper part, 1.055·I^(1/2.4) − 0.055, is a polynomial of
/// the fifth degree in ⁴√I, fitted for the least greatest error: 6.8·10⁻⁶, a 600th of an 8-bit step.
#[inline(always)]
pub(crate) fn srgb_encoded<S: Simd>(simd: S, intensity: F<S>) -> F<S> {
    let linear = saturate(simd, intensity);
    let q = linear.sqrt().sqrt();
    let mut curved = splat(simd, -0.068_147_21);
    for c in [0.289_532_71, -0.577_482_37, 1.255_404_2, 0.162_026_32, -0.061_340_22] {
        curved = fma::<S>(q, curved, splat(simd, c));
    }
    linear.simd_le(splat(simd, 0.003_130_8)).select(linear * splat(simd, 12.92), curved)
}

/// Four bytes a lane, in memory: red, green, blue and 255.
#[inline(always)]
pub(crate) fn bytes<S: Simd>(simd: S, color: V3<S>, format: PixelFormat) -> I<S> {
    let [red, green, blue] = each!(c in 3 => byte(simd, color[c], format));
    if cfg!(target_endian = "big") {
        (red << 24) | (green << 16) | (blue << 8) | splat_i(simd, 0xff)
    } else {
        red | (green << 8) | (blue << 16) | splat_i(simd, 0xff << 24)
    }
}

#[inline(always)]
fn byte<S: Simd>(simd: S, x: F<S>, format: PixelFormat) -> I<S> {
    let share = if format == PixelFormat::SrgbBytes { srgb_encoded(simd, x) } else { saturate(simd, x) };
    fma::<S>(share, splat(simd, 255.0), splat(simd, 0.5)).to_int()
}

/// The part of a color that the target keeps: 0 to 1 for bytes, anything from 0 for floats.
#[inline(always)]
pub(crate) fn kept<S: Simd>(simd: S, color: V3<S>, format: PixelFormat) -> V3<S> {
    match format {
        PixelFormat::Floats => {
            let most = splat(simd, f32::MAX);
            each!(c in 3 => min::<S>(max::<S>(color[c], splat(simd, 0.0)), most))
        }
        _ => each!(c in 3 => saturate(simd, color[c])),
    }
}

/// The clear color as the target keeps it.
#[inline(always)]
pub(crate) fn cleared<S: Simd>(simd: S, clear: [f32; 3], format: PixelFormat) -> V3<S> {
    kept(simd, splat3(simd, clear), format)
}

//! Policies for a finished picture whose intensities exceed 1: one divisor for all of it, or a curve a channel.

use super::Real;

/// The largest argument of [`aces`], which reaches 1 at 7.25. More would overflow its squares.
pub const ACES_WHITE: f32 = 8.0;

/// The divisor of a picture whose largest channel is `largest`: that, where it exceeds 1. Of the divisor of the
/// frame `before`, `smoothing` is kept.
pub fn divisor<T: Real>(largest: T, before: T, smoothing: T) -> T {
    let plain = if largest > T::from_f64(1.0) { largest } else { T::from_f64(1.0) };
    plain + smoothing * (before - plain)
}

/// The extended curve of Reinhard, Stark, Shirley and Ferwerda (2002, equation 4) of one channel:
/// I·(1 + I/w²)/(1 + I), which takes the white point w to 1. `per_white` is 1/w²; 0 is the curve without a white point.
pub fn reinhard<T: Real>(i: T, per_white: T) -> T {
    // The quotient first: it is below 1, so that nothing overflows that the result does not.
    i / (T::from_f64(1.0) + i) * (T::from_f64(1.0) + i * per_white)
}

/// The filmic curve that Narkowicz (2015) fitted to that of the Academy Color Encoding System, of one channel:
/// I·(2.51·I + 0.03)/(I·(2.43·I + 0.59) + 0.14), at most 1.
pub fn aces<T: Real>(i: T) -> T {
    let white = T::from_f64(f64::from(ACES_WHITE));
    let i = if i < white { i } else { white };
    let curve = i * (T::from_f64(2.51) * i + T::from_f64(0.03))
        / (i * (T::from_f64(2.43) * i + T::from_f64(0.59)) + T::from_f64(0.14));
    if curve < T::from_f64(1.0) { curve } else { T::from_f64(1.0) }
}

//! Policies for finished pictures whose intensities exceed 1.

use crate::error::RasterError;
use crate::input::pass::{Output, PixelFormat};
use crate::rasterizer::Rasterizer;
use crate::shading::encode::srgb_encoded;
use crate::simd::lanes::{F, MOST_LANES, Simd, fma, lanes, load, max, max_one, min, saturate, splat, store};
use crate::simd::width::with_vectors;
use halfway_lighting::Intensity;
use halfway_lighting::equations::{ACES_WHITE, divisor};
use std::sync::atomic::{AtomicU32, Ordering};

/// The curve of a channel.
#[derive(Clone, Copy, Debug)]
enum ToneCurve {
    DividedBy(f32),
    /// 1 over the square of the white point.
    Reinhard(f32),
    Aces,
}

/// Values of a pixel.
const CHANNELS: usize = 4;
/// Values that a thread processes at once; a multiple of every width of vectors.
const PART: usize = CHANNELS * 16 * 1024;

impl Rasterizer {
    /// Applies a policy that acts on the finished picture to the output of a pass of [`PixelFormat::Floats`]; `format`
    /// is the output's. Returns the divisor under [`Intensity::Renormalize`], whose smoothing applies if the divisor of
    /// the picture `before` is given.
    ///
    /// # Errors
    /// [`RasterError::Finish`] where the lengths differ, or the format is not the output's; [`RasterError::Policy`] for
    /// a policy with a number out of its range, or [`Intensity::Clamp`], which acts on no finished picture.
    pub fn finish(
        &self,
        drawn: &[f32],
        policy: Intensity,
        before: Option<f32>,
        output: Output,
        format: PixelFormat,
    ) -> Result<Option<f32>, RasterError> {
        let (found, fits) = match &output {
            Output::Bytes(bytes) => (bytes.len(), format.is_bytes()),
            Output::Floats(floats) => (floats.len(), !format.is_bytes()),
        };
        if found != drawn.len() || !drawn.len().is_multiple_of(CHANNELS) || !fits {
            return Err(RasterError::Finish { expected: drawn.len(), found });
        }
        policy.validate().map_err(|error| RasterError::Policy { reason: error.to_string() })?;
        let (curve, by) = match policy {
            Intensity::Renormalize { smoothing } => {
                let by = divisor(self.largest(drawn), before.unwrap_or(1.0), before.map_or(0.0, |_| smoothing));
                (ToneCurve::DividedBy(by), Some(by))
            }
            // A number that underflows is a white point that no picture reaches.
            Intensity::Reinhard { white } => (ToneCurve::Reinhard(f64::from(white).powi(-2) as f32), None),
            Intensity::Aces => (ToneCurve::Aces, None),
            other => return Err(RasterError::Policy { reason: format!("{other:?} acts on each surface") }),
        };
        let level = self.level();
        let parts = drawn.chunks(PART);
        match output {
            Output::Floats(floats) => self.each(parts.zip(floats.chunks_mut(PART)), |(from, to)| {
                with_vectors!(level, simd => simd.vectorize(#[inline(always)] || finish_floats(simd, curve, from, to)));
            }),
            Output::Bytes(bytes) => self.each(parts.zip(bytes.chunks_mut(PART)), |(from, to)| {
                let as_srgb = format == PixelFormat::SrgbBytes;
                with_vectors!(level, simd => simd.vectorize(#[inline(always)] || finish_bytes(simd, curve, as_srgb, from, to)));
            }),
        }
        Ok(by)
    }

    /// The largest channel.
    fn largest(&self, drawn: &[f32]) -> f32 {
        // Non-negative floats sort as their bits do.
        let found = AtomicU32::new(0);
        let level = self.level();
        self.each(drawn.chunks(PART), |part| {
            let of_part = with_vectors!(level, simd => simd.vectorize(#[inline(always)] || largest(simd, part)));
            found.fetch_max(of_part.to_bits(), Ordering::Relaxed);
        });
        f32::from_bits(found.into_inner())
    }
}

/// The largest value. Alpha is 1, below which nothing is divided.
#[inline(always)]
fn largest<S: Simd>(simd: S, values: &[f32]) -> f32 {
    let mut found = [0.0; MOST_LANES];
    for values in values.chunks(MOST_LANES) {
        each_vector(simd, values, &mut found, |value, found| max::<S>(value, found));
    }
    found.into_iter().fold(0.0, max_one)
}

#[inline(always)]
fn finish_floats<S: Simd>(simd: S, curve: ToneCurve, from: &[f32], to: &mut [f32]) {
    for (from, to) in from.chunks(MOST_LANES).zip(to.chunks_mut(MOST_LANES)) {
        let mut values = [0.0; MOST_LANES];
        each_vector(simd, from, &mut values, |i, _| toned(simd, curve, i));
        to.copy_from_slice(&values[..to.len()]);
        to.iter_mut().skip(3).step_by(CHANNELS).for_each(|alpha| *alpha = 1.0);
    }
}

#[inline(always)]
fn finish_bytes<S: Simd>(simd: S, curve: ToneCurve, as_srgb: bool, from: &[f32], to: &mut [u8]) {
    for (from, to) in from.chunks(MOST_LANES).zip(to.chunks_mut(MOST_LANES)) {
        let mut values = [0.0; MOST_LANES];
        each_vector(simd, from, &mut values, |i, _| {
            let i = toned(simd, curve, i);
            let share = if as_srgb { srgb_encoded(simd, i) } else { saturate(simd, i) };
            fma::<S>(share, splat(simd, 255.0), splat(simd, 0.5))
        });
        for (to, value) in to.iter_mut().zip(values) {
            *to = value as u8;
        }
        to.iter_mut().skip(3).step_by(CHANNELS).for_each(|alpha| *alpha = u8::MAX);
    }
}

/// Applies a function to up to [`MOST_LANES`] values, together with the current values of the output.
#[inline(always)]
fn each_vector<S: Simd>(simd: S, from: &[f32], to: &mut [f32; MOST_LANES], function: impl Fn(F<S>, F<S>) -> F<S>) {
    let mut values = [0.0; MOST_LANES];
    values[..from.len()].copy_from_slice(from);
    for at in (0..MOST_LANES).step_by(lanes::<S>()) {
        let result = function(load(simd, &values, at), load(simd, &to[..], at));
        store::<S>(result, to, at);
    }
}

#[inline(always)]
fn toned<S: Simd>(simd: S, curve: ToneCurve, i: F<S>) -> F<S> {
    let number = |x: f32| splat(simd, x);
    match curve {
        ToneCurve::DividedBy(divisor) => i / number(divisor),
        ToneCurve::Reinhard(per_white) => i / (number(1.0) + i) * fma::<S>(i, number(per_white), number(1.0)),
        ToneCurve::Aces => {
            // Beyond this the curve is constantly 1.
            let i = min::<S>(i, number(ACES_WHITE));
            let above = i * fma::<S>(i, number(2.51), number(0.03));
            let below = fma::<S>(i, fma::<S>(i, number(2.43), number(0.59)), number(0.14));
            min::<S>(above / below, number(1.0))
        }
    }
}

//! ꟻLIP: what a viewer would notice when two pictures alternate in one place.

use halfway_lighting::Encoding;
use image::RgbImage;

use super::comparison::{SizeMismatch, same_size};
use super::statistics::percentiles;
use crate::Image;

/// How many pixels there are to a degree of what the viewer sees: 67 is a display of 0.7 m width and 3840 pixels seen from
/// 0.7 m, the value that the method's authors recommend. A lower number is a viewer farther off.
pub const PIXELS_PER_DEGREE: f32 = nv_flip::DEFAULT_PIXELS_PER_DEGREE;

/// The perceived difference of two pictures, over all pixels: 0 where nothing is to be seen, 1 for black beside white.
///
/// Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating Images", 2020, for pictures of low dynamic range:
/// what counts is the bytes that a display shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    /// The mean, which is the figure to quote where one is wanted.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// The least value that [`PERCENTILES`](super::PERCENTILES) per cent of the pixels do not exceed.
    pub percentiles: [f64; 4],
}

/// Measures ꟻLIP at [`PIXELS_PER_DEGREE`]. Pixels without a number count as black.
///
/// # Errors
/// [`SizeMismatch`].
pub fn flip(actual: &Image, expected: &Image, encoding: Encoding) -> Result<Flip, SizeMismatch> {
    same_size(actual, expected)?;
    let (width, height) = actual.dimensions();
    if width == 0 || height == 0 {
        return Ok(Flip { mean: 0.0, max: 0.0, percentiles: [0.0; 4] });
    }
    let picture = |bytes: &RgbImage| nv_flip::FlipImageRgb8::with_data(width, height, bytes.as_raw());
    let [actual, expected] = [actual, expected].map(|image| picture(&image.to_bytes(encoding)));
    let map = nv_flip::flip(expected, actual, PIXELS_PER_DEGREE);
    let mut values: Vec<f64> = map.to_vec().into_iter().map(f64::from).collect();
    let percentiles = percentiles(&mut values);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    Ok(Flip { mean, max: values.last().copied().unwrap_or(0.0), percentiles })
}

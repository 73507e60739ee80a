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
    Ok(figures(map(actual, expected, encoding)?))
}

/// The same over the pixels that both pictures cover, where both know. The others are made equal first: an eye sees more
/// than one pixel at once, and would see them, too.
///
/// # Errors
/// [`SizeMismatch`].
pub fn flip_of_covered(actual: &Image, expected: &Image, encoding: Encoding) -> Result<Flip, SizeMismatch> {
    same_size(actual, expected)?;
    let Some((a, b)) = actual.covered().zip(expected.covered()) else { return flip(actual, expected, encoding) };
    let both: Vec<bool> = a.iter().zip(b).map(|(a, b)| *a && *b).collect();
    let own = both.iter().zip(actual.pixels().iter().zip(expected.pixels()));
    let alike = own.map(|(both, (own, other))| if *both { *own } else { *other }).collect();
    let (width, height) = actual.dimensions();
    let values = map(&Image::new(width, height, alike), expected, encoding)?;
    Ok(figures(values.into_iter().zip(both).filter(|(_, both)| *both).map(|(value, _)| value).collect()))
}

/// A value a pixel, row by row.
fn map(actual: &Image, expected: &Image, encoding: Encoding) -> Result<Vec<f64>, SizeMismatch> {
    same_size(actual, expected)?;
    let (width, height) = actual.dimensions();
    if width == 0 || height == 0 {
        return Ok(Vec::new());
    }
    let picture = |bytes: &RgbImage| nv_flip::FlipImageRgb8::with_data(width, height, bytes.as_raw());
    let [actual, expected] = [actual, expected].map(|image| picture(&image.to_bytes(encoding)));
    let map = nv_flip::flip(expected, actual, PIXELS_PER_DEGREE);
    Ok(map.to_vec().into_iter().map(f64::from).collect())
}

/// All 0 of none.
fn figures(mut values: Vec<f64>) -> Flip {
    let percentiles = percentiles(&mut values);
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    Flip { mean, max: values.last().copied().unwrap_or(0.0), percentiles }
}

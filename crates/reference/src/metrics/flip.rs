//! ꟻLIP: what a viewer would notice when two pictures alternate in one place.

use halfway_lighting::Encoding;

use super::bands::{BandPairs, PictureRows, SizeMismatch};
use super::comparison::same_size;
use super::ranks::{PERCENTILES, nearest_rank};
use crate::Image;

/// How many pixels there are to a degree of what the viewer sees: 67 is a display of 0.7 m width and 3840 pixels seen
/// from
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
pub fn flip(actual: &dyn PictureRows, expected: &dyn PictureRows, encoding: Encoding) -> Result<Flip, SizeMismatch> {
    Ok(figures(map(actual, expected, encoding)?))
}

/// The same over the pixels that both pictures cover, where both know. The others are made equal first: an eye sees
/// more than one pixel at once, and would see them, too.
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

/// Rows above and below a pixel, at least, that have part in its value: the method's filters reach three standard
/// deviations, at most 10 pixels at [`PIXELS_PER_DEGREE`].
const REACH: u32 = 16;

/// A value a pixel, row by row.
fn map(actual: &dyn PictureRows, expected: &dyn PictureRows, encoding: Encoding) -> Result<Vec<f32>, SizeMismatch> {
    /// About 0.5 GB of what the method keeps of each.
    const PIXELS: u32 = 1 << 22;
    Ok(map_by(&BandPairs::of(actual, expected)?, encoding, PIXELS))
}

fn map_by(bands: &BandPairs, encoding: Encoding, pixels: u32) -> Vec<f32> {
    let (width, height) = bands.size;
    let mut values = Vec::new();
    if width == 0 {
        return values;
    }
    for rows in bands.ranges(pixels) {
        let around = rows.start.saturating_sub(REACH)..height.min(rows.end.saturating_add(REACH));
        let band = bands.band(around.clone());
        let picture = |image: &Image| {
            let bytes = image.to_bytes(encoding);
            nv_flip::FlipImageRgb8::with_data(width, bytes.height(), bytes.as_raw())
        };
        let map = nv_flip::flip(picture(&band.expected), picture(&band.actual), PIXELS_PER_DEGREE).to_vec();
        let [first, end] = [rows.start, rows.end].map(|row| (row - around.start) as usize * width as usize);
        values.extend_from_slice(&map[first..end]);
    }
    values
}

/// All 0 of none.
fn figures(mut values: Vec<f32>) -> Flip {
    values.sort_unstable_by(f32::total_cmp);
    let at = |share| values.get(nearest_rank(values.len() as u64, share) as usize).copied().map_or(0.0, f64::from);
    let mean = values.iter().copied().map(f64::from).sum::<f64>() / values.len().max(1) as f64;
    Flip { mean, max: values.last().copied().map_or(0.0, f64::from), percentiles: PERCENTILES.map(at) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A seam would show if a band lacked a row that has part in its values.
    #[test]
    fn bands_give_what_the_whole_gives() {
        let (width, height) = (23, 97);
        let mut state = 1_u32;
        let mut noise = || {
            let pixels = (0..width * height).map(|_| {
                [0, 1, 2].map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    f64::from(state >> 8) / f64::from(1 << 24)
                })
            });
            Image::new(width, height, pixels.collect())
        };
        let (a, b) = (noise(), noise());
        let bands = BandPairs::of(&a, &b).unwrap();
        let whole = map_by(&bands, Encoding::Srgb, width * height);
        for rows in [1, 7, 48] {
            assert!(map_by(&bands, Encoding::Srgb, width * rows) == whole, "bands of {rows} rows");
        }
    }
}

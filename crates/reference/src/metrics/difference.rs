//! Where two pictures differ, as a picture.

use colorous::MAGMA;
use halfway_lighting::Encoding;
use image::{Rgb, RgbImage};

use super::canvas::{below_one_another, enlarged};
use super::comparison::{SizeMismatch, same_size, step};
use super::coverage::{Kind, pairs};
use super::legend::legend;
use super::statistics::percentile;
use crate::Image;

/// What a difference picture shows, and where its colours end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    /// What is shown. Default [`Unit::Steps`].
    pub unit: Unit,
    /// The error of the brightest colour, in the unit; what is larger has the same colour. `None`, the default, takes
    /// the first of 1, 2, 5, 10, 20 … (in linear intensity also 0.5, 0.2 …) that 99.9 % of the pixels do not exceed.
    pub upper: Option<f64>,
}

/// What the error of a pixel is: the largest of its three channels' errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Unit {
    /// In steps of 1/255, after both pictures are clamped, encoded and rounded to bytes.
    #[default]
    Steps,
    /// In linear intensity.
    Linear,
}

/// Where exactly one of the pictures covers the pixel. Neither colour is near one of the scale's.
pub(super) const COVERAGE: Rgb<u8> = Rgb([0, 220, 90]);
/// Where a picture holds no number.
pub(super) const NOT_FINITE: Rgb<u8> = Rgb([0, 200, 255]);

/// What the legend has to explain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    pub(super) unit: Unit,
    pub(super) upper: f64,
    /// Whether an error is larger than the scale.
    pub(super) beyond: bool,
    pub(super) coverage: bool,
    pub(super) not_finite: bool,
}

/// Draws the error of every pixel through the colour map "magma" (black is none, pale yellow the upper end), with a
/// legend below. Where the pictures differ in coverage the pixel is green, where either is not finite light blue. Small
/// pictures are enlarged, a whole number of times.
///
/// # Errors
/// [`SizeMismatch`].
pub fn difference(
    actual: &Image,
    expected: &Image,
    encoding: Encoding,
    scale: Scale,
) -> Result<RgbImage, SizeMismatch> {
    same_size(actual, expected)?;
    let errors = errors(actual, expected, encoding, scale.unit);
    let kinds: Vec<Kind> = pairs(actual, expected).map(|pair| pair.kind).collect();
    let upper = scale.upper.filter(|upper| *upper > 0.0).unwrap_or_else(|| upper(&errors, &kinds, scale.unit));
    let pixels = kinds.iter().zip(&errors).flat_map(|(kind, error)| match kind {
        Kind::OnlyActual | Kind::OnlyExpected => COVERAGE.0,
        Kind::NotFinite => NOT_FINITE.0,
        Kind::Counted | Kind::Background => colour(error / upper).0,
    });
    let (width, height) = actual.dimensions();
    let picture = RgbImage::from_raw(width, height, pixels.collect()).unwrap_or_default();
    let has = |wanted: &[Kind]| kinds.iter().any(|kind| wanted.contains(kind));
    let shown = Shown {
        unit: scale.unit,
        upper,
        beyond: kinds.iter().zip(&errors).any(|(kind, error)| kind.is_on_scale() && *error > upper),
        coverage: has(&[Kind::OnlyActual, Kind::OnlyExpected]),
        not_finite: has(&[Kind::NotFinite]),
    };
    let picture = enlarged(&picture);
    let legend = legend(picture.width(), shown);
    Ok(below_one_another(&[picture, legend], 0))
}

/// The colour of a share of the scale; the end's beyond it.
pub(super) fn colour(share: f64) -> Rgb<u8> {
    let colorous::Color { r, g, b } = MAGMA.eval_continuous(share);
    Rgb([r, g, b])
}

/// The error of every pixel, row by row; of pixels that are not finite it means nothing.
fn errors(actual: &Image, expected: &Image, encoding: Encoding, unit: Unit) -> Vec<f64> {
    match unit {
        Unit::Steps => {
            let bytes = [actual.to_bytes(encoding), expected.to_bytes(encoding)];
            pairs(actual, expected).map(|pair| f64::from(step(&bytes, pair.at))).collect()
        }
        Unit::Linear => {
            let largest = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            pairs(actual, expected).map(|pair| largest(pair.actual, pair.expected)).collect()
        }
    }
}

/// The first round number that 99.9 % of the pixels that are shown on the scale do not exceed.
fn upper(errors: &[f64], kinds: &[Kind], unit: Unit) -> f64 {
    let on_scale = errors.iter().zip(kinds).filter(|(_, kind)| kind.is_on_scale());
    let mut errors: Vec<f64> = on_scale.map(|(error, _)| *error).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let largest = errors.last().copied().unwrap_or(0.0);
    // Where less than 0.1 % differ, a scale of the others would have no length.
    let most = [percentile(&errors, 99.9), largest].into_iter().find(|error| *error > 0.0);
    match (unit, most) {
        (_, None) => 1.0,
        (Unit::Steps, Some(most)) => round_up(most.max(1.0)),
        (Unit::Linear, Some(most)) => round_up(most),
    }
}

/// The first of 1, 2 and 5 times a power of ten that is not below a number above 0.
fn round_up(number: f64) -> f64 {
    let power = 10_f64.powf(number.log10().floor());
    // A rounded power may lie a hair on the wrong side of the number.
    let reaches = |candidate: &f64| *candidate >= number * (1.0 - 1e-12);
    [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(reaches).unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::round_up;

    #[test]
    fn scales_end_at_round_numbers() {
        for (number, expected) in
            [(1.0, 1.0), (1.5, 2.0), (2.0, 2.0), (2.1, 5.0), (7.0, 10.0), (255.0, 500.0), (0.003, 0.005), (1e-9, 1e-9)]
        {
            assert!((round_up(number) / expected - 1.0).abs() < 1e-9, "{number}: {}", round_up(number));
        }
    }
}

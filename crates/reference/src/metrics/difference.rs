//! Difference pictures.

use halfway_lighting::Encoding;
use image::RgbImage;

use super::bands::{Band, BandPairs, PictureRows, SizeMismatch};
use super::canvas::{enlarged, stacked};
use super::comparison::{largest, steps};
use super::coverage::{Kind, pairs};
use super::legend::legend;
use super::ranks::percentile;
use super::scale::{COVERAGE, LegendContent, NOT_FINITE, Scale, Unit, color, round_up};

/// Draws the error of every pixel through the colour map "magma" (black is none, pale yellow the upper end), with a
/// legend below. Pixels with different coverage are green, pixels that are not finite light blue. Small pictures are
/// enlarged by a whole number.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
/// use halfway_reference::metrics::{Scale, Unit, difference};
///
/// let [expected, actual] = [0.5, 0.52].map(|gray| Image::new(8, 8, vec![[gray; 3]; 64]));
/// let scale = Scale { unit: Unit::Linear, upper: Some(0.05) };
/// let picture = difference(&actual, &expected, Encoding::Srgb, scale)?;
/// assert!(picture.width() >= 320);
/// # Ok::<(), halfway_reference::metrics::SizeMismatch>(())
/// ```
///
/// # Errors
/// [`SizeMismatch`].
pub fn difference(
    actual: &dyn PictureRows,
    expected: &dyn PictureRows,
    encoding: Encoding,
    scale: Scale,
) -> Result<RgbImage, SizeMismatch> {
    let bands = BandPairs::new(actual, expected)?;
    let (mut kinds, mut errors) = (Vec::new(), Vec::new());
    for band in bands.each() {
        kinds.extend(pairs(&band).map(|pair| pair.kind));
        extend_errors(&mut errors, &band, encoding, scale.unit);
    }
    let upper = scale.upper.filter(|upper| *upper > 0.0).unwrap_or_else(|| upper(&errors, &kinds, scale.unit));
    let pixels = kinds.iter().zip(&errors).flat_map(|(kind, error)| match kind {
        Kind::OnlyActual | Kind::OnlyExpected => COVERAGE.0,
        Kind::NotFinite => NOT_FINITE.0,
        Kind::Counted | Kind::Background => color(error / upper).0,
    });
    let (width, height) = bands.size;
    let picture = RgbImage::from_raw(width, height, pixels.collect()).unwrap_or_default();
    let has = |wanted: &[Kind]| kinds.iter().any(|kind| wanted.contains(kind));
    let shown = LegendContent {
        unit: scale.unit,
        upper,
        beyond: kinds.iter().zip(&errors).any(|(kind, error)| kind.is_on_scale() && *error > upper),
        coverage: has(&[Kind::OnlyActual, Kind::OnlyExpected]),
        not_finite: has(&[Kind::NotFinite]),
    };
    let picture = enlarged(&picture);
    let legend = legend(picture.width(), shown);
    Ok(stacked(&picture, &legend))
}

/// Appends the error of every pixel of a band, row by row; meaningless for pixels that are not finite.
fn extend_errors(errors: &mut Vec<f64>, band: &Band, encoding: Encoding, unit: Unit) {
    match unit {
        Unit::Steps => {
            let bytes = [&band.actual, &band.expected].map(|image| image.to_bytes(encoding));
            let places = pairs(band).map(|pair| (pair.at.0, pair.at.1 - band.first));
            errors.extend(places.map(|at| f64::from(largest(steps(&bytes, at)))));
        }
        Unit::Linear => {
            let largest = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            errors.extend(pairs(band).map(|pair| largest(pair.actual, pair.expected)));
        }
    }
}

/// The first round number that 99.9 % of the displayed errors do not exceed.
fn upper(errors: &[f64], kinds: &[Kind], unit: Unit) -> f64 {
    let on_scale = errors.iter().zip(kinds).filter(|(_, kind)| kind.is_on_scale());
    let mut errors: Vec<f64> = on_scale.map(|(error, _)| *error).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let largest = errors.last().copied().unwrap_or(0.0);
    // If less than 0.1 % differ, the scale would be empty: use the largest error.
    let most = [percentile(&errors, 99.9), largest].into_iter().find(|error| *error > 0.0);
    match (unit, most) {
        (_, None) => 1.0,
        (Unit::Steps, Some(most)) => round_up(most.max(1.0)),
        (Unit::Linear, Some(most)) => round_up(most),
    }
}

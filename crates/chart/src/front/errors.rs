//! Errors of a picture.

use halfway::prelude::{Encoding, Samples};
use halfway::reference::Image;
use halfway::reference::metrics::{self, SizeMismatch, Statistics};
use serde::Serialize;

/// Errors of all channels, in one unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// Root of the mean square.
    pub rms: f64,
    /// The largest.
    pub max: f64,
    /// The 95th percentile.
    pub p95: f64,
}

/// Errors over some of the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AreaErrors {
    /// In steps of 1/255.
    pub steps: ErrorFigures,
    /// Mean ꟻLIP, 0 to 1.
    pub flip: f64,
}

/// Errors of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PointErrors {
    /// Over the pixels that picture and truth both cover.
    pub covered: AreaErrors,
    /// Over the whole picture, silhouettes and background too; nothing is made equal first.
    pub whole: AreaErrors,
}

/// The true values of the pixels.
pub(super) struct Truth {
    /// At their centres: the truth for one sample inside of surfaces.
    pub(super) center: Image,
    /// Averaged over their areas: the truth for four samples, and for everything at silhouettes.
    pub(super) average: Image,
}

impl From<&Statistics> for ErrorFigures {
    fn from(errors: &Statistics) -> Self {
        let [_, p95, ..] = errors.percentiles;
        Self { rms: errors.rmse, max: errors.max(), p95 }
    }
}

impl PointErrors {
    /// Errors of an 8-bit picture with the coverage of one sample a pixel, drawn with so many samples.
    pub(super) fn new(
        picture: &Image,
        samples: Samples,
        truth: &Truth,
        encoding: Encoding,
    ) -> Result<Self, SizeMismatch> {
        let inside = if samples == Samples::One { &truth.center } else { &truth.average };
        // Without coverage, every pixel counts.
        let [whole, average] = [picture, &truth.average].map(without_coverage);
        let steps = |picture: &Image, truth: &Image| {
            Ok::<ErrorFigures, SizeMismatch>((&metrics::compare(picture, truth, encoding)?.steps.all).into())
        };
        let covered_flip = metrics::flip_of_covered(picture, inside, encoding)?.mean;
        let whole_flip = metrics::flip(&whole, &average, encoding)?.mean;
        Ok(Self {
            covered: AreaErrors { steps: steps(picture, inside)?, flip: covered_flip },
            whole: AreaErrors { steps: steps(&whole, &average)?, flip: whole_flip },
        })
    }
}

fn without_coverage(image: &Image) -> Image {
    let (width, height) = image.dimensions();
    Image::new(width, height, image.pixels().to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One pixel of the four is wrong inside, one is not covered although it should be.
    #[test]
    fn silhouettes_count_in_the_whole_picture_only() {
        let truth = Image::new(2, 2, vec![[0.5; 3], [0.5; 3], [0.5; 3], [0.0; 3]]);
        let truth = truth.with_coverage(vec![true, true, true, false]);
        let picture = Image::new(2, 2, vec![[0.5; 3], [0.75; 3], [0.0; 3], [0.0; 3]]);
        let picture = picture.with_coverage(vec![true, true, false, false]);
        let truth = Truth { center: truth.clone(), average: truth };
        let errors = PointErrors::new(&picture, Samples::One, &truth, Encoding::Raw).unwrap();
        // 0.25 · 255 = 63.75 and 127.5 round to bytes: 128 of 0.5, 191 of 0.75.
        assert!((errors.covered.steps.rms - (63.0f64 * 63.0 / 2.0).sqrt()).abs() < 1e-9);
        assert!((errors.whole.steps.rms - ((63.0 * 63.0 + 128.0 * 128.0) / 4.0f64).sqrt()).abs() < 1e-9);
        assert!((errors.covered.steps.max - 63.0).abs() < 1e-9 && (errors.whole.steps.max - 128.0).abs() < 1e-9);
        assert!(errors.whole.flip > errors.covered.flip / 2.0 && errors.covered.flip > 0.0);
    }
}

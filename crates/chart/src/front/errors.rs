//! How far a picture is from the true one.

use halfway::prelude::Encoding;
use halfway::reference::Image;
use halfway::reference::metrics::{self, SizeMismatch, Statistics};
use serde::{Deserialize, Serialize};

/// Which pixels count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Those that picture and truth both cover.
    Covered,
    /// All, silhouettes and background too; nothing is made equal first.
    Whole,
}

/// Errors of all channels, in one unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorFigures {
    /// Root of the mean square.
    pub rms: f64,
    /// The largest.
    pub max: f64,
    /// What 95 % keep to.
    pub p95: f64,
}

/// Errors over one [`Area`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AreaErrors {
    /// Of the 8-bit picture, which is the one that is timed, in steps of 1/255.
    pub steps: ErrorFigures,
    /// Of the picture in floating point, in linear intensity.
    pub linear: ErrorFigures,
    /// Mean ꟻLIP of the 8-bit picture, 0 to 1.
    pub flip: f64,
}

/// Errors over both areas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointErrors {
    /// Over [`Area::Covered`].
    pub covered: AreaErrors,
    /// Over [`Area::Whole`].
    pub whole: AreaErrors,
}

/// What a pixel should show.
pub(super) struct Truth {
    /// At its centre: what one sample is judged by inside of surfaces.
    pub(super) center: Image,
    /// Averaged over its area: what four samples are judged by, and everything at silhouettes.
    pub(super) average: Image,
}

/// One method's two pictures, of bytes and of floats, with the coverage of one sample.
pub(super) struct Drawn {
    pub(super) bytes: Image,
    pub(super) floats: Image,
    pub(super) one_sample: bool,
}

impl From<&Statistics> for ErrorFigures {
    fn from(errors: &Statistics) -> Self {
        let [_, p95, ..] = errors.percentiles;
        Self { rms: errors.rmse, max: errors.max(), p95 }
    }
}

impl PointErrors {
    /// Errors of both pictures over both areas.
    pub(super) fn of(drawn: &Drawn, truth: &Truth, encoding: Encoding) -> Result<Self, SizeMismatch> {
        let inside = if drawn.one_sample { &truth.center } else { &truth.average };
        // A picture that does not know what it covers counts everywhere.
        let [bytes, floats, average] = [&drawn.bytes, &drawn.floats, &truth.average].map(without_coverage);
        let flip = [
            metrics::flip_of_covered(&drawn.bytes, inside, encoding)?.mean,
            metrics::flip(&bytes, &average, encoding)?.mean,
        ];
        let area = |bytes: &Image, floats: &Image, truth: &Image, flip: f64| {
            Ok(AreaErrors {
                steps: (&metrics::compare(bytes, truth, encoding)?.steps.all).into(),
                linear: (&metrics::compare(floats, truth, encoding)?.linear.all).into(),
                flip,
            })
        };
        Ok(Self {
            covered: area(&drawn.bytes, &drawn.floats, inside, flip[0])?,
            whole: area(&bytes, &floats, &average, flip[1])?,
        })
    }

    /// Over one of the areas.
    pub fn over(&self, area: Area) -> &AreaErrors {
        match area {
            Area::Covered => &self.covered,
            Area::Whole => &self.whole,
        }
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
        let drawn = Drawn { bytes: picture.clone(), floats: picture, one_sample: true };
        let truth = Truth { center: truth.clone(), average: truth };
        let errors = PointErrors::of(&drawn, &truth, Encoding::Raw).unwrap();
        assert!((errors.covered.linear.rms - (0.25f64 * 0.25 / 2.0).sqrt()).abs() < 1e-12);
        assert!((errors.whole.linear.rms - ((0.0625 + 0.25) / 4.0f64).sqrt()).abs() < 1e-12);
        // 0.25 · 255 = 63.75 and 127.5 round to bytes: 128 of 0.5, 191 of 0.75.
        assert!((errors.covered.steps.max - 63.0).abs() < 1e-9 && (errors.whole.steps.max - 128.0).abs() < 1e-9);
        assert!(errors.whole.flip > errors.covered.flip / 2.0 && errors.covered.flip > 0.0);
    }
}

//! Comparisons of the stage with the oracle, and of pictures with each other.

use crate::render::scene::Scene;
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{self, Bars, Measure, Verdict};
use image::{Rgba32FImage, RgbaImage};
use std::path::Path;

pub(crate) const FLOAT: Bars = Bars::FLOAT;

/// The curve of an adapter may be 0.6 of a step off (Vulkan's conversion rules), so that a value a tenth of a step from
/// the middle between two bytes becomes either. The number of pixels with such values depends on the scene; in a
/// picture of one colour it may be all.
pub(crate) const SRGB: Bars = Bars { equal: 0.0, ..Bars::bytes(Encoding::Srgb) };

/// Each layer is rounded to bytes before the next is blended over it, where the oracle rounds once: fewer bytes are
/// equal.
pub(crate) const BLENDED: Bars = Bars { equal: 0.0, ..Bars::bytes(Encoding::Raw) };
/// Bytes of scenes with more than eight lights: a patch may leave out light of up to half a step, and the share of
/// pixels that rounds to the step below equals the share of a step that is left out.
pub(crate) const SELECTED: Bars = Bars { equal: 0.5, ..Bars::bytes(Encoding::Raw) };

/// The rows of a table that failed, so that one does not hide the others.
#[derive(Default)]
pub(crate) struct Failures(Vec<String>);

impl Failures {
    pub(crate) fn unless(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.0.push(what());
        }
    }

    /// Draws `scene`, and adds the row unless it shows something and matches the oracle within `bars`.
    pub(crate) fn draw(&mut self, row: &str, stage: &mut Stage, scene: &Scene, bars: Bars) -> Verdict {
        let picture = stage.draw(scene);
        self.compare(row, stage, &picture, bars)
    }

    /// Adds the row unless `picture` shows something and matches the oracle's picture of the stage.
    pub(crate) fn compare(&mut self, row: &str, stage: &mut Stage, picture: &Rgba32FImage, bars: Bars) -> Verdict {
        self.unless(picture.pixels().all(|pixel| pixel.0[3] == 1.0), || format!("{row} is not opaque"));
        let (verdict, expected) = self.judge(row, stage, &Image::from_float(picture), bars);
        let shows = expected.covered().is_none_or(|covered| covered.contains(&true));
        self.unless(shows, || format!("{row} shows nothing"));
        verdict
    }

    /// Draws `scene`, which may be invisible, and adds the row unless it matches the oracle within `bars`.
    pub(crate) fn draw_any(&mut self, row: &str, stage: &mut Stage, scene: &Scene, bars: Bars) -> Verdict {
        let picture = Image::from_float(&stage.draw(scene));
        self.judge(row, stage, &picture, bars).0
    }

    /// Adds the row unless a picture of bytes matches the oracle's picture of the stage.
    pub(crate) fn compare_bytes(&mut self, row: &str, stage: &mut Stage, picture: &RgbaImage, bars: Bars) -> Verdict {
        self.unless(picture.pixels().all(|pixel| pixel.0[3] == 255), || format!("{row} is not opaque"));
        let picture = Image::from_bytes(picture, encoding(&bars));
        self.judge(row, stage, &picture, stage.rounding(bars)).0
    }

    fn judge(&mut self, row: &str, stage: &mut Stage, actual: &Image, bars: Bars) -> (Verdict, Image) {
        let (verdict, expected) = judge(stage, actual, bars);
        self.unless(verdict.is_within(), || {
            let comparison = metrics::compare(actual, &expected, encoding(&bars)).expect("pictures of one size");
            let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
            let left = metrics::report_failure(folder, row, actual, &expected, &comparison);
            format!("{left}; off edges {verdict}")
        });
        (verdict, expected)
    }

    /// Panics with every row that failed.
    pub(crate) fn finish(self) {
        assert!(self.0.is_empty(), "{} rows failed:\n{}", self.0.len(), self.0.join("\n"));
    }
}

/// Judges a picture by the oracle's picture of the stage, which is returned too.
pub(crate) fn judge(stage: &mut Stage, actual: &Image, bars: Bars) -> (Verdict, Image) {
    let truth = stage.oracle().with_clamping(bars.are_clamped());
    let expected = truth.draw();
    let verdict = metrics::judge_on_grid(&truth, &expected, stage.grid_bits(), actual, bars);
    (verdict.expect("pictures of one size"), expected)
}

/// The encoding in which errors are counted; for floating point, the encoding for display.
fn encoding(bars: &Bars) -> Encoding {
    match bars.measure {
        Measure::Steps(encoding) => encoding,
        Measure::Range => Encoding::Srgb,
    }
}

/// Draws `scene`, and fails unless it shows something and matches the oracle within [`FLOAT`].
pub(crate) fn assert_as_expected(row: &str, stage: &mut Stage, scene: &Scene) -> Verdict {
    let mut failures = Failures::default();
    let verdict = failures.draw(row, stage, scene, FLOAT);
    failures.finish();
    verdict
}

/// The largest difference of two pictures, channel by channel.
pub(crate) fn difference(a: &Rgba32FImage, b: &Rgba32FImage) -> f32 {
    assert_eq!(a.dimensions(), b.dimensions());
    a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The brightest channel of a picture.
pub(crate) fn brightest(picture: &Rgba32FImage) -> f32 {
    picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]).fold(0.0, f32::max)
}

/// Fails unless two pictures are the same to the bit.
pub(crate) fn assert_identical(row: &str, a: &Rgba32FImage, b: &Rgba32FImage) {
    assert_eq!(a.dimensions(), b.dimensions(), "{row}");
    let bits = |image: &Rgba32FImage| image.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert!(bits(a) == bits(b), "{row}: the pictures differ by up to {}", difference(a, b));
}

/// Fails unless every channel of a picture is finite and 0 or more.
pub(crate) fn assert_finite(row: &str, picture: &Rgba32FImage) {
    for (x, y, pixel) in picture.enumerate_pixels() {
        assert!(pixel.0.iter().all(|v| v.is_finite() && *v >= 0.0), "{row}: pixel ({x}, {y}) is {:?}", pixel.0);
    }
}

//! `--tolerance`: the allowed difference from the exact picture.

use clap::Args;
use halfway::prelude::*;
use halfway::scene::options::parse;

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct ToleranceArgs {
    /// The allowed difference from the exact picture, which has every light and every triangle: in steps of 1/255, and
    /// by how many pixels a point may move (0 if left out) [default: the scene's; exact if it has none, and always
    /// in verify]
    #[arg(long, value_name = "STEPS[,PIXELS]|exact", value_parser = parse::tolerance)]
    tolerance: Option<Tolerance>,
}

impl ToleranceArgs {
    /// The given tolerance, or else `other`.
    pub(crate) fn or(self, other: Tolerance) -> Tolerance {
        self.tolerance.unwrap_or(other)
    }

    /// The given tolerance.
    pub(crate) fn given(self) -> Option<Tolerance> {
        self.tolerance
    }
}

/// A short description.
#[cfg(feature = "measure")]
pub(crate) fn describe(tolerance: Tolerance) -> String {
    let Tolerance { steps, pixels } = tolerance;
    let counted = |number: f32, what| match number.to_string() {
        one if one == "1" => format!("1 {what}"),
        number => format!("{number} {what}s"),
    };
    if tolerance == Tolerance::EXACT {
        "exact".to_owned()
    } else {
        format!("{} of 255, {}", counted(steps, "step"), counted(pixels, "pixel"))
    }
}

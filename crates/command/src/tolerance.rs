//! `--tolerance`: the allowed difference from the exact picture.

use clap::Args;
use halfway::prelude::*;

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct ToleranceArgs {
    /// The allowed difference from the exact picture, which has every light and every triangle: in steps of 1/255, and
    /// by how many pixels a point may move (0 if left out) [default: the scene's; exact if it has none, and always
    /// in verify]
    #[arg(long, value_name = "STEPS[,PIXELS]|exact", value_parser = parse)]
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

fn parse(text: &str) -> Result<Tolerance, String> {
    if text == "exact" {
        return Ok(Tolerance::EXACT);
    }
    let (steps, pixels) = text.split_once(',').unwrap_or((text, "0"));
    let number = |text: &str| text.parse::<f32>().ok();
    let tolerance = number(steps).zip(number(pixels)).map(|(steps, pixels)| Tolerance { steps, pixels });
    tolerance
        .filter(|tolerance| tolerance.validate().is_ok())
        .ok_or_else(|| "expected exact, or steps and pixels, 0 or more, such as 1 or 2,0.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_by_steps_and_pixels() {
        assert_eq!(parse("exact"), Ok(Tolerance::EXACT));
        assert_eq!(parse("0,0"), Ok(Tolerance::EXACT));
        assert_eq!(parse("1"), Ok(Tolerance::steps(1.0)));
        assert_eq!(parse("1,0.5"), Ok(Tolerance { steps: 1.0, pixels: 0.5 }));
        assert_eq!(parse("2.5,0"), Ok(Tolerance::steps(2.5)));
        for bad in ["", "on", "-1", "1,-1", "inf", "NaN,1", "1px", "1,", ",1", "1,2,3", "Exact "] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}

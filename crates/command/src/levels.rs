//! `--levels`: how coarse meshes may be drawn.

use clap::Args;
use halfway::prelude::*;

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct LevelsArgs {
    /// How many pixels a coarser level of detail may be off; off: every mesh as it is [default: 0.5]
    #[arg(long, value_name = "PIXELS|off", value_parser = parse)]
    levels: Option<LevelsOfDetail>,
}

impl LevelsArgs {
    /// As asked for, or the default.
    pub(crate) fn allowed(self) -> LevelsOfDetail {
        self.levels.unwrap_or_default()
    }

    /// Whether there is anything to hand on.
    pub(crate) fn is_given(self) -> bool {
        self.levels.is_some()
    }

    /// The arguments that mean the same, for another process.
    pub(crate) fn arguments(self) -> Vec<String> {
        self.levels.map_or_else(Vec::new, |levels| vec!["--levels".to_owned(), levels.pixels.to_string()])
    }
}

/// In a few words.
pub(crate) fn describe(levels: LevelsOfDetail) -> String {
    if levels.pixels > 0.0 { format!("within {} pixels", levels.pixels) } else { "off".to_owned() }
}

fn parse(text: &str) -> Result<LevelsOfDetail, String> {
    if text == "off" {
        return Ok(LevelsOfDetail::OFF);
    }
    match text.parse::<f32>() {
        Ok(0.0) => Ok(LevelsOfDetail::OFF),
        Ok(pixels) if pixels > 0.0 && pixels.is_finite() => Ok(LevelsOfDetail { pixels, ..LevelsOfDetail::default() }),
        _ => Err("expected off or a number of pixels, 0 or more, such as 0.5".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_by_pixels() {
        for off in ["off", "0", "0.0"] {
            assert_eq!(parse(off), Ok(LevelsOfDetail::OFF), "{off}");
        }
        assert_eq!(parse("0.5"), Ok(LevelsOfDetail::default()));
        assert_eq!(parse("2").map(|levels| levels.pixels), Ok(2.0));
        for bad in ["", "on", "-1", "inf", "NaN", "1px", "Off "] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn another_process_hears_the_same() {
        for text in ["off", "0.1", "3"] {
            let given = LevelsArgs { levels: parse(text).ok() };
            let [option, value] = &given.arguments()[..] else { panic!("an option and its value") };
            assert_eq!((option.as_str(), parse(value)), ("--levels", Ok(given.allowed())), "{text}");
        }
        let none = LevelsArgs { levels: None };
        assert_eq!((none.arguments(), none.allowed()), (Vec::new(), LevelsOfDetail::default()));
    }
}

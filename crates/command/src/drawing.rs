//! The options for drawing a scene.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use halfway::prelude::{Intensity, Reflectance, Shading, UVec2};
use halfway::record::parse_size;

use crate::adapters::AdapterArgs;
use crate::choices::{choice, values};
use crate::edges::EdgeArgs;
use crate::framing::FramingArgs;
use crate::lines::LineArgs;
use crate::look::LookArgs;
use crate::reading::InputArgs;
use crate::scalars::ScalarArgs;
use crate::tolerance::ToleranceArgs;

/// How the scene is drawn; options override the scene file.
#[derive(Args, Clone, Debug)]
pub(crate) struct DrawingArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) framing: FramingArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// How often surfaces are shaded [default: the scene's; phong for a model]
    #[arg(long, value_parser = shadings())]
    shading: Option<GivenShading>,
    /// How surfaces reflect [default: the scene's; blinn-phong for a model]
    #[arg(long, value_parser = reflectances())]
    pub(crate) reflectance: Option<Reflectance>,
    /// Samples a pixel: 1, 4 for smooth edges, or 16 or 64, each shaded [default: the scene's; 4 for a model]
    #[arg(long, value_parser = samples())]
    pub(crate) samples: Option<u32>,
    /// The treatment of intensities above 1: clamp, renormalise, reinhard or aces; renormalise with the share of the
    /// last frame's divisor that stays, reinhard with the intensity that becomes 1 [default: the scene's; clamp for a
    /// model]
    #[arg(long, value_name = "clamp|renormalise[=SHARE]|reinhard[=WHITE]|aces", value_parser = parse_intensity)]
    pub(crate) intensity: Option<Intensity>,
    /// The camera of this name, or the N-th, counted from 0: the scene's, then those of its models [default: the scene's
    /// first, or one that frames everything]
    #[arg(long, value_name = "NAME|N")]
    pub(crate) camera: Option<String>,
    #[command(flatten)]
    pub(crate) tolerance: ToleranceArgs,
    #[command(flatten)]
    pub(crate) edges: EdgeArgs,
    #[command(flatten)]
    pub(crate) scalars: ScalarArgs,
    #[command(flatten)]
    pub(crate) lines: LineArgs,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
}

/// A value of `--shading`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GivenShading {
    Known(Shading),
    /// `auto`, a former shading.
    Retired,
}

impl DrawingArgs {
    /// The chosen shading. Prints a warning about a former one.
    pub(crate) fn shading(&self) -> Option<Shading> {
        self.shading.map(|given| match given {
            GivenShading::Known(shading) => shading,
            GivenShading::Retired => {
                eprintln!("warning: --shading auto: \"auto\" is no longer a shading; \"phong\" is drawn");
                Shading::Phong
            }
        })
    }
}

/// The size of a picture.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct SizeArgs {
    /// Width and height in pixels, such as 1280x720 [default: the scene's; 1280x720 for a model]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<UVec2>,
}

fn shadings() -> impl TypedValueParser<Value = GivenShading> {
    let retired = PossibleValue::new("auto").hide(true);
    PossibleValuesParser::new(values::<Shading>().chain([retired]))
        .map(|text| choice(&text).map_or(GivenShading::Retired, GivenShading::Known))
}

fn reflectances() -> impl TypedValueParser<Value = Reflectance> {
    PossibleValuesParser::new(values::<Reflectance>()).try_map(|text| choice(&text).ok_or("not one of the values"))
}

fn samples() -> impl TypedValueParser<Value = u32> {
    let values = [
        ("1", "The middle of the pixel"),
        ("4", "Four points of it for coverage"),
        ("16", "As many frames, moved by quarters of a pixel"),
        ("64", "As many frames, moved by eighths of a pixel"),
    ];
    let values = values.map(|(number, help)| PossibleValue::new(number).help(help));
    PossibleValuesParser::new(values).try_map(|text| text.parse::<u32>())
}

fn parse_intensity(text: &str) -> Result<Intensity, String> {
    let (word, number) = match text.split_once('=') {
        Some((word, number)) => (word, Some(number.parse::<f32>().map_err(|_| EXPECTED.to_owned())?)),
        None => (text, None),
    };
    let intensity = match (choice(word), number) {
        (Some(named), None) => named,
        (Some(Intensity::Renormalize { .. }), Some(smoothing)) => Intensity::Renormalize { smoothing },
        (Some(Intensity::Reinhard { .. }), Some(white)) => Intensity::Reinhard { white },
        _ => return Err(EXPECTED.to_owned()),
    };
    intensity.validate().map(|()| intensity).map_err(|error| error.problem.to_string())
}

const EXPECTED: &str =
    "expected clamp, renormalise, reinhard or aces, the second and third also with a number, as reinhard=4";

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        look: DrawingArgs,
    }

    #[test]
    fn auto_is_read_as_phong_and_not_offered() {
        let read = |word: &str| Line::try_parse_from(["halfway", "teapot.obj", "--shading", word]);
        for (word, shading) in [
            ("flat", Shading::Flat),
            ("gouraud", Shading::Gouraud),
            ("phong", Shading::Phong),
            ("unlit", Shading::Unlit),
            ("auto", Shading::Phong),
        ] {
            assert_eq!(read(word).map(|line| line.look.shading()).ok(), Some(Some(shading)), "{word}");
        }
        let error = read("smooth").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("[possible values: flat, gouraud, phong, unlit]"), "{error}");
    }

    #[test]
    fn policies_with_and_without_their_numbers() {
        for (text, expected) in [
            ("clamp", Intensity::Clamp),
            ("renormalise", Intensity::Renormalize { smoothing: 0.0 }),
            ("renormalise=0.9", Intensity::Renormalize { smoothing: 0.9 }),
            ("reinhard", Intensity::Reinhard { white: 4.0 }),
            ("reinhard=2.5", Intensity::Reinhard { white: 2.5 }),
            ("aces", Intensity::Aces),
        ] {
            assert_eq!(parse_intensity(text), Ok(expected), "{text}");
        }
        for bad in ["", "tone", "aces=1", "clamp=1", "reinhard=", "reinhard=x", "Clamp"] {
            assert_eq!(parse_intensity(bad), Err(EXPECTED.to_owned()), "{bad}");
        }
        assert!(parse_intensity("reinhard=0.5").is_err_and(|error| error.contains("1 or more")));
        assert!(parse_intensity("renormalise=1").is_err_and(|error| error.contains("0 to below 1")));
    }
}

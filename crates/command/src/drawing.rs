//! The options for drawing a scene.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use halfway::prelude::{Intensity, Reflectance, Shading, UVec2};
use halfway::record::parse_size;

use crate::adapters::AdapterArgs;
use crate::tolerance::ToleranceArgs;

/// How the scene is drawn; options override the scene file.
#[derive(Args, Clone, Debug)]
pub(crate) struct DrawingArgs {
    /// A scene file (.json) or a model (.smf, .obj, .gltf, .glb, .ply, .stl)
    #[arg(value_name = "SCENE|MODEL")]
    pub(crate) input: PathBuf,
    /// How often surfaces are shaded [default: the scene's; phong for a model]
    #[arg(long, value_parser = one_of(&SHADINGS))]
    shading: Option<GivenShading>,
    /// How surfaces reflect [default: the scene's; blinn-phong for a model]
    #[arg(long, value_parser = one_of(&REFLECTANCES))]
    pub(crate) reflectance: Option<Reflectance>,
    /// Coverage samples a pixel: 1, or 4 for smooth edges [default: the scene's; 1 for a model]
    #[arg(long, value_parser = one_of(&SAMPLES))]
    pub(crate) samples: Option<u32>,
    /// The treatment of intensities above 1: clamp, renormalise, reinhard or aces; renormalise with the share of the
    /// last frame's divisor that stays, reinhard with the intensity that becomes 1 [default: the scene's; clamp for a
    /// model]
    #[arg(long, value_name = "clamp|renormalise[=SHARE]|reinhard[=WHITE]|aces", value_parser = parse_intensity)]
    pub(crate) intensity: Option<Intensity>,
    #[command(flatten)]
    pub(crate) tolerance: ToleranceArgs,
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

/// Values of an option: the text on the command line, its help, and its meaning. Those without help are not listed.
type Values<T, const N: usize> = [(&'static str, &'static str, T); N];

const SHADINGS: Values<GivenShading, 4> = [
    ("flat", "Once a triangle", GivenShading::Known(Shading::Flat)),
    ("gouraud", "Once a vertex", GivenShading::Known(Shading::Gouraud)),
    ("phong", "Once a pixel", GivenShading::Known(Shading::Phong)),
    ("auto", "", GivenShading::Retired),
];
const REFLECTANCES: Values<Reflectance, 3> = [
    ("phong", "(v·r)^α", Reflectance::Phong),
    ("blinn-phong", "(n·h)^β, β the shininess as it is", Reflectance::BlinnPhong),
    ("blinn-phong-matched", "(n·h)^β, β matched to the α that the shininess means", Reflectance::BlinnPhongMatched),
];
const SAMPLES: Values<u32, 2> = [("1", "The middle of the pixel", 1), ("4", "Four points of it", 4)];

fn one_of<T, const N: usize>(values: &'static Values<T, N>) -> impl TypedValueParser<Value = T>
where
    T: Clone + Send + Sync,
{
    let names = values.iter().map(|(name, help, _)| PossibleValue::new(*name).help(*help).hide(help.is_empty()));
    PossibleValuesParser::new(names).try_map(|text| {
        let value = values.iter().find(|(name, ..)| *name == text);
        value.map(|(.., value)| value.clone()).ok_or("not one of the values")
    })
}

fn parse_intensity(text: &str) -> Result<Intensity, String> {
    let (word, number) = match text.split_once('=') {
        Some((word, number)) => (word, Some(number.parse::<f32>().map_err(|_| EXPECTED.to_owned())?)),
        None => (text, None),
    };
    let intensity = match (word, number) {
        ("clamp", None) => Intensity::Clamp,
        ("renormalise", smoothing) => Intensity::Renormalize { smoothing: smoothing.unwrap_or(0.0) },
        ("reinhard", white) => Intensity::Reinhard { white: white.unwrap_or(Intensity::WHITE) },
        ("aces", None) => Intensity::Aces,
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
            ("auto", Shading::Phong),
        ] {
            assert_eq!(read(word).map(|line| line.look.shading()).ok(), Some(Some(shading)), "{word}");
        }
        let error = read("smooth").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("[possible values: flat, gouraud, phong]"), "{error}");
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

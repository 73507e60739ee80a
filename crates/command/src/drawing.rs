//! The options for drawing a scene.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use halfway::lighting::Term;
use halfway::prelude::{Intensity, Reflectance, Shading, UVec2};
use halfway::record::parse_size;
use halfway::scene::options::{SceneOptions, parse};

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
    /// Draw one term alone; emission with the background, before which the others are black [default: the scene's; all]
    #[arg(long, value_parser = terms())]
    only: Option<Term>,
    /// Draw one light alone, by this name or the N-th, counted from 0: without the global ambient light, an environment,
    /// emission and the background [default: the scene's; all]
    #[arg(long, value_name = "NAME|N")]
    light: Option<String>,
    /// Samples a pixel: 1, 4 for smooth edges, or 16 or 64, each shaded [default: the scene's; 4 for a model]
    #[arg(long, value_parser = samples())]
    pub(crate) samples: Option<u32>,
    /// The treatment of intensities above 1: clamp, renormalise, reinhard or aces; renormalise with the share of the
    /// last frame's divisor that stays, reinhard with the intensity that becomes 1 [default: the scene's; clamp for a
    /// model]
    #[arg(long, value_name = "clamp|renormalise[=SHARE]|reinhard[=WHITE]|aces", value_parser = parse::intensity)]
    pub(crate) intensity: Option<Intensity>,
    /// The camera of this name, or the N-th, counted from 0: the scene's, then those of its models [default: the scene's
    /// first, or one that frames everything]
    #[arg(long, value_name = "NAME|N")]
    pub(crate) camera: Option<String>,
    /// The animation of the models that is played, by this name, or the N-th, counted from 0 [default: the scene's; the
    /// first]
    #[arg(long, value_name = "NAME|N")]
    animation: Option<String>,
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

    /// The options for the scene. Prints a warning about a former shading.
    pub(crate) fn options(&self) -> SceneOptions {
        let mut options = SceneOptions {
            shading: self.shading(),
            reflectance: self.reflectance,
            tolerance: self.tolerance.given(),
            only: self.only,
            light: self.light.clone(),
            samples: self.samples,
            intensity: self.intensity,
            animation: self.animation.clone(),
            ..SceneOptions::default()
        };
        self.framing.put_into(&mut options);
        self.look.put_into(&mut options);
        self.edges.put_into(&mut options);
        self.lines.put_into(&mut options);
        self.scalars.put_into(&mut options);
        options
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
    PossibleValuesParser::new(values::<Reflectance>()).try_map(|text| choice(&text))
}

fn terms() -> impl TypedValueParser<Value = Term> {
    PossibleValuesParser::new(values::<Term>()).try_map(|text| choice(&text))
}

fn samples() -> impl TypedValueParser<Value = u32> {
    let values = [
        ("1", "The middle of the pixel"),
        ("4", "Four points of it for coverage"),
        ("16", "As many frames, moved by quarters of a pixel"),
        ("64", "As many frames, moved by eighths of a pixel"),
    ];
    let values = values.map(|(number, help)| PossibleValue::new(number).help(help));
    PossibleValuesParser::new(values).try_map(|text| parse::samples(&text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        look: DrawingArgs,
    }

    #[test]
    fn the_options_of_scenes_have_the_same_names_here() {
        let command = Line::command();
        let known: Vec<&str> = command.get_arguments().filter_map(clap::Arg::get_long).collect();
        for name in SceneOptions::NAMES {
            assert!(known.contains(&name.replace('_', "-").as_str()), "{name}");
        }
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
}

//! `--scalars` and `--legend`: numbers of a model, shown by colours.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfway::scene::ColorMap;
use halfway::scene::options::{SceneOptions, parse};

use crate::choices::{choice, values};

/// The options hold for all models.
#[derive(Args, Clone, Debug)]
pub(crate) struct ScalarArgs {
    /// Show this property of the models, such as a PLY's temperature, by colours; `halfway info` lists the properties
    #[arg(long, value_name = "PROPERTY")]
    scalars: Option<String>,
    /// The colours of the numbers [default: viridis]
    #[arg(long, requires = "scalars", value_parser = maps())]
    map: Option<ColorMap>,
    /// The numbers that the colours begin and end with [default: the least and the greatest]
    #[arg(long, requires = "scalars", value_name = "A..B", value_parser = parse::range, allow_hyphen_values = true)]
    range: Option<[f32; 2]>,
    /// Draw N lines of equal numbers, 1 to 100
    #[arg(long, requires = "scalars", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100))]
    isolines: Option<u32>,
    /// Draw a legend of the colours with this title into the picture
    #[arg(long, value_name = "TITLE")]
    legend: Option<String>,
}

impl ScalarArgs {
    /// Sets the options that are given.
    pub(crate) fn put_into(&self, options: &mut SceneOptions) {
        (options.scalars, options.legend) = (self.scalars.clone(), self.legend.clone());
        (options.map, options.range, options.isolines) = (self.map, self.range, self.isolines);
    }
}

fn maps() -> impl TypedValueParser<Value = ColorMap> {
    PossibleValuesParser::new(values::<ColorMap>()).try_map(|text| choice(&text))
}

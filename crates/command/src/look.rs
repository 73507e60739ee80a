//! `--color`, `--faces`, `--normals` and `--lights`: the looks of a model, or of all objects of a scene.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfway::lighting::LightRig;
use halfway::mesh::Normals;
use halfway::prelude::*;
use halfway::scene::options::SceneOptions;
use halfway::scene::options::parse::{self, Background};

use crate::choices::{choice, values};

/// The options hold for all objects.
#[derive(Args, Clone, Debug)]
pub(crate) struct LookArgs {
    /// The colour of all objects: #rrggbb, a CSS name such as teal, or a preset's name such as brass or red-plastic
    #[arg(long, value_name = "COLOR|PRESET", value_parser = parse::color)]
    color: Option<Material>,
    /// The sides of surfaces that are shown [default: the scene's; both for open surfaces without a material]
    #[arg(long, value_parser = faces())]
    faces: Option<Faces>,
    /// The normals: the file's own, smooth, flat, or creased where faces differ by more degrees; auto keeps the file's,
    /// and without any creases made parts [default: the scene's; auto for a model]
    #[arg(long, value_name = "auto|keep|smooth|flat|creased=DEG", value_parser = parse::normals)]
    normals: Option<Normals>,
    /// Show a checker where an image of a model is missing or broken; else its material is shown without the image
    #[arg(long)]
    mark_missing_images: bool,
    /// The background: transparent, #rrggbb (#rrggbbaa with an opacity), a CSS name, or two from above to below, as
    /// white..lightsteelblue [default: the scene's; charcoal for a model]
    #[arg(long, value_name = "COLOR[..COLOR]|transparent", value_parser = parse::background)]
    background: Option<Background>,
    /// The lights, which follow the camera [default: the scene's or the model's own; studio for a model without]
    #[arg(long, value_parser = rigs())]
    lights: Option<LightRig>,
}

impl LookArgs {
    /// Sets the options that are given.
    pub(crate) fn put_into(&self, options: &mut SceneOptions) {
        let Self { color, faces, normals, mark_missing_images, background, lights } = *self;
        (options.color, options.faces, options.normals) = (color, faces, normals);
        (options.background, options.lights) = (background, lights);
        options.mark_missing_images = mark_missing_images.then_some(true);
    }
}

fn faces() -> impl TypedValueParser<Value = Faces> {
    PossibleValuesParser::new(["front", "back", "both"]).try_map(|text| parse::faces(&text))
}

fn rigs() -> impl TypedValueParser<Value = LightRig> {
    PossibleValuesParser::new(values::<LightRig>()).try_map(|text| choice(&text))
}

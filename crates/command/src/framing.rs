//! `--view`, `--up`, `--ortho`, `--fit` and `--zoom`: the side from which the model is seen, and how large.

use clap::Args;
use halfway::lighting::View;
use halfway::prelude::Vec3;
use halfway::scene::options::{SceneOptions, parse};

/// The options replace the camera of a scene file, as far as they say otherwise.
#[derive(Args, Clone, Debug)]
pub(crate) struct FramingArgs {
    /// The side seen: front, back, left, right, top, bottom, iso, or azimuth and elevation in degrees, such as 30,20
    /// [default: the scene's camera; 30,20 for a model]
    #[arg(long, value_name = "SIDE|AZ,EL", allow_hyphen_values = true)]
    view: Option<View>,
    /// The direction that is upright in the model: y, or z as in CAD, x, -x, -y, -z [default: the scene's; y]
    #[arg(long, value_name = "AXIS", value_parser = parse::up, allow_hyphen_values = true)]
    up: Option<Vec3>,
    /// Look without perspective: parallel rays, and lengths that can be measured
    #[arg(long)]
    ortho: bool,
    /// The share of the picture that the model fills, above 0 and at most 1 [default: the scene's; 0.9 for a model]
    #[arg(long, value_name = "SHARE", value_parser = parse::fit)]
    fit: Option<f32>,
    /// Magnify the middle of the picture, so many times
    #[arg(long, value_name = "FACTOR", value_parser = parse::zoom)]
    zoom: Option<f32>,
}

impl FramingArgs {
    /// Sets the options that are given.
    pub(crate) fn put_into(&self, options: &mut SceneOptions) {
        let Self { view, up, ortho, fit, zoom } = *self;
        (options.view, options.up, options.ortho) = (view, up, ortho.then_some(true));
        (options.fit, options.zoom) = (fit, zoom);
    }
}

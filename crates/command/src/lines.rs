//! `--line-width`, `--point-size`, `--hidden-lines` and `--show`: the lines and points of models, and those that explain a
//! scene.

use clap::Args;
use halfway::lighting::{Show, Width};
use halfway::scene::options::{SceneOptions, parse};

/// Lines and points over the picture, on all objects.
#[derive(Args, Clone, Debug)]
pub(crate) struct LineArgs {
    /// The width of the models' lines in pixels, or in world units as 0.01w [default: the scene's; 1.5]
    #[arg(long, value_name = "WIDTH", value_parser = parse::width)]
    line_width: Option<Width>,
    /// The diameter of the models' points in pixels, or in world units as 0.01w [default: the scene's; 4]
    #[arg(long, value_name = "SIZE", value_parser = parse::width)]
    point_size: Option<Width>,
    /// Dash the parts of the models' lines that lie behind surfaces
    #[arg(long)]
    hidden_lines: bool,
    /// Draw lines that explain the scene: axes, normals, face-normals, lights, grid [default: the scene's]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse::shown)]
    show: Vec<&'static str>,
}

impl LineArgs {
    /// Sets the options that are given.
    pub(crate) fn put_into(&self, options: &mut SceneOptions) {
        (options.line_width, options.point_size) = (self.line_width, self.point_size);
        options.hidden_lines = self.hidden_lines.then_some(true);
        let mut show = Show::default();
        for name in &self.show {
            show.named(name).into_iter().for_each(|shown| *shown = true);
        }
        options.show = Some(show).filter(Show::any);
    }
}

//! `--line-width`, `--point-size` and `--show`: the lines and points of models, and those that explain a scene.

use clap::Args;
use halfway::lighting::{Show, Width};
use halfway::scene::LineStyleEntry;

use crate::edges::parse_width;

/// Lines and points over the picture, on all objects.
#[derive(Args, Clone, Debug)]
pub(crate) struct LineArgs {
    /// The width of the models' lines in pixels, or in world units as 0.01w [default: the scene's; 1.5]
    #[arg(long, value_name = "WIDTH", value_parser = parse_width)]
    line_width: Option<Width>,
    /// The diameter of the models' points in pixels, or in world units as 0.01w [default: the scene's; 4]
    #[arg(long, value_name = "SIZE", value_parser = parse_width)]
    point_size: Option<Width>,
    /// Draw lines that explain the scene: axes, normals, face-normals, lights, grid [default: the scene's]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_shown)]
    show: Vec<&'static str>,
}

impl LineArgs {
    /// The change of a style; `None` where nothing is asked for.
    pub(crate) fn style(&self) -> Option<impl Fn(LineStyleEntry) -> LineStyleEntry> {
        let Self { line_width, point_size, .. } = *self;
        (line_width.is_some() || point_size.is_some()).then_some(move |style: LineStyleEntry| LineStyleEntry {
            line_width: line_width.unwrap_or(style.line_width),
            point_size: point_size.unwrap_or(style.point_size),
            ..style
        })
    }

    /// The lines that are asked for.
    pub(crate) fn show(&self) -> Option<Show> {
        let mut show = Show::default();
        for name in &self.show {
            show.named(name).into_iter().for_each(|shown| *shown = true);
        }
        Some(show).filter(Show::any)
    }
}

fn parse_shown(text: &str) -> Result<&'static str, String> {
    let name = text.replace('-', "_");
    Show::NAMES.into_iter().find(|known| *known == name).ok_or_else(|| {
        let known: Vec<String> = Show::NAMES.iter().map(|name| name.replace('_', "-")).collect();
        format!("expected {}, or several of them with commas", known.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_what_is_shown() {
        assert_eq!(parse_shown("face-normals"), Ok("face_normals"));
        for bad in ["", "Axes", "axes,grid", "edges"] {
            assert!(parse_shown(bad).is_err_and(|error| error.contains("face-normals")), "{bad}");
        }
    }
}

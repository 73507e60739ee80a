//! `--edges`: lines along the edges of meshes.

use clap::Args;
use halfway::lighting::{Choices, Edges, HiddenEdges, WhichEdges, Width};
use halfway::prelude::LinearRgba;

/// Lines over the picture, on all objects.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct EdgeArgs {
    /// Draw lines along edges: all, sharp ones with borders and the silhouette (from 30°, or DEG), or these alone
    #[arg(long, value_name = "all|feature[=DEG]|boundary|silhouette", value_parser = parse)]
    edges: Option<WhichEdges>,
    /// The width of the lines in pixels, or in world units as 0.01w [default: 1.5]
    #[arg(long, value_name = "WIDTH", requires = "edges", value_parser = parse_width)]
    edge_width: Option<Width>,
    /// Dash the edges that lie behind surfaces
    #[arg(long, requires = "edges")]
    hidden_edges: bool,
    /// Draw lines along all edges, and no surfaces
    #[arg(long, conflicts_with = "edges")]
    wireframe: bool,
}

impl EdgeArgs {
    /// The lines that are asked for.
    pub(crate) fn given(self) -> Option<Edges> {
        let hidden = if self.hidden_edges { HiddenEdges::Dash } else { HiddenEdges::Omit };
        if self.wireframe {
            // Lines on black are to be seen.
            let color = LinearRgba::rgb(0.6, 0.6, 0.6);
            return Some(Edges { width: 1.0.into(), surface: false, color, ..Edges::new(WhichEdges::All) });
        }
        let edges = Edges::new(self.edges?);
        Some(Edges { width: self.edge_width.unwrap_or(edges.width), hidden, ..edges })
    }
}

fn parse(text: &str) -> Result<WhichEdges, String> {
    let expected =
        || "expected all, feature, boundary or silhouette; feature also with degrees, as feature=20".to_owned();
    let which = match text.split_once('=') {
        Some(("feature", angle)) => WhichEdges::Feature(angle.parse::<f32>().map_err(|_| expected())?.to_radians()),
        Some(_) => return Err(expected()),
        None => WhichEdges::from_key(text).ok_or_else(expected)?,
    };
    Edges::new(which).validate().map(|()| which).map_err(|_| "expected degrees from 0 to 180".to_owned())
}

pub(crate) fn parse_width(text: &str) -> Result<Width, String> {
    text.parse().map_err(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_by_their_names() {
        assert_eq!(parse("all"), Ok(WhichEdges::All));
        assert_eq!(parse("feature"), Ok(WhichEdges::SHARP));
        assert_eq!(parse("feature=20"), Ok(WhichEdges::Feature(20_f32.to_radians())));
        for bad in ["", "All", "sharp", "feature=", "feature=-1", "feature=181", "all=3", "feature=NaN"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
        assert!(["0", "-1", "wide", "inf"].into_iter().all(|bad| parse_width(bad).is_err()));
    }
}

//! `--edges`: lines along the edges of meshes.

use clap::Args;
use halfway::lighting::{WhichEdges, Width};
use halfway::scene::options::{SceneOptions, parse};

/// Lines over the picture, on all objects.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct EdgeArgs {
    /// Draw lines along edges: all, sharp ones with borders and the silhouette (from 30°, or DEG), or these alone
    #[arg(long, value_name = "all|feature[=DEG]|boundary|silhouette", value_parser = parse::edges)]
    edges: Option<WhichEdges>,
    /// The width of the lines in pixels, or in world units as 0.01w [default: 1.5]
    #[arg(long, value_name = "WIDTH", requires = "edges", value_parser = parse::width)]
    edge_width: Option<Width>,
    /// Dash the edges that lie behind surfaces
    #[arg(long, requires = "edges")]
    hidden_edges: bool,
    /// Draw lines along all edges, and no surfaces
    #[arg(long, conflicts_with = "edges")]
    wireframe: bool,
}

impl EdgeArgs {
    /// Sets the options that are given.
    pub(crate) fn put_into(self, options: &mut SceneOptions) {
        let Self { edges, edge_width, hidden_edges, wireframe } = self;
        (options.edges, options.edge_width) = (edges, edge_width);
        (options.hidden_edges, options.wireframe) = (hidden_edges.then_some(true), wireframe.then_some(true));
    }
}

//! `cargo xtask chart`.

use clap::Args;

use super::program::{self, Program};
use crate::cargo::root;
use crate::failure::Result;
use crate::setup::Setup;

/// Where the page goes.
const FOLDER: &str = "out/chart";
/// The README's chart, made again by all but quick runs.
const PICTURE: &str = "docs/pictures/chart.svg";
/// Who wins where, likewise.
const TABLES: &str = "docs/fronts.md";

/// Measure what shading costs and what it loses, and write a page of charts to out/chart/
///
/// Error against time of every method on every scene, rates of convergence, how steady a moving highlight is, and how
/// the time of a frame grows with triangles, objects, lights and pixels. Writes a page that opens offline,
/// out/chart/index.html, with chart.json, every table as CSV and every chart as SVG beside it, and makes
/// docs/pictures/chart.svg and docs/fronts.md again. An interrupted run goes on where it stopped when it is
/// started again. docs/charts.md tells what is measured and how.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Fewer methods, details, rounds and pixels, in less than two minutes; docs/ stays as it is
    #[arg(long)]
    quick: bool,
    /// Only how the time of a frame grows, on out/chart/scaling.html; docs/ stays as it is
    #[arg(long)]
    scaling: bool,
}

/// Sets up, builds, measures and writes the page.
pub(crate) fn run(options: &Options) -> Result {
    let &Options { setup, quick, scaling } = options;
    program::run("measuring", setup, Program::Binary("halfway"), arguments(quick, scaling))?;
    let page = if scaling { "scaling.html" } else { "index.html" };
    eprintln!("\nthe charts: {}", root().join(FOLDER).join(page).display());
    Ok(())
}

fn arguments(quick: bool, scaling: bool) -> Vec<&'static str> {
    let mut arguments = vec!["chart", "--output", FOLDER];
    arguments.extend(quick.then_some("--quick"));
    arguments.extend(scaling.then_some("--scaling"));
    if !quick && !scaling {
        arguments.extend(["--small-chart", PICTURE, "--tables", TABLES]);
    }
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_runs_leave_the_documentation_alone() {
        let rows = [
            (true, false, "--quick"),
            (false, true, "--scaling"),
            (true, true, "--quick --scaling"),
            (false, false, "--small-chart docs/pictures/chart.svg --tables docs/fronts.md"),
        ];
        for (quick, scaling, end) in rows {
            assert_eq!(arguments(quick, scaling).join(" "), format!("chart --output out/chart {end}"));
        }
    }
}

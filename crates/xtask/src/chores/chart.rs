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
/// What filters of images cost and lose; made again by their own runs but quick ones.
const FILTER_TABLES: &str = "docs/filters.md";

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
    /// Fewer methods, details, rounds and pixels, in some two minutes; docs/ stays as it is
    #[arg(long)]
    quick: bool,
    /// Only how the time of a frame grows, on out/chart/scaling.html; docs/ stays as it is
    #[arg(long)]
    scaling: bool,
    /// Only what filters of images cost and lose, on out/chart/filters.html; in full also docs/filters.md
    #[arg(long, conflicts_with = "scaling")]
    filters: bool,
}

/// Sets up, builds, measures and writes the page.
pub(crate) fn run(options: &Options) -> Result {
    let &Options { setup, quick, scaling, filters } = options;
    let part = match (scaling, filters) {
        (true, _) => Measured::Scaling,
        (_, true) => Measured::Filters,
        _ => Measured::All,
    };
    program::run("measuring", setup, Program::Binary("halfway"), arguments(quick, part))?;
    let page = match part {
        Measured::All => "index.html",
        Measured::Scaling => "scaling.html",
        Measured::Filters => "filters.html",
    };
    eprintln!("\nthe charts: {}", root().join(FOLDER).join(page).display());
    Ok(())
}

/// What is measured.
#[derive(Clone, Copy)]
enum Measured {
    All,
    Scaling,
    Filters,
}

fn arguments(quick: bool, part: Measured) -> Vec<&'static str> {
    let mut arguments = vec!["chart", "--output", FOLDER];
    arguments.extend(quick.then_some("--quick"));
    let (own, of_docs): (&[&str], &[&str]) = match part {
        Measured::All => (&[], &["--small-chart", PICTURE, "--tables", TABLES]),
        Measured::Scaling => (&["--scaling"], &[]),
        Measured::Filters => (&["--filters"], &["--tables", FILTER_TABLES]),
    };
    arguments.extend(own);
    if !quick {
        arguments.extend(of_docs);
    }
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_runs_leave_the_documentation_alone() {
        let rows = [
            (true, Measured::All, "--quick"),
            (false, Measured::Scaling, "--scaling"),
            (true, Measured::Scaling, "--quick --scaling"),
            (true, Measured::Filters, "--quick --filters"),
            (false, Measured::Filters, "--filters --tables docs/filters.md"),
            (false, Measured::All, "--small-chart docs/pictures/chart.svg --tables docs/fronts.md"),
        ];
        for (quick, part, end) in rows {
            assert_eq!(arguments(quick, part).join(" "), format!("chart --output out/chart {end}"));
        }
    }
}

//! `cargo xtask chart`.

use clap::Args;

use super::program::{self, Program};
use crate::cargo::root;
use crate::failure::Result;

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
/// Error against time of every method on every scene, far lights and viewers, and where methods fail. Writes a page that
/// opens offline, out/chart/index.html, with chart.json and every chart as SVG beside it, and docs/pictures/chart.svg and
/// docs/fronts.md. docs/charts.md tells what is measured and how.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    /// Fewer methods, details, rounds and pixels, in some two minutes; docs/ stays as it is
    #[arg(long)]
    quick: bool,
    /// Only what filters of images cost and lose, on out/chart/filters.html; in full also docs/filters.md
    #[arg(long)]
    filters: bool,
}

/// Builds, measures and writes the page.
pub(crate) fn run(options: &Options) -> Result {
    program::run("measuring", Program::Binary("halfway"), arguments(options))?;
    let page = if options.filters { "filters.html" } else { "index.html" };
    eprintln!("\nthe charts: {}", root().join(FOLDER).join(page).display());
    Ok(())
}

fn arguments(options: &Options) -> Vec<&'static str> {
    let mut arguments = vec!["chart", "--output", FOLDER];
    arguments.extend(options.quick.then_some("--quick"));
    arguments.extend(options.filters.then_some("--filters"));
    match (options.quick, options.filters) {
        (true, _) => {}
        (false, true) => arguments.extend(["--tables", FILTER_TABLES]),
        (false, false) => arguments.extend(["--small-chart", PICTURE, "--tables", TABLES]),
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
            (true, true, "--quick --filters"),
            (false, true, "--filters --tables docs/filters.md"),
            (false, false, "--small-chart docs/pictures/chart.svg --tables docs/fronts.md"),
        ];
        for (quick, filters, end) in rows {
            let found = arguments(&Options { quick, filters }).join(" ");
            assert_eq!(found, format!("chart --output out/chart {end}"));
        }
    }
}

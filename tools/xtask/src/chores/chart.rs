//! `cargo xtask chart`.

use clap::Args;

use super::program::{self, Program};
use crate::cargo::root;
use crate::failure::Result;

/// The folder of the page.
const FOLDER: &str = "out/chart";
/// The README's chart, made again by all but quick runs.
const PICTURE: &str = "docs/pictures/chart.svg";
/// The tables of the fastest methods, likewise.
const TABLES: &str = "docs/fronts.md";
/// The tables of texture filters; written by their own runs except quick ones.
const FILTER_TABLES: &str = "docs/filters.md";

/// Measure the cost and the error of shading, and write a page of charts to out/chart/
///
/// Error against time of every method on every scene, distant lights and viewers, and known failure modes. Writes a
/// page that opens offline, out/chart/index.html, with chart.json and every chart as SVG beside it, and
/// docs/pictures/chart.svg and docs/fronts.md. docs/charts.md explains the measurements.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    /// Fewer methods, details, rounds and pixels, in some two minutes; docs/ stays as it is
    #[arg(long)]
    quick: bool,
    /// Only the cost and the error of texture filters, on out/chart/filters.html; in full also docs/filters.md
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

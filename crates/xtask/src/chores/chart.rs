//! `cargo xtask chart`.

use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::failure::Result;
use crate::setup::{DRIVER, Setup, adapters};

/// Where the page goes.
const FOLDER: &str = "out/chart";
/// The README's chart, made again by all but quick runs.
const PICTURE: &str = "docs/pictures/chart.svg";

/// Measure what shading costs and what it loses, and write a page of charts to out/chart/
///
/// Error against time, rates of convergence, how steady a moving highlight is, and how the time of a frame grows
/// with triangles, objects, lights and pixels. Writes a page that opens offline, out/chart/index.html, with every
/// table as CSV and every chart as SVG beside it, and makes docs/pictures/chart.svg again. docs/charts.md tells
/// what is measured and how.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Fewer tessellations, rounds, frames and pixels, in less than two minutes; docs/ stays as it is
    #[arg(long)]
    quick: bool,
    /// Only how the time of a frame grows, on out/chart/scaling.html; docs/ stays as it is
    #[arg(long)]
    scaling: bool,
}

/// Sets up, builds, measures and writes the page.
pub(crate) fn run(options: &Options) -> Result {
    let &Options { setup, quick, scaling } = options;
    setup.meet(&[DRIVER])?;
    step("build", &mut cargo(["build", "--release", "-p", "halfway_command", "-p", "halfway_chart", "--bins"]))?;
    adapters(setup)?;
    step("measuring", &mut measuring(quick, scaling))?;
    let page = if scaling { "scaling.html" } else { "index.html" };
    eprintln!("\nthe charts: {}", root().join(FOLDER).join(page).display());
    Ok(())
}

fn measuring(quick: bool, scaling: bool) -> Command {
    let mut command = cargo(["run", "--release", "--quiet", "-p", "halfway_chart", "--", "--output", FOLDER]);
    if quick {
        command.arg("--quick");
    }
    if scaling {
        command.arg("--scaling");
    }
    if !quick && !scaling {
        command.args(["--small-chart", PICTURE]);
    }
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cargo::written;

    #[test]
    fn quick_runs_leave_the_documentation_alone() {
        let start = "cargo run --release --quiet -p halfway_chart -- --output out/chart";
        for (quick, scaling, end) in
            [(true, false, "--quick"), (false, true, "--scaling"), (true, true, "--quick --scaling")]
        {
            assert!(written(&measuring(quick, scaling)).ends_with(&format!("{} {end}", &start[5..])));
        }
        assert!(
            written(&measuring(false, false))
                .ends_with(&format!("{} --small-chart docs/pictures/chart.svg", &start[5..]))
        );
    }
}

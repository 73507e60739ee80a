//! `cargo xtask chart`.

use std::process::Command;

use crate::cargo::{cargo, root, step};
use crate::failure::Result;
use crate::setup::{DRIVER, Setup, adapters};

/// Where the page goes.
const FOLDER: &str = "out/chart";
/// The README's chart, made again by all but quick runs.
const PICTURE: &str = "docs/pictures/chart.svg";

/// Sets up, builds, measures and writes the page.
pub(crate) fn run(setup: Setup, quick: bool, scaling: bool) -> Result {
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

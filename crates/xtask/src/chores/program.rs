//! Chores that are programs of this workspace: set-up, build, run.

use std::ffi::OsStr;
use std::process::Command;

use crate::cargo::{cargo, step};
use crate::failure::Result;
use crate::setup::{DRIVER, Setup, adapters};

/// Sees to an adapter to draw with, builds a program and runs it with `arguments`. `target` names it for cargo:
/// `["-p", "halfway_chart"]` or `["--example", "teapots"]`.
pub(crate) fn run<A: AsRef<OsStr>>(
    title: &str,
    setup: Setup,
    target: &[&str],
    arguments: impl IntoIterator<Item = A>,
) -> Result {
    setup.meet(&[DRIVER])?;
    step("build", cargo(["build", "--release"]).args(target))?;
    adapters(setup)?;
    step(title, &mut command(target, arguments))
}

fn command<A: AsRef<OsStr>>(target: &[&str], arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = cargo(["run", "--release", "--quiet"]);
    command.args(target).arg("--").args(arguments);
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cargo::written;

    #[test]
    fn arguments_are_the_program_s() {
        let command = written(&command(&["--example", "teapots"], ["--frames", "3"]));
        assert!(command.ends_with("run --release --quiet --example teapots -- --frames 3"), "{command}");
    }
}

//! `cargo xtask test`.

use std::process::Command;
use std::time::Instant;

use clap::Args;

use super::adapters::{self, CHOICE, ON_THE_CPU, SHARE, units_about_drivers, without_drivers};
use super::instructions;
use super::wheel;
use crate::cargo::{cargo, duration, root, step};
use crate::checks::metadata::test_programs;
use crate::failure::{Failure, Result};
use crate::setup::{BROWSER, COMPOSITOR, Need, Setup, VIRTUAL_SCREEN, WAYLAND_WINDOWS, WINDOW_MANAGER, X11_WINDOWS};
use crate::tally::{Tally, counted};

/// Run the tests that need nothing but Rust and a C compiler, or with --all every test there is
///
/// Unit tests, documentation examples and the tests of pictures, drawn by the CPU without a driver, in the release
/// profile, with a summary at the end; nothing is installed.
///
/// --all then also runs the tests of the window, of the charts' page in a browser and of graphics drivers, and those of
/// pictures on each driver that a bare Debian can have. Missing requirements (Vulkan and OpenGL drivers, the virtual
/// screen Xvfb, the window manager openbox, the Wayland compositor weston, the browser chromium, valgrind) are installed
/// by apt-get where it may be used; otherwise the packages are named.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Run every test, on every adapter; install what they need
    #[arg(long)]
    all: bool,
    /// Test the package for Python beside those of others, which are installed from `PyPI` into target/wheel-peers
    #[arg(long, conflicts_with = "all")]
    peers: bool,
    /// Have each driver draw a share of the rows with textures, whose shaders take minutes to compile, and not all
    #[arg(long, requires = "all")]
    shared: bool,
}

/// The requirements of the tests beside drivers: a screen with windows, and a browser.
const NEEDS: [Need; 6] = [VIRTUAL_SCREEN, WINDOW_MANAGER, X11_WINDOWS, COMPOSITOR, WAYLAND_WINDOWS, BROWSER];

/// Test programs that need a driver or a screen as a whole.
const ABOUT_MACHINES: [&str; 2] = ["twins", "window"];
/// The module of tests that need a browser.
const IN_A_BROWSER: &str = "browser::";
/// Programs of tests that run once more where a driver draws.
const BY_A_DRIVER: [&str; 5] = ["render", "wild", "examples", "allocations", "command"];

const NOT_RUN: &str = "\
not run:
   the window, on X and on Wayland
   the page of the charts, in a browser
   shaders against their twins in Rust, pipelines, devices that are lost: on a graphics driver
   the same pictures on Vulkan, OpenGL and SwiftShader
   the instructions that frames take, against those that are kept
These run, too, and what they need is installed, by

    cargo xtask test --all";

/// Runs the tests that were asked for.
pub(crate) fn run(options: &Options) -> Result {
    if options.peers {
        return wheel::beside_peers(options.setup);
    }
    by_the_cpu()?;
    if options.all {
        on_drivers(options)?;
        return instructions::where_counted(options.setup);
    }
    eprintln!("\n{NOT_RUN}");
    Ok(())
}

/// The tests that any machine can run.
fn by_the_cpu() -> Result {
    let programs = test_programs(&root())?;
    let programs = programs.iter().filter(|name| !ABOUT_MACHINES.contains(&name.as_str()));
    // The tests of the examples run the binaries that users build.
    step("examples", &mut cargo(["build", "--release", "--workspace", "--examples"]))?;
    let mut tests = tests_of(["--lib", "--bins"].into_iter().chain(programs.flat_map(|name| ["--test", name])));
    tests.arg("--").args(["--skip", IN_A_BROWSER]).args(without_drivers());
    let mut documentation = tests_of(["--doc"]);
    for command in [&mut tests, &mut documentation] {
        command.env(CHOICE, "cpu").env_remove(SHARE);
    }
    all_of([("tests", tests), ("examples of the documentation", documentation)])
}

/// The tests that take a driver, a screen or a browser, and the tests of pictures on every adapter.
fn on_drivers(options: &Options) -> Result {
    options.setup.meet(&[&NEEDS[..], &adapters::NEEDS].concat())?;
    let programs = BY_A_DRIVER.iter().chain(&ABOUT_MACHINES).flat_map(|name| ["--test", name]);
    let mut programs = tests_of(programs);
    programs.args(["--", "--skip", ON_THE_CPU]);
    let mut others = tests_of(["--lib", "--tests"]);
    others.args(["--", IN_A_BROWSER]).args(units_about_drivers());
    step("build", &mut cargo(["test", "--release", "--workspace", "--no-run"]))?;
    // Without hardware the CPU would draw, whose tests have run already.
    let choice = std::env::var(CHOICE).unwrap_or_else(|_| "gpu".to_owned());
    // Other systems have a display of their own.
    let (share, adapters) =
        if cfg!(target_os = "linux") { adapters::others(&choice, options.shared)? } else { (None, Vec::new()) };
    for command in [&mut programs, &mut others] {
        command.env(CHOICE, &choice).envs(share.iter().map(|share| (SHARE, share)));
        if cfg!(target_os = "linux") {
            // Windows open on a virtual screen even if there is a display, so that none disturbs the user and no key
            // press of the user reaches them.
            command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        }
    }
    all_of([("tests on a driver", programs), ("what else takes one, and the browser", others)])?;
    adapters::try_each(adapters)
}

/// The cargo command for tests of the whole workspace, which continues after failures.
fn tests_of<'a>(targets: impl IntoIterator<Item = &'a str>) -> Command {
    cargo(["test", "--release", "--workspace", "--no-fail-fast"].into_iter().chain(targets))
}

/// Runs all of the commands, and sums up.
fn all_of<const N: usize>(commands: [(&str, Command); N]) -> Result {
    let start = Instant::now();
    let mut tally = Tally::default();
    let mut outcome = Ok(());
    for (title, mut command) in commands {
        let (more, ended) = counted(title, &mut command)?;
        tally.add(more);
        outcome = outcome.and(ended);
    }
    eprintln!("\n── {}\n{tally}", duration(start.elapsed()));
    outcome?;
    if tally.passed == 0 { Err(Failure::new("no test ran")) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skipped_tests_exist() {
        let programs = test_programs(&root()).unwrap();
        for name in ABOUT_MACHINES.iter().chain(&BY_A_DRIVER) {
            assert!(programs.iter().any(|program| program == name), "{name} is no program of tests: {programs:?}");
        }
        assert!(root().join("crates/chart/tests/chart/browser.rs").is_file(), "the tests in a browser are elsewhere");
    }
}

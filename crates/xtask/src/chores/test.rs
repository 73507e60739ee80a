//! `cargo xtask test`.

use std::env;
use std::process::Command;
use std::time::Instant;

use clap::Args;

use crate::cargo::{cargo, duration, step};
use crate::chores::adapters as each_adapter;
use crate::failure::{Failure, Result};
use crate::machine::programs;
use crate::setup::{BROWSER, COMPOSITOR, SCREEN, Setup, WAYLAND_WINDOWS, WINDOW_MANAGER, X11_WINDOWS, adapters};
use crate::tally::counted;

/// Run every test, those that need a graphics adapter or a window included
///
/// Documentation examples included, in the release profile, with a summary at the end. No test is skipped for want of
/// an adapter, a screen or a browser: what they need and the machine lacks (Vulkan drivers, OpenGL, the virtual screen
/// Xvfb, the window manager openbox, the Wayland compositor weston, the browser chromium) is installed first, by
/// apt-get where it may be used; otherwise nothing is built, and the remedy is printed. With `HALFWAY_SHARE=1/4` the
/// tests draw a quarter of the rows with textures, and each of three other drivers another.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
}

/// Sets up, builds, runs every test and sums up.
pub(crate) fn run(options: &Options) -> Result {
    let setup = options.setup;
    let start = Instant::now();
    setup.meet(
        &[&[SCREEN, WINDOW_MANAGER, X11_WINDOWS, COMPOSITOR, WAYLAND_WINDOWS, BROWSER][..], &each_adapter::NEEDS]
            .concat(),
    )?;
    // Without a choice of targets these are all tests of libraries, programs, `tests/` and the documentation; the
    // examples are built beside them as programs, which `tests/` runs.
    step("build", &mut cargo(["test", "--release", "--workspace", "--no-run"]))?;
    adapters(setup)?;
    // Without hardware the CPU would draw; it has its turn with the other adapters.
    let choice = env::var("HALFWAY_ADAPTER").unwrap_or_else(|_| "gpu".to_owned());
    // Elsewhere than on Linux there is the system's own.
    let others = if cfg!(target_os = "linux") { each_adapter::others(&choice)? } else { Vec::new() };
    let mut command = cargo(["test", "--release", "--workspace", "--no-fail-fast"]);
    give_own_screen(&mut command);
    command.env("HALFWAY_ADAPTER", &choice);
    let tally = counted("tests", &mut command);
    eprintln!("\n── {}", duration(start.elapsed()));
    let (tally, outcome) = tally?;
    eprintln!("{tally}");
    outcome?;
    if tally.passed == 0 {
        return Err(Failure::new("no test ran"));
    }
    each_adapter::try_each(others)
}

/// Where the virtual screen is installed, the tests open their windows there, whatever display is at hand: none flashes
/// up in front of somebody who works, and no key that they press goes astray.
fn give_own_screen(command: &mut Command) {
    if programs::find("Xvfb").is_some() {
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    }
}

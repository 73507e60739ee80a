//! `cargo xtask screen`.

use std::ffi::OsString;
use std::process::Command;

use clap::Args;

use crate::cargo::step;
use crate::failure::Result;
use crate::screen::VirtualScreen;
use crate::setup::{Setup, VIRTUAL_SCREEN};

/// Run a command on a virtual screen of its own
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// The command and its arguments
    #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    command: Vec<OsString>,
}

/// Sets up, starts the screen and runs the command there.
pub(crate) fn run(options: &Options) -> Result {
    options.setup.meet(&[VIRTUAL_SCREEN])?;
    let screen = VirtualScreen::start()?;
    let mut command = Command::new(&options.command[0]);
    step("on a virtual screen", screen.lend(command.args(&options.command[1..])))
}

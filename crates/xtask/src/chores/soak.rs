//! `cargo xtask soak`.

use std::ffi::OsString;

use clap::Args;

use super::program::{self, Program};
use crate::failure::Result;
use crate::setup::Setup;

/// Run a scene in which everything changes for 100,000 frames, and fail where memory grows
///
/// It also fails where a frame has an error, and where the last picture is another than that of the same scene in a
/// new App. The example `soak` says what changes, and by how much memory may grow. Without a graphics card it draws on
/// the CPU; `HALFWAY_ADAPTER=gpu` has a software driver draw.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// The example's own arguments: `--frames N`, at least 2000, and `--leak`, which has to fail
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

/// Sets up, builds and runs.
pub(crate) fn run(options: &Options) -> Result {
    program::run("soak", options.setup, Program::Example("soak"), &options.arguments)
}

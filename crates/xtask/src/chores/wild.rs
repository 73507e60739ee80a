//! `cargo xtask wild`.

use std::ffi::OsString;

use clap::Args;

use super::program::{self, Program};
use crate::failure::Result;
use crate::setup::Setup;

/// Draw random scenes, judge each by the reference renderer, and make those that fail small
///
/// A failure is printed and written to out/wild/ as a scene file. The same seed means the same scenes on every machine.
/// Options are those of the program: --seed N, --scenes N, --first N, --adapter NAME, --trials N, --output
/// FOLDER; `cargo xtask wild -- --help` tells of them.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// The options of the program
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

/// Sets up, builds and starts the program.
pub(crate) fn run(options: &Options) -> Result {
    program::run("random scenes", options.setup, Program::Binary("halfway-wild"), &options.arguments)
}

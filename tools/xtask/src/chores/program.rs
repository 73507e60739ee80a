//! Chores that are programs of this workspace: build, run.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::failure::{Failure, Result};

/// The arguments of a program.
#[derive(Args, Debug)]
pub(crate) struct Arguments {
    /// The program's own arguments
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

/// Draws random scenes.
pub(crate) fn wild(options: &Arguments) -> Result {
    run("random scenes", Program::Binary("halfway-wild"), &options.arguments)
}

/// Draws a scene in which everything changes, for a long time.
pub(crate) fn soak(options: &Arguments) -> Result {
    run("soak", Program::Example("soak"), &options.arguments)
}

/// A program of this workspace, by its name.
#[derive(Clone, Copy)]
pub(crate) enum Program {
    Binary(&'static str),
    Example(&'static str),
}

/// Builds a program and runs it with `arguments`.
pub(crate) fn run<A: AsRef<OsStr>>(title: &str, program: Program, arguments: impl IntoIterator<Item = A>) -> Result {
    step(title, Command::new(build(program)?).args(arguments).current_dir(root()))
}

/// Builds a program; its path.
///
/// It is built as a part of the workspace and beside an example, as for the tests: else its dependencies would have
/// other features, and most of them would be built once more.
pub(crate) fn build(program: Program) -> Result<PathBuf> {
    let beside = Program::Example("first_picture").target();
    step("build", cargo(["build", "--release", "--workspace"]).args(program.target()).args(beside))?;
    program.built()
}

impl Program {
    /// Its target for cargo.
    fn target(self) -> [&'static str; 2] {
        match self {
            Self::Binary(name) => ["--bin", name],
            Self::Example(name) => ["--example", name],
        }
    }

    /// Its path: in the folder of this program's own profile.
    fn built(self) -> Result<PathBuf> {
        let here =
            std::env::current_exe().map_err(|error| Failure::new(format!("the folder of this program: {error}")))?;
        let target = here.ancestors().find(|folder| folder.join("release").is_dir());
        let folder = target.unwrap_or(&here).join("release");
        let file = |name: &str| format!("{name}{}", std::env::consts::EXE_SUFFIX);
        Ok(match self {
            Self::Binary(name) => folder.join(file(name)),
            Self::Example(name) => folder.join("examples").join(file(name)),
        })
    }
}

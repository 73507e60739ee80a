//! Chores that are programs of this workspace: set-up, build, run.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

use crate::cargo::{cargo, root, step};
use crate::checks::metadata::target_folder;
use crate::failure::Result;
use crate::setup::{DRIVER, Setup, adapters};

/// A program of this workspace, by its name.
#[derive(Clone, Copy)]
pub(crate) enum Program {
    Binary(&'static str),
    Example(&'static str),
}

/// Sees to an adapter to draw with, builds a program and runs it with `arguments`.
///
/// It is built as a part of the workspace: chosen by its package, its dependencies would have other features than for
/// the tests, and most of them would be built once more.
pub(crate) fn run<A: AsRef<OsStr>>(
    title: &str,
    setup: Setup,
    program: Program,
    arguments: impl IntoIterator<Item = A>,
) -> Result {
    setup.meet(&[DRIVER])?;
    step("build", cargo(["build", "--release", "--workspace"]).args(program.target()))?;
    adapters(setup)?;
    step(title, Command::new(program.built()?).args(arguments).current_dir(root()))
}

impl Program {
    /// What names it for cargo.
    fn target(self) -> [&'static str; 2] {
        match self {
            Self::Binary(name) => ["--bin", name],
            Self::Example(name) => ["--example", name],
        }
    }

    /// Where cargo puts it.
    fn built(self) -> Result<PathBuf> {
        let folder = target_folder(&root())?.join("release");
        let file = |name: &str| format!("{name}{}", std::env::consts::EXE_SUFFIX);
        Ok(match self {
            Self::Binary(name) => folder.join(file(name)),
            Self::Example(name) => folder.join("examples").join(file(name)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_found_where_cargo_puts_them() {
        let ends =
            [(Program::Binary("halfway-wild"), "release/halfway-wild"), (Program::Example("soak"), "examples/soak")];
        for (program, end) in ends {
            let built = program.built().unwrap().with_extension("");
            assert!(built.ends_with(end), "{}", built.display());
        }
    }
}

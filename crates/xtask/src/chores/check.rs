//! `cargo xtask check`.

use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, step};
use crate::failure::{Failure, Result};

/// Check the formatting, lints, documentation and smallest build, all of which must be clean
#[derive(Args, Debug)]
pub(crate) struct Options {}

/// Runs every check, and then says which failed.
pub(crate) fn run(_: &Options) -> Result {
    let failures: Vec<String> = checks()
        .into_iter()
        .filter_map(|(title, mut command)| {
            step(title, &mut command).err().map(|failure| format!("  {title}: {failure}"))
        })
        .collect();
    if failures.is_empty() {
        eprintln!("\nall checks passed");
        return Ok(());
    }
    Err(Failure::new(format!("{} failed:\n{}", count(failures.len()), failures.join("\n"))))
}

fn count(failures: usize) -> String {
    if failures == 1 { "1 check".into() } else { format!("{failures} checks") }
}

fn checks() -> [(&'static str, Command); 4] {
    let mut documentation = cargo(["doc", "--release", "--workspace", "--no-deps"]);
    documentation.env("RUSTDOCFLAGS", "-D warnings");
    [
        ("formatting", cargo(["fmt", "--all", "--check"])),
        ("lints", cargo(["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"])),
        ("documentation", documentation),
        // Nothing else builds the library as those get it who bring their own window.
        ("smallest build", cargo(["check", "--release", "-p", "halfway", "--no-default-features", "--lib"])),
    ]
}

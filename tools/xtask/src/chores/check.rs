//! `cargo xtask check`.

use clap::{Args, ValueEnum};

use crate::cargo::{cargo, duration, printed, root, step};
use crate::checks::{circles, doors};
use crate::failure::{Failure, Result};

/// Run the checks that must pass before a change is merged; all of them run, even if one fails
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Only these; all where none is named
    #[arg(value_enum)]
    checks: Vec<Check>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Check {
    /// The formatting is cargo fmt's
    Formatting,
    /// Each crate imports only what its door allows
    Doors,
    /// No files of a crate import each other in a circle
    Circles,
    /// Clippy and the compiler have no warnings
    Lints,
    /// The documentation builds without warnings
    Documentation,
    /// The library builds without a window, and without wgpu draws a picture
    Smallest,
}

/// Runs the checks, and then lists those that failed.
pub(crate) fn run(options: &Options) -> Result {
    let all = Check::value_variants();
    let chosen = if options.checks.is_empty() { all } else { &options.checks };
    let mut failures = Vec::new();
    for &check in chosen {
        if let Err(failure) = check.run() {
            failures.push(format!("  {}: {failure}", check.name()));
        }
    }
    if failures.is_empty() {
        eprintln!("\nall checks passed");
        return Ok(());
    }
    Err(Failure::new(format!("{} failed:\n{}", count(failures.len()), failures.join("\n"))))
}

fn count(failures: usize) -> String {
    if failures == 1 { "1 check".into() } else { format!("{failures} checks") }
}

impl Check {
    fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }

    fn run(self) -> Result {
        let root = root();
        let by_cargo = |words: &[&str]| step(&self.name(), &mut cargo(words));
        let own = |check: &dyn Fn() -> Result| {
            eprintln!("\n── {}", self.name());
            let start = std::time::Instant::now();
            check()?;
            eprintln!("   {}", duration(start.elapsed()));
            Ok(())
        };
        match self {
            Self::Formatting => by_cargo(&["fmt", "--all", "--check"]),
            Self::Doors => own(&|| doors::run(&root)),
            Self::Circles => own(&|| circles::run(&root)),
            Self::Lints => by_cargo(&["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"]),
            Self::Documentation => {
                let mut command = cargo(["doc", "--release", "--workspace", "--no-deps"]);
                step(&self.name(), command.env("RUSTDOCFLAGS", "-D warnings"))
            }
            Self::Smallest => {
                by_cargo(&[
                    "check",
                    "--release",
                    "-p",
                    "halfway",
                    "--no-default-features",
                    "--features",
                    "wgpu",
                    "--lib",
                ])?;
                own(&|| without_wgpu(&root))?;
                let draw = ["run", "--release", "-p", "halfway", "--no-default-features", "--example", "first_picture"];
                let into = ["--", "--headless", "out/first_picture.png", "--size", "64x48"];
                by_cargo(&[&draw[..], &into].concat())
            }
        }
    }
}

/// Checks that the library without its features depends on no crate for graphics drivers or windows.
fn without_wgpu(root: &std::path::Path) -> Result {
    std::fs::create_dir_all(root.join("out")).map_err(|error| Failure::new(format!("out: {error}")))?;
    let tree = ["tree", "-p", "halfway", "--no-default-features", "-e", "normal", "--prefix", "none"];
    let tree = String::from_utf8_lossy(&printed(&mut cargo(tree))?).into_owned();
    let found = tree.lines().find(|line| ["wgpu", "naga", "winit"].iter().any(|name| line.starts_with(name)));
    found.map_or(Ok(()), |line| Err(Failure::new(format!("halfway without its features depends on {line}"))))
}

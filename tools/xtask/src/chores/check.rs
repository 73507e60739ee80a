//! `cargo xtask check`.

use std::collections::BTreeSet;

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
    /// It builds without a window, draws without wgpu, and its parts need few crates without the ECS
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
                for part in PARTS {
                    by_cargo(&[&["check", "--release", "--lib"], &part.choice()[..]].concat())?;
                    own(&|| part.has_few_crates())?;
                }
                let draw = ["run", "--release", "-p", "halfway", "--no-default-features", "--example", "first_picture"];
                let into = ["--", "--headless", "out/first_picture.png", "--size", "64x48"];
                by_cargo(&[&draw[..], &into].concat())
            }
        }
    }
}

/// A crate without its default features, and the number of crates it may consist of, itself included.
struct Part {
    name: &'static str,
    features: &'static str,
    most_crates: usize,
}

/// The crates that serve without an ECS.
const PARTS: [Part; 4] = [
    Part { name: "halfway_lighting", features: "", most_crates: 12 },
    Part { name: "halfway_mesh", features: "", most_crates: 18 },
    Part { name: "halfway_mesh", features: "formats", most_crates: 34 },
    Part { name: "halfway_mesh", features: "threemf", most_crates: 49 },
];

impl Part {
    fn choice(&self) -> [&str; 5] {
        ["-p", self.name, "--no-default-features", "--features", self.features]
    }

    fn has_few_crates(&self) -> Result {
        let tree = ["tree", "-e", "normal", "--prefix", "none", "--no-dedupe"];
        let tree = printed(&mut cargo([&tree[..], &self.choice()].concat()))?;
        let tree = String::from_utf8_lossy(&tree);
        let crates: BTreeSet<&str> = tree.lines().filter(|line| !line.is_empty()).collect();
        if crates.len() <= self.most_crates {
            return Ok(());
        }
        let listed: Vec<_> = crates.iter().map(|line| format!("    {line}")).collect();
        let with = if self.features.is_empty() { String::new() } else { format!(" with {}", self.features) };
        Err(Failure::new(format!(
            "{}{with} consists of {} crates; at most {} are expected:\n{}",
            self.name,
            crates.len(),
            self.most_crates,
            listed.join("\n")
        )))
    }
}

/// Expects nothing of graphics drivers or windows in the library without its features.
fn without_wgpu(root: &std::path::Path) -> Result {
    std::fs::create_dir_all(root.join("out")).map_err(|error| Failure::new(format!("out: {error}")))?;
    let tree = ["tree", "-p", "halfway", "--no-default-features", "-e", "normal", "--prefix", "none"];
    let tree = String::from_utf8_lossy(&printed(&mut cargo(tree))?).into_owned();
    let found = tree.lines().find(|line| ["wgpu", "naga", "winit"].iter().any(|name| line.starts_with(name)));
    found.map_or(Ok(()), |line| Err(Failure::new(format!("halfway without its features depends on {line}"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_without_the_ecs_have_few_crates() {
        for part in PARTS {
            part.has_few_crates().expect("no more crates than it may have");
        }
        let refused = Part { most_crates: 5, ..PARTS[0] }.has_few_crates().unwrap_err().to_string();
        assert!(refused.starts_with("halfway_lighting consists of 12 crates; at most 5 are expected:\n"), "{refused}");
        assert!(refused.contains("\n    glam v0."), "{refused}");
    }
}

//! The oldest Rust that the manifests promise builds the project, and every place names the same one.

use std::path::Path;
use std::process::Command;

use super::metadata::packages;
use super::none_of;
use crate::cargo::{cargo, not_started, step, written};
use crate::failure::{Failure, Result};
use crate::machine::programs;
use crate::setup::Setup;

/// Builds the workspace in `root` by the oldest Rust, unless the one at work is that.
pub(crate) fn run(root: &Path, setup: Setup) -> Result {
    let named = named(root)?;
    none_of(&disagreements(&named))?;
    let oldest = &named[0].1;
    if is_release_of(&own_version()?, oldest) {
        eprintln!("   this is Rust {oldest}, the oldest one promised; all that is built here shows that it will do");
        return Ok(());
    }
    let toolchain = toolchain(oldest, setup)?;
    let mut check = Command::new("rustup");
    check.args(["run", &toolchain, "cargo", "check", "--release", "--workspace", "--all-targets"]);
    step(&format!("with Rust {oldest}"), check.current_dir(root))
}

/// The places that name the oldest Rust, and what they say, the manifests of the workspace first.
fn named(root: &Path) -> Result<Vec<(String, String)>> {
    let mut named: Vec<_> = packages(root)?.into_iter().map(|package| (package.name, package.rust_version)).collect();
    for (file, before) in [("fuzz/Cargo.toml", "rust-version = \""), ("README.md", "Rust ")] {
        let text =
            std::fs::read_to_string(root.join(file)).map_err(|error| Failure::new(format!("{file}: {error}")))?;
        named.push((file.into(), version_after(&text, before)));
    }
    Ok(named)
}

/// The first number of the form 1.95 that stands right after `before`, or nothing.
fn version_after(text: &str, before: &str) -> String {
    let digits = |rest: &str| rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect::<String>();
    let found = text.split(before).skip(1).map(digits).find(|version| version.contains('.'));
    found.unwrap_or_default().trim_end_matches('.').to_owned()
}

fn disagreements(named: &[(String, String)]) -> Vec<String> {
    let first = &named[0].1;
    let others = named.iter().filter(|(_, version)| version.is_empty() || version != first);
    others.map(|(place, version)| format!("{place} names Rust {version:?}, {} names {first:?}", named[0].0)).collect()
}

/// `1.95.0` of the cargo at work.
fn own_version() -> Result<String> {
    let mut command = cargo(["--version"]);
    let output = command.output().map_err(|error| not_started(&command, &error))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.split_whitespace().nth(1).map(str::to_owned).ok_or_else(|| Failure::new("cargo names no version"))
}

/// Whether `1.95.2` or the toolchain `1.95-x86_64-…` is a release of 1.95.
fn is_release_of(version: &str, minor: &str) -> bool {
    version
        .strip_prefix(minor)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '-']) && !rest.contains("nightly"))
}

/// The name of an installed toolchain; of one that is installed now where that may be.
fn toolchain(minor: &str, setup: Setup) -> Result<String> {
    if programs::find("rustup").is_none() {
        return Err(Failure::new(format!("missing: Rust {minor}, or rustup, which installs it")));
    }
    let mut list = Command::new("rustup");
    let output = list.args(["toolchain", "list"]).output().map_err(|error| not_started(&list, &error))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if let Some(name) = text.split_whitespace().find(|name| is_release_of(name, minor)) {
        return Ok(name.to_owned());
    }
    let mut install = Command::new("rustup");
    install.args(["toolchain", "install", minor, "--profile", "minimal"]);
    if setup.no_install {
        return Err(Failure::new(format!(
            "missing: Rust {minor}. Install it, and try again:\n\n    {}",
            written(&install)
        )));
    }
    step(&format!("installing Rust {minor}"), &mut install)?;
    Ok(minor.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_that_disagree_are_found() {
        let named = |rows: &[(&str, &str)]| -> Vec<_> {
            rows.iter().map(|(place, version)| ((*place).to_owned(), (*version).to_owned())).collect()
        };
        assert!(disagreements(&named(&[("a", "1.95"), ("README.md", "1.95")])).is_empty());
        let found = disagreements(&named(&[("a", "1.95"), ("b", "1.94"), ("README.md", "")]));
        assert_eq!(found, [r#"b names Rust "1.94", a names "1.95""#, r#"README.md names Rust "", a names "1.95""#]);
    }

    #[test]
    fn versions_are_read() {
        let rows = [
            ("On a machine with Rust 1.95 and", "Rust ", "1.95"),
            ("The Rust toolchain, or Rust 1.96.", "Rust ", "1.96"),
            ("edition = \"2024\"\nrust-version = \"1.95\"", "rust-version = \"", "1.95"),
            ("Rust", "Rust ", ""),
        ];
        for (text, before, expected) in rows {
            assert_eq!(version_after(text, before), expected, "{text}");
        }
        let rows = [
            ("1.95.0", true),
            ("1.95-x86_64-unknown-linux-gnu", true),
            ("1.95.1-x86_64-unknown-linux-gnu", true),
            ("1.950.0", false),
            ("1.96.0", false),
            ("1.95.0-nightly", false),
            ("stable-x86_64-unknown-linux-gnu", false),
        ];
        for (version, expected) in rows {
            assert_eq!(is_release_of(version, "1.95"), expected, "{version}");
        }
    }
}

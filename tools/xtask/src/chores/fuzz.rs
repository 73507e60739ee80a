//! `cargo xtask fuzz`.

use std::path::Path;
use std::process::{Command, Stdio};

use clap::Args;

use crate::cargo::{announce, cargo, ended, not_started, root, step, written};
use crate::failure::{Failure, Result};
use crate::setup::{COMPILER, Setup};

/// The version that is installed if there is none.
const CARGO_FUZZ: &str = "0.13.2";
/// Mebibytes that a target may take, its fuzzer's memory of past inputs included.
const MOST_MEMORY: &str = "-rss_limit_mb=2048";
/// Seconds for one input: a hundred times the longest, which is an image of a few bytes that claims to have the largest
/// size.
const MOST_TIME: &str = "-timeout=60";
/// The folder of files in memory on Linux.
const MEMORY: &str = "/dev/shm";

/// Feed the readers of model, scene and image files with generated inputs, which must not fail them
///
/// Nothing may panic, overflow, hang, or take memory out of proportion, and the results must be valid. A target for
/// each format of models, one for scene files (scene), for images of all formats (image), for material libraries (mtl)
/// and for the parts of binary glTF (`glb_chunks`). Prints how often each was run; a failing input is kept, and how to
/// try it again and where to put it as a test is printed.
/// cargo-fuzz and a C++ compiler are installed first where they are missing.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// How long each target is run
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    seconds: u32,
    /// Stop a target sooner, after this many executions
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    executions: Option<u64>,
    /// The targets, by name; all where none is named
    #[arg(value_name = "TARGET")]
    targets: Vec<String>,
}

/// Sets up, builds, and runs every target for a while, also those after one that fails.
pub(crate) fn run(options: &Options) -> Result {
    let targets = chosen(targets(&root())?, &options.targets)?;
    options.setup.meet(&[COMPILER])?;
    have_cargo_fuzz(options.setup)?;
    step("build", &mut fuzz("build", &[]))?;
    let mut failures = Vec::new();
    let mut table = Vec::new();
    for target in targets {
        match fuzzed(&target, options) {
            Ok(counts) => table.push(format!("{target:12} {counts}")),
            Err(failure) => failures.push(failure.to_string()),
        }
    }
    println!("\n{:12} {}\n{}", "target", Counts::HEADER, table.join("\n"));
    if failures.is_empty() { Ok(()) } else { Err(Failure::new(failures.join("\n"))) }
}

/// All targets, in the order of their names.
fn targets(root: &Path) -> Result<Vec<String>> {
    let folder = root.join("fuzz/fuzz_targets");
    let failed = |error| Failure::new(format!("{}: {error}", folder.display()));
    let mut names = Vec::new();
    for file in std::fs::read_dir(&folder).map_err(failed)? {
        let path = file.map_err(failed)?.path();
        names.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
    }
    names.sort();
    Ok(names)
}

/// Those asked for, or all.
fn chosen(all: Vec<String>, asked: &[String]) -> Result<Vec<String>> {
    if let Some(unknown) = asked.iter().find(|name| !all.contains(name)) {
        return Err(Failure::usage(format!("no target is called {unknown}; expected one of {}", all.join(", "))));
    }
    Ok(all.into_iter().filter(|name| asked.is_empty() || asked.contains(name)).collect())
}

fn have_cargo_fuzz(setup: Setup) -> Result {
    let mut version = cargo(["fuzz", "--version"]);
    let there = version.stdout(Stdio::null()).stderr(Stdio::null()).status();
    if there.is_ok_and(|status| status.success()) {
        return Ok(());
    }
    // cargo-fuzz only starts other programs: optimising it would take longer than it ever runs.
    let mut install = cargo(["install", "cargo-fuzz", "--version", CARGO_FUZZ, "--locked", "--debug"]);
    if !setup.no_install {
        return step("installing cargo-fuzz", &mut install);
    }
    Err(Failure::new(format!(
        "missing: cargo-fuzz\nNothing was installed: --no-install was given. Install it yourself, and try again:\n\n    \
         {}",
        written(&install)
    )))
}

/// A command of cargo-fuzz. No sanitizer: the readers have no unsafe code for one to watch, the targets count memory
/// themselves, and without one the stable toolchain will do. Debug assertions and overflow checks are on.
fn fuzz(command: &str, arguments: &[String]) -> Command {
    let mut cargo = cargo(["fuzz", command, "--sanitizer", "none"]);
    cargo.args(arguments);
    cargo
}

/// Runs a target from its seeds and from the inputs of earlier runs.
fn fuzzed(target: &str, options: &Options) -> Result<Counts> {
    let corpus = format!("fuzz/corpus/{target}");
    std::fs::create_dir_all(root().join(&corpus)).map_err(|error| Failure::new(format!("{corpus}: {error}")))?;
    let mut command = fuzz("run", &[target.into(), corpus, format!("fuzz/seeds/{target}"), "--".into()]);
    command.args(options.executions.map(|most| format!("-runs={most}")));
    command.args([
        format!("-max_total_time={}", options.seconds),
        format!("-dict=fuzz/dictionaries/{}.dict", language(target)),
    ]);
    command.args([MOST_MEMORY, MOST_TIME, "-seed=1", "-verbosity=0", "-print_funcs=0", "-print_final_stats=1"]);
    // Material libraries are read from files: on a disk a few hundred a second, in memory many thousands.
    if Path::new(MEMORY).is_dir() {
        command.env("TMPDIR", MEMORY);
    }
    announce(target, &command);
    let output = command.output().map_err(|error| not_started(&command, &error))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.success() {
        return Counts::read(&said).ok_or_else(|| Failure::new(format!("{target}: no count in\n{said}")));
    }
    eprintln!("{}", said.trim_end());
    Err(match input(&said) {
        Some(input) => Failure::new(advice(target, input)),
        None => ended(&command, output.status),
    })
}

/// The dictionary of a target: binary glTF is glTF inside.
fn language(target: &str) -> &str {
    match target {
        "glb" | "glb_chunks" => "gltf",
        "threemf_model" => "threemf",
        other => other,
    }
}

/// The file that the fuzzer wrote the failing input to.
fn input(said: &str) -> Option<&str> {
    said.lines().find_map(|line| Some(line.split_once("Test unit written to ")?.1.trim()))
}

fn advice(target: &str, input: &str) -> String {
    let again = written(&fuzz("run", &[target.into(), input.into()]));
    let (krate, folder) = past_failures(target);
    format!(
        "{target} failed by {input}\n  again:   {again}\n  a test:  copy it to crates/{krate}/tests/past_failures{folder} \
         under a name that says what is wrong with it, and run cargo test -p halfway_{krate} past_failures"
    )
}

/// The crate with the test of inputs that once failed, and the folder among them for those of a target.
fn past_failures(target: &str) -> (&'static str, String) {
    match target {
        "scene" => ("scene", String::new()),
        "image" => ("texture", String::new()),
        model => ("mesh", format!("/{model}")),
    }
}

/// The counters of a run.
#[derive(Debug, PartialEq, Eq)]
struct Counts {
    executions: u64,
    per_second: u64,
    /// Inputs that reached new code.
    found: u64,
    /// Mebibytes.
    peak: u64,
}

impl Counts {
    const HEADER: &str = "executions  per second  inputs found  peak MiB";

    fn read(said: &str) -> Option<Self> {
        let number = |name: &str| {
            said.lines().find_map(|line| line.strip_prefix("stat::")?.strip_prefix(name)?.trim().parse().ok())
        };
        Some(Self {
            executions: number("number_of_executed_units:")?,
            per_second: number("average_exec_per_sec:")?,
            found: number("new_units_added:")?,
            peak: number("peak_rss_mb:")?,
        })
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { executions, per_second, found, peak } = self;
        write!(f, "{executions:10}  {per_second:10}  {found:12}  {peak:8}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_target_has_seeds_and_a_dictionary() {
        let root = root();
        let targets = targets(&root).unwrap();
        assert!(targets.len() >= 6, "{targets:?}");
        for target in targets {
            assert!(root.join(format!("fuzz/seeds/{target}")).is_dir(), "{target}");
            assert!(root.join(format!("fuzz/dictionaries/{}.dict", language(&target))).is_file(), "{target}");
        }
    }

    #[test]
    fn targets_are_chosen_by_name() {
        let all = || vec!["obj".to_owned(), "smf".to_owned()];
        assert_eq!(chosen(all(), &[]), Ok(all()));
        assert_eq!(chosen(all(), &["smf".to_owned()]), Ok(vec!["smf".to_owned()]));
        let expected = Failure::usage("no target is called stl; expected one of obj, smf");
        assert_eq!(chosen(all(), &["smf".to_owned(), "stl".to_owned()]), Err(expected));
    }

    #[test]
    fn output_of_the_fuzzer_is_parsed() {
        let said = "INFO: Seed: 1\nDone 9 runs in 1 second(s)\nstat::number_of_executed_units: 54321\n\
                    stat::average_exec_per_sec:     5432\nstat::new_units_added:          7\n\
                    stat::slowest_unit_time_sec:    0\nstat::peak_rss_mb:              43\n";
        assert_eq!(Counts::read(said), Some(Counts { executions: 54321, per_second: 5432, found: 7, peak: 43 }));
        assert_eq!(Counts::read("INFO: Seed: 1"), None);
        assert_eq!(input(said), None);

        let said = "==7== ERROR: libFuzzer: deadly signal\nartifact_prefix='/a/'; Test unit written to /a/crash-1\n";
        assert_eq!(input(said), Some("/a/crash-1"));
        let advice = advice("smf", "/a/crash-1");
        assert!(advice.contains("fuzz run --sanitizer none smf /a/crash-1\n"), "{advice}");
        for target in ["smf", "scene", "image"] {
            let (krate, folder) = past_failures(target);
            let kept = root().join(format!("crates/{krate}/tests/past_failures"));
            assert!(kept.is_dir(), "{}", kept.display());
            assert!(
                super::advice(target, "/a/crash-1").contains(&format!("crates/{krate}/tests/past_failures{folder} "))
            );
        }
    }
}

//! `cargo xtask instructions`.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Mutex;

use clap::Args;
use serde_json::{Map, Value, json};

use super::program::{self, Program};
use crate::cargo::{announce, printed, root};
use crate::failure::{Failure, Result};
use crate::setup::{CALLGRIND, Setup};

/// Count the processor's instructions for a frame of S1 to S4, and compare them with those that are kept
///
/// Frames of 160 × 90 pixels, drawn by one thread with AVX2, as valgrind's tool callgrind counts them: the same each time,
/// whatever else the machine does. Above 3 % more than kept is an error; by another compiler than theirs, a note. Where
/// frames became dearer for a good reason, --keep writes the new counts, and the commit says why.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Write the counts into tools/xtask/instructions.json
    #[arg(long)]
    keep: bool,
}

/// The scenes, each with what else `bench` is told. S2 has few triangles: what counts are its objects.
const SCENES: [(&str, &[&str]); 4] = [("s1", &[]), ("s2", &["--octahedra"]), ("s3", &[]), ("s4", &[])];
/// The frames of a round of `bench`: three in each of four shadings and in exact Phong shading.
const FRAMES_A_ROUND: u64 = 15;
/// The most that a frame may take, in percent of what is kept.
const MOST_PERCENT: u64 = 103;

/// Whether this machine can count them.
fn can_count() -> bool {
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    return std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(all(target_os = "linux", target_arch = "x86_64")))]
    return false;
}

/// Counts and compares, where this machine can.
pub(crate) fn where_counted(setup: Setup) -> Result {
    if can_count() {
        return run(&Options { setup, keep: false });
    }
    eprintln!("\ninstructions are not counted: that takes Linux on x86-64 with AVX2");
    Ok(())
}

/// Counts, and compares or keeps.
pub(crate) fn run(options: &Options) -> Result {
    if !can_count() {
        return Err(Failure::new("instructions are counted on Linux, on x86-64 with AVX2"));
    }
    options.setup.meet(&[CALLGRIND])?;
    program::build(Program::Binary("halfway"))?;
    let counted = count()?;
    let toolchain = toolchain()?;
    if options.keep {
        let frames: Map<String, Value> = counted.iter().map(|(scene, count)| (scene.clone(), json!(count))).collect();
        let text = format!("{:#}\n", json!({ "toolchain": toolchain, "frames": frames }));
        return fs::write(kept(), text).map_err(|error| Failure::new(format!("{}: {error}", kept().display())));
    }
    compare(&counted, &toolchain, &read()?)
}

fn kept() -> PathBuf {
    root().join("tools/xtask/instructions.json")
}

fn read() -> Result<Value> {
    let failed = |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", kept().display()));
    let text = fs::read_to_string(kept()).map_err(|error| failed(&error))?;
    serde_json::from_str(&text).map_err(|error| failed(&error))
}

fn toolchain() -> Result<String> {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = printed(Command::new(compiler).arg("--version").current_dir(root()))?;
    Ok(String::from_utf8_lossy(&version).trim().to_owned())
}

/// The instructions of a frame of each scene: the difference between two rounds and one, so that the start does not
/// count.
fn count() -> Result<BTreeMap<String, u64>> {
    let runs = SCENES.iter().flat_map(|scene| [1, 2].map(|rounds| (scene, rounds)));
    let (left, all) = (Mutex::new(runs), Mutex::new(BTreeMap::new()));
    let next = || left.lock().ok()?.next();
    let work = |core: u32| -> Result {
        while let Some((&(scene, arguments), rounds)) = next() {
            let count = instructions((scene, arguments), rounds, core)?;
            if let Ok(mut all) = all.lock() {
                all.insert((scene, rounds), count);
            }
        }
        Ok(())
    };
    let cores = cores(&fs::read_to_string("/proc/self/status").unwrap_or_default());
    std::thread::scope(|scope| {
        let work = &work;
        let workers: Vec<_> = cores.into_iter().map(|core| scope.spawn(move || work(core))).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().unwrap_or_else(|_| Err(Failure::new("a thread failed"))))
    })?;
    let all = all.into_inner().unwrap_or_default();
    let of = |scene, rounds| all.get(&(scene, rounds)).copied().unwrap_or_default();
    let frames = SCENES.iter().map(|&(scene, _)| {
        let frame = of(scene, 2).saturating_sub(of(scene, 1)) / FRAMES_A_ROUND;
        (scene.to_owned(), frame)
    });
    Ok(frames.collect())
}

/// The numbers of the cores that this process may use, by what Linux says of it, such as `0-3,6`; at least one.
fn cores(status: &str) -> Vec<u32> {
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap_or_default();
    let range = |part: &str| {
        let (first, last) = part.trim().split_once('-').unwrap_or((part.trim(), part.trim()));
        Some(first.parse::<u32>().ok()?..=last.parse().ok()?)
    };
    let mut cores: Vec<u32> = list.split(',').filter_map(range).flatten().take(2 * SCENES.len()).collect();
    if cores.is_empty() {
        cores.push(0);
    }
    cores
}

/// The instructions of a whole run of `bench`, on one core and so by one thread.
fn instructions((scene, arguments): (&str, &[&str]), rounds: u32, core: u32) -> Result<u64> {
    let mut command = Command::new("taskset");
    command.args(["-c", &core.to_string(), "valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    command.args(["target/release/halfway", "bench", scene, "--size", "160x90", "--adapter", "cpu:avx2", "--json"]);
    command.args(arguments).arg("--rounds").arg(rounds.to_string()).current_dir(root());
    announce(&format!("{scene}, rounds: {rounds}"), &command);
    let output = command.output().map_err(|error| crate::cargo::not_started(&command, &error))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        eprint!("{said}");
        return Err(crate::cargo::ended(&command, output.status));
    }
    collected(&said).ok_or_else(|| Failure::new(format!("valgrind did not say what it collected:\n{said}")))
}

/// The number in the line in which callgrind says what it collected.
fn collected(said: &str) -> Option<u64> {
    let line = said.lines().find_map(|line| line.split_once("Collected :"))?;
    line.1.trim().parse().ok()
}

/// Prints the counts beside those that are kept.
fn compare(counted: &BTreeMap<String, u64>, toolchain: &str, kept: &Value) -> Result {
    let of = kept["toolchain"].as_str().unwrap_or("an unknown compiler");
    let mut dearer = Vec::new();
    println!("instructions of a frame, in millions, and those kept:");
    for (scene, &count) in counted {
        let before = kept["frames"][scene].as_u64().unwrap_or_default();
        let ratio = count as f64 / before as f64;
        println!("   {scene} {:9.3} {:9.3}  {:+.1} %", count as f64 / 1e6, before as f64 / 1e6, 100.0 * (ratio - 1.0));
        if 100 * count > MOST_PERCENT * before {
            dearer.push(scene.as_str());
        }
    }
    if dearer.is_empty() {
        return Ok(());
    }
    let message = format!("frames of {} take more than 3 % more instructions than are kept", dearer.join(", "));
    if of != toolchain {
        println!("{message}; those are of {of}, and this is {toolchain}");
        return Ok(());
    }
    Err(Failure::new(format!("{message}. If that has a good reason: cargo xtask instructions --keep")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_is_found_among_other_lines() {
        let said = "==7== Callgrind\n==7== Events    : Ir\n==7== Collected : 4233748518\n==7==\n";
        assert_eq!(collected(said), Some(4_233_748_518));
        assert_eq!(collected("==7== Events    : Ir\n"), None);
    }

    #[test]
    fn cores_are_those_that_are_allowed() {
        assert_eq!(cores("Name:\tbash\nCpus_allowed_list:\t0-2,6\n"), [0, 1, 2, 6]);
        assert_eq!(cores("Cpus_allowed_list:\t0-4294967295\n").len(), 2 * SCENES.len());
        assert_eq!(cores(""), [0]);
    }

    #[test]
    fn dearer_frames_fail_by_the_same_compiler_alone() {
        let kept = json!({ "toolchain": "rustc 1", "frames": { "s1": 1_000_000, "s2": 2_000_000 } });
        let counts = |s1, s2| BTreeMap::from([("s1".to_owned(), s1), ("s2".to_owned(), s2)]);
        assert!(compare(&counts(1_029_000, 1_000_000), "rustc 1", &kept).is_ok());
        assert!(compare(&counts(1_031_000, 1_000_000), "rustc 1", &kept).is_err());
        assert!(compare(&counts(1_031_000, 1_000_000), "rustc 2", &kept).is_ok());
        let unknown = BTreeMap::from([("s9".to_owned(), 1)]);
        assert!(compare(&unknown, "rustc 1", &kept).is_err(), "nothing is kept of it");
    }
}

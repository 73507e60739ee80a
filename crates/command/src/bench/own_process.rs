//! Two figures that only a process of its own can tell: the time from its start to the first finished frame, and its
//! memory.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use halfway_chart::timing::frame;

use super::app::Timed;
use super::args::{BenchArgs, BenchShading};
use crate::failure::Failure;

/// How a process got to its first frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstFrame {
    /// From the start of the process until the device had finished the frame.
    pub(super) ms: f64,
    /// The largest resident set until then; 0 where the system does not tell.
    pub(super) peak_mb: f64,
}

/// How many processes are run; the one in the middle by time counts.
const PROCESSES: usize = 3;

/// In the process: draws the frame, and prints when it was finished and the memory.
pub(super) fn once(args: &BenchArgs, timed: &Timed, mode: BenchShading) -> Result<(), Failure> {
    let adapter = args.adapter.choice().open()?;
    let mut app = timed.app(args, mode)?;
    adapter.insert_into(app.world_mut());
    frame(&mut app)?;
    println!("{} {}", now_ms(), peak_kb());
    Ok(())
}

/// From outside: the first frame with the shaders that the driver has kept on disk, or `cold`, without.
pub(super) fn first_frame(mode: BenchShading, cold: bool) -> Result<FirstFrame, Failure> {
    let failed = |error: std::io::Error| Failure::new(1, error);
    let program = std::env::current_exe().map_err(failed)?;
    let mut measured = Vec::new();
    for _ in 0..PROCESSES {
        let start = now_ms();
        let output = command(&program, mode, cold).output().map_err(failed)?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let mut numbers = text.split_whitespace().map(str::parse::<f64>);
        let (Some(Ok(finished)), Some(Ok(kb))) = (numbers.next(), numbers.next()) else {
            return Err(Failure::new(1, String::from_utf8_lossy(&output.stderr).into_owned()));
        };
        measured.push(FirstFrame { ms: finished - start, peak_mb: kb / 1024.0 });
    }
    measured.sort_by(|a, b| a.ms.total_cmp(&b.ms));
    Ok(measured[PROCESSES / 2])
}

/// This process's own command line, for a single frame.
fn command(program: &std::path::Path, mode: BenchShading, cold: bool) -> Command {
    let mut command = Command::new(program);
    command.args(["bench", "--once", &mode.name()]).args(std::env::args_os().skip(2));
    if cold {
        // Mesa's drivers compile anew then; others keep no such files, or do not let them be left aside.
        command.env("MESA_SHADER_CACHE_DISABLE", "true");
    }
    command
}

/// Milliseconds of the wall clock, which two processes share.
fn now_ms() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64() * 1e3)
}

/// The largest resident set so far in KiB; 0 where the system does not tell.
fn peak_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|value| value.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

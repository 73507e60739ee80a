//! Two figures that need a process of their own: the time from its start to the first finished frame, and its memory.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use halfway_chart::timing::frame;

use super::app::Timed;
use super::args::{BenchArgs, BenchShading};
use crate::failure::Failure;

/// The first frame of a process.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstFrame {
    /// From the start of the process until the device had finished the frame.
    pub(super) ms: f64,
    /// The largest resident set until then; 0 where the system does not report it.
    pub(super) peak_mb: f64,
}

/// The number of processes; the median by time counts.
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

/// From outside: the first frame with the driver's shader cache on disk, or `cold`, without.
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

/// The command line of a process for a single frame.
fn command(program: &std::path::Path, mode: BenchShading, cold: bool) -> Command {
    let mut command = Command::new(program);
    command.args(["bench", "--once", mode.name()]).args(std::env::args_os().skip(2));
    if cold {
        // Mesa's drivers then compile anew; others keep no such cache, or cannot disable it.
        command.env("MESA_SHADER_CACHE_DISABLE", "true");
    }
    command
}

/// Milliseconds of the wall clock, which two processes share.
fn now_ms() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64() * 1e3)
}

/// The largest resident set so far in KiB; 0 where the system does not report it.
pub(super) fn peak_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|value| value.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

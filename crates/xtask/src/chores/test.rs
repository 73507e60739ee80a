//! `cargo xtask test`.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Instant;

use clap::Args;

use crate::cargo::{announce, cargo, duration, ended, not_started, step};
use crate::chores::adapters as each_adapter;
use crate::failure::{Failure, Result};
use crate::machine::programs;
use crate::setup::{DRIVER, SCREEN, Setup, X11_WINDOWS, adapters};
use crate::tally::Tally;

/// Run every test, those that need a graphics adapter or a window included
///
/// Documentation examples included, in the release profile, with a summary at the end. No test is skipped for want of
/// an adapter or a screen: what they need and the machine lacks (Vulkan drivers, OpenGL, the virtual screen Xvfb) is
/// installed first, by apt-get where it may be used; otherwise nothing is built, and the remedy is printed.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
}

/// Sets up, builds, runs every test and sums up.
pub(crate) fn run(options: &Options) -> Result {
    let setup = options.setup;
    let start = Instant::now();
    setup.meet(&[&[DRIVER, SCREEN, X11_WINDOWS][..], &each_adapter::NEEDS].concat())?;
    // Without a choice of targets these are all tests of libraries, programs, `tests/` and the documentation; the
    // examples are built beside them as programs, which `tests/` runs.
    step("build", &mut cargo(["test", "--release", "--workspace", "--no-run"]))?;
    adapters(setup)?;
    let mut command = cargo(["test", "--release", "--workspace", "--no-fail-fast"]);
    give_own_screen(&mut command);
    let tally = counted("tests", &mut command);
    eprintln!("\n── {}", duration(start.elapsed()));
    let (tally, outcome) = tally?;
    eprintln!("{tally}");
    outcome?;
    if tally.passed == 0 {
        return Err(Failure::new("no test ran"));
    }
    // Elsewhere than on Linux there is the system's own.
    if cfg!(target_os = "linux") { each_adapter::try_all() } else { Ok(()) }
}

/// Where the virtual screen is installed, the tests open their windows there, whatever display is at hand: none flashes
/// up in front of somebody who works, and no key that they press goes astray.
fn give_own_screen(command: &mut Command) {
    if programs::find("Xvfb").is_some() {
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    }
}

/// Runs tests, hands on what they print, and counts it. The second part says whether all went well.
///
/// # Errors
/// The command cannot be started, or what it prints cannot be read.
pub(crate) fn counted(title: &str, command: &mut Command) -> Result<(Tally, Result)> {
    announce(title, command);
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| not_started(command, &error))?;
    let mut tally = Tally::default();
    let mut output = BufReader::new(child.stdout.take().ok_or_else(|| Failure::new("no output to read"))?);
    let mut line = Vec::new();
    // Bytes, because tests may print what is no text.
    while output.read_until(b'\n', &mut line).map_err(|error| not_started(command, &error))? > 0 {
        let text = String::from_utf8_lossy(&line);
        print!("{text}");
        tally.line(text.trim_end());
        line.clear();
    }
    let status = child.wait().map_err(|error| not_started(command, &error))?;
    let outcome = if status.success() { Ok(()) } else { Err(ended(command, status)) };
    Ok((tally, outcome))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn output_is_counted_and_the_exit_code_counts() {
        let script = "echo 'test a ... ok'; echo 'test b ... FAILED'; printf '\\377\\n'
                      echo 'test result: FAILED. 1 passed; 1 failed; 0 ignored'; exit 101";
        let (tally, outcome) = counted("a script", &mut shell(script)).unwrap();
        assert_eq!((tally.passed, tally.failed.as_slice()), (1, &["b".to_owned()][..]));
        assert!(outcome.unwrap_err().to_string().ends_with("exit code 101"));

        let (tally, outcome) = counted("nothing", &mut shell("exit 0")).unwrap();
        assert_eq!((tally, outcome), (Tally::default(), Ok(())));
        assert!(counted("no program", &mut Command::new("/no/such/program")).is_err());
    }
}

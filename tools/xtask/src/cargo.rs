//! Runs cargo, and prints the commands.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::time::{Duration, Instant};

use crate::failure::{Failure, Result};

/// The workspace's root.
pub(crate) fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_owned()
}

/// The cargo that runs this program, in the workspace's root.
pub(crate) fn cargo<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(root());
    command
}

/// The command as typed in a shell.
pub(crate) fn written(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    // Only a NUL, which no argument can hold, cannot be quoted.
    shlex::try_join(words.iter().map(AsRef::as_ref)).unwrap_or_else(|_| words.join(" "))
}

/// Prints the step that begins, and the command.
pub(crate) fn announce(title: &str, command: &Command) {
    eprintln!("\n── {title}\n   {}", written(command));
}

/// Runs a command under a header; its output goes to this program's.
///
/// # Errors
/// The command cannot be started, or ends with another exit code than 0.
pub(crate) fn step(title: &str, command: &mut Command) -> Result {
    announce(title, command);
    let start = Instant::now();
    let status = command.status().map_err(|error| not_started(command, &error))?;
    if !status.success() {
        return Err(ended(command, status));
    }
    eprintln!("   {}", duration(start.elapsed()));
    Ok(())
}

/// Runs a command without a header and returns its output; its errors are printed if it fails.
///
/// # Errors
/// The command cannot be started, or ends with another exit code than 0.
pub(crate) fn printed(command: &mut Command) -> Result<Vec<u8>> {
    let output = command.output().map_err(|error| not_started(command, &error))?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    Err(ended(command, output.status))
}

pub(crate) fn not_started(command: &Command, error: &std::io::Error) -> Failure {
    Failure::new(format!("{}: {error}", written(command)))
}

pub(crate) fn ended(command: &Command, status: ExitStatus) -> Failure {
    let how = status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"));
    Failure::new(format!("{}: {how}", written(command)))
}

/// `4 min 5 s` or `2.3 s`.
pub(crate) fn duration(time: Duration) -> String {
    if time < Duration::from_mins(1) {
        return format!("{:.1} s", time.as_secs_f64());
    }
    let seconds = time.as_secs();
    format!("{} min {} s", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_the_workspaces() {
        let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[workspace]"));
    }

    #[test]
    fn commands_can_be_copied() {
        let mut command = Command::new("/opt/rust/bin/cargo");
        command.args(["test", "a b", "it's", "", "*", "target/x=1"]);
        assert_eq!(written(&command), r#"cargo test 'a b' "it's" '' '*' 'target/x=1'"#);
    }

    #[test]
    fn durations() {
        let rows =
            [(40, "0.0 s"), (1_250, "1.2 s"), (59_900, "59.9 s"), (60_000, "1 min 0 s"), (754_600, "12 min 34 s")];
        for (milliseconds, expected) in rows {
            assert_eq!(duration(Duration::from_millis(milliseconds)), expected);
        }
    }
}

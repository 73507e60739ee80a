//! The results of tests.

use std::fmt;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::cargo::{announce, ended, not_started};
use crate::failure::{Failure, Result};

/// The results of the test programs of one run, read from what they print.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Test programs and sets of documentation examples that ran to their end.
    programs: u32,
    pub(crate) passed: u32,
    failed: Vec<String>,
    ignored: Vec<String>,
}

impl Tally {
    /// Adds the results of another run.
    pub(crate) fn add(&mut self, other: Self) {
        self.programs += other.programs;
        self.passed += other.passed;
        self.failed.extend(other.failed);
        self.ignored.extend(other.ignored);
    }

    /// Parses a line of the output.
    fn line(&mut self, line: &str) {
        if let Some(counts) = line.strip_prefix("test result: ") {
            self.programs += 1;
            self.passed += count(counts, "passed");
        } else if let Some(test) = line.strip_prefix("test ") {
            let Some((name, result)) = test.rsplit_once(" ... ") else { return };
            match result.split(',').next() {
                Some("FAILED") => self.failed.push(name.to_owned()),
                Some("ignored") => self.ignored.push(name.to_owned()),
                _ => {}
            }
        }
    }
}

/// Runs tests, passes their output on, and counts the results. The second part is the success of the run.
///
/// # Errors
/// The command cannot be started, or what it prints cannot be read.
pub(crate) fn counted(title: &str, command: &mut Command) -> Result<(Tally, Result)> {
    announce(title, command);
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| not_started(command, &error))?;
    let mut tally = Tally::default();
    let mut output = BufReader::new(child.stdout.take().ok_or_else(|| Failure::new("no output to read"))?);
    let mut line = Vec::new();
    // Bytes, because tests may print invalid UTF-8.
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

/// The 12 of `ok. 12 passed; 0 failed; …`.
fn count(counts: &str, of: &str) -> u32 {
    let part = counts.split(['.', ';']).find_map(|part| part.trim().strip_suffix(of));
    part.and_then(|number| number.trim().parse().ok()).unwrap_or(0)
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (names, what) in [(&self.failed, "failed"), (&self.ignored, "ignored")] {
            for name in names {
                writeln!(f, "   {what}: {name}")?;
            }
        }
        let Self { programs, passed, failed, ignored } = self;
        write!(f, "   {passed} passed, {} failed, {} ignored, in {programs} programs", failed.len(), ignored.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "
running 4 tests
test mesh::tests::bounds ... ok
test a long one ... with dots ... ok
test lights::tests::none ... FAILED
test slow ... ignored, takes an hour

failures:

---- lights::tests::none stdout ----

failures:
    lights::tests::none

test result: FAILED. 2 passed; 1 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.10s

running 1 test
test src/lib.rs - (line 7) - compile ... ok
test src/lib.rs - (line 20) ... ignored

test result: ok. 1 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 1.20s
";

    #[test]
    fn results_are_added_up() {
        let mut tally = Tally::default();
        let (first, second) = OUTPUT.split_at(OUTPUT.find("running 1 test").unwrap());
        first.lines().for_each(|line| tally.line(line));
        let mut more = Tally::default();
        second.lines().for_each(|line| more.line(line));
        tally.add(more);
        assert_eq!((tally.programs, tally.passed), (2, 3));
        assert_eq!(tally.failed, ["lights::tests::none"]);
        assert_eq!(tally.ignored, ["slow", "src/lib.rs - (line 20)"]);
        assert_eq!(
            tally.to_string(),
            "   failed: lights::tests::none\n   ignored: slow\n   ignored: src/lib.rs - (line 20)\n   3 passed, \
             1 failed, 2 ignored, in 2 programs"
        );
    }

    #[test]
    fn other_lines_count_for_nothing() {
        let mut tally = Tally::default();
        for line in ["", "testing", "test", "test result:", "test x ... ok", "warning: test result: ok. 5 passed;"] {
            tally.line(line);
        }
        assert_eq!(tally, Tally::default());
    }

    #[cfg(unix)]
    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[cfg(unix)]
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

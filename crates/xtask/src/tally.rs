//! What came out of the tests.

use std::fmt;

/// The results of the test programs of one run, read from what they print.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Test programs and sets of documentation examples that ran to their end.
    pub(crate) programs: u32,
    pub(crate) passed: u32,
    pub(crate) failed: Vec<String>,
    pub(crate) ignored: Vec<String>,
}

impl Tally {
    /// Takes in a line of the output.
    pub(crate) fn line(&mut self, line: &str) {
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
        OUTPUT.lines().for_each(|line| tally.line(line));
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
}

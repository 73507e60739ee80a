//! Subjects of commits: `room: what is done`, in at most 72 characters.

use std::path::Path;
use std::process::Command;

use super::none_of;
use crate::cargo::{ended, not_started};
use crate::failure::Result;

const MOST: usize = 72;
/// The newest commit from before the rule, and its time, which tells where a clone does not reach back to it.
const BEFORE: (&str, &str) = ("4f2bd24", "2026-11-21T18:43:11Z");
/// How far to look back.
const COMMITS: &str = "--max-count=200";

/// Looks at the newest commits of the clone in `root`; at none where it is no clone.
pub(crate) fn run(root: &Path) -> Result {
    let Some(log) = subjects(root)? else {
        eprintln!("   no git history here: nothing to look at");
        return Ok(());
    };
    none_of(&faults(&log))
}

/// A line for each commit, its short hash and its subject; nothing without git or a history.
fn subjects(root: &Path) -> Result<Option<String>> {
    let git = |words: &[&str]| {
        let mut command = Command::new("git");
        command.args(words).current_dir(root);
        command
    };
    if !git(&["rev-parse", "--verify", "--quiet", "HEAD"]).output().is_ok_and(|output| output.status.success()) {
        return Ok(None);
    }
    let (commit, time) = BEFORE;
    let reached = git(&["cat-file", "-e", &format!("{commit}^{{commit}}")]).output();
    let after = if reached.is_ok_and(|output| output.status.success()) {
        format!("^{commit}")
    } else {
        format!("--since={time}")
    };
    let mut log = git(&["log", "--no-merges", "--format=%h %s", COMMITS, "HEAD", &after]);
    let output = log.output().map_err(|error| not_started(&log, &error))?;
    if !output.status.success() {
        return Err(ended(&log, output.status));
    }
    Ok(Some(String::from_utf8_lossy(&output.stdout).into_owned()))
}

fn faults(log: &str) -> Vec<String> {
    let commits = log.lines().filter_map(|line| line.split_once(' '));
    commits.filter_map(|(hash, subject)| Some(format!("{hash} {subject}: {}", fault(subject)?))).collect()
}

fn fault(subject: &str) -> Option<String> {
    let room = subject.split_once(": ").map(|(room, _)| room).unwrap_or_default();
    let is_room = !room.is_empty() && room.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    let length = subject.chars().count();
    if !is_room {
        Some("expected the room first, as in `mesh: Read …`".into())
    } else if length > MOST {
        Some(format!("{length} characters, more than {MOST}"))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subjects_that_break_the_rule_are_found() {
        let rows = [
            ("mesh: read what tobj reads", None),
            ("xtask: find circles of files", None),
            ("Read what tobj reads", Some("the room first")),
            ("a mesh: read", Some("the room first")),
            (": read", Some("the room first")),
            ("mesh:read", Some("the room first")),
            (&format!("mesh: {}", "ä".repeat(66)), None),
            (&format!("mesh: {}", "ä".repeat(67)), Some("73 characters, more than 72")),
        ];
        for (subject, expected) in rows {
            let found = faults(&format!("abc1234 mesh: fits\ndef5678 {subject}\n"));
            assert_eq!(found.len(), usize::from(expected.is_some()), "{subject}: {found:?}");
            assert!(found.iter().all(|fault| fault.contains(expected.unwrap_or_default())), "{found:?}");
        }
    }

    #[test]
    fn histories_of_other_kinds_are_read() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(subjects(folder.path()), Ok(None), "no clone");
        let git = |words: &[&str], time: &str| {
            let mut command = Command::new("git");
            command.args(["-c", "user.name=a", "-c", "user.email=a@example.org"]).args(words);
            command.env("GIT_AUTHOR_DATE", time).env("GIT_COMMITTER_DATE", time).current_dir(folder.path());
            assert!(command.output().unwrap().status.success(), "{words:?}");
        };
        git(&["init", "--quiet"], "");
        assert_eq!(subjects(folder.path()), Ok(None), "no commit");
        // As in a shallow clone, the commit that ends the old time is not there.
        git(&["commit", "--quiet", "--allow-empty", "-m", "Old and without a room"], "2026-11-20T00:00:00Z");
        git(&["commit", "--quiet", "--allow-empty", "-m", "New and without a room"], "2026-11-22T00:00:00Z");
        let found = faults(&subjects(folder.path()).unwrap().unwrap());
        assert_eq!(found.len(), 1);
        assert!(found[0].contains("New and without a room: expected the room first"), "{found:?}");
    }
}

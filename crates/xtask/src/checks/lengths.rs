//! No file of code is longer than 500 lines.

use std::path::{Path, PathBuf};

use super::none_of;
use crate::failure::{Failure, Result};

const MOST: usize = 500;
/// Where code is, from the project's folder.
const FOLDERS: [&str; 5] = ["crates", "examples", "tests", "fuzz/fuzz_targets", "fuzz/src"];
/// How the names of its files end.
const ENDS: [&str; 2] = ["rs", "wgsl"];

/// Counts the lines of every file of code below `root`.
pub(crate) fn run(root: &Path) -> Result {
    none_of(&too_long(root)?)
}

fn too_long(root: &Path) -> Result<Vec<String>> {
    let mut faults = Vec::new();
    let mut left: Vec<PathBuf> = FOLDERS.map(|folder| root.join(folder)).into();
    while let Some(path) = left.pop() {
        let failed = |error| Failure::new(format!("{}: {error}", path.display()));
        if path.is_dir() {
            for entry in std::fs::read_dir(&path).map_err(failed)? {
                left.push(entry.map_err(failed)?.path());
            }
        } else if path.extension().is_some_and(|end| ENDS.iter().any(|known| end == *known)) {
            let lines = std::fs::read_to_string(&path).map_err(failed)?.lines().count();
            if lines > MOST {
                let file = path.strip_prefix(root).unwrap_or(&path).display();
                faults.push(format!("{file}: {lines} lines, more than {MOST}"));
            }
        }
    }
    faults.sort();
    Ok(faults)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_files_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let source = folder.path().join("crates/a/src");
        std::fs::create_dir_all(&source).unwrap();
        for (name, lines) in [("fits.rs", MOST), ("long.rs", MOST + 1), ("long.wgsl", 2 * MOST), ("data.obj", 9999)] {
            std::fs::write(source.join(name), "\n".repeat(lines)).unwrap();
        }
        let expected =
            ["crates/a/src/long.rs: 501 lines, more than 500", "crates/a/src/long.wgsl: 1000 lines, more than 500"];
        assert_eq!(too_long(folder.path()), Ok(expected.map(String::from).into()));
    }
}

//! No file of code is longer than 500 lines, and no line of prose wider than 120 columns.

use std::path::{Path, PathBuf};

use super::none_of;
use crate::failure::{Failure, Result};

const MOST: usize = 500;
const WIDEST: usize = 120;
/// Where code and prose are, from the project's folder.
const FOLDERS: [&str; 6] = ["crates", "docs", "examples", "tests", "fuzz/fuzz_targets", "fuzz/src"];
/// The pages beside them.
const PAGES: [&str; 3] = ["CHANGELOG.md", "CONTRIBUTING.md", "README.md"];
/// Pages that `cargo xtask chart` writes.
const WRITTEN: [&str; 2] = ["docs/filters.md", "docs/fronts.md"];

/// Looks at every file of code and every page below `root`.
pub(crate) fn run(root: &Path) -> Result {
    none_of(&faults(root)?)
}

fn faults(root: &Path) -> Result<Vec<String>> {
    let mut faults = Vec::new();
    let mut left: Vec<PathBuf> = FOLDERS.iter().chain(&PAGES).map(|name| root.join(name)).collect();
    while let Some(path) = left.pop() {
        let failed = |error| Failure::new(format!("{}: {error}", path.display()));
        let file = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        let end = path.extension().and_then(|end| end.to_str());
        if path.is_dir() {
            for entry in std::fs::read_dir(&path).map_err(failed)? {
                left.push(entry.map_err(failed)?.path());
            }
        } else if let Some(end @ ("md" | "rs" | "wgsl")) = end
            && path.is_file()
        {
            let text = std::fs::read_to_string(&path).map_err(failed)?;
            let lines = text.lines().count();
            if end != "md" && lines > MOST {
                faults.push(format!("{file}: {lines} lines, more than {MOST}"));
            }
            if !WRITTEN.contains(&file.as_str()) {
                let wide = wide_lines(&text, end == "md")
                    .map(|(at, columns)| format!("{file}:{at}: prose of {columns} columns, more than {WIDEST}"));
                faults.extend(wide);
            }
        }
    }
    faults.sort();
    Ok(faults)
}

/// The lines of a page, or of the comments of code, that are too wide, each with its columns. Code, tables, headings
/// and pictures cannot be broken.
fn wide_lines(text: &str, is_page: bool) -> impl Iterator<Item = (usize, usize)> {
    let mut in_code = false;
    text.lines().zip(1..).filter_map(move |(line, at)| {
        let words = line.trim_start();
        let words = if is_page { words } else { words.strip_prefix("//")?.trim_start_matches(['/', '!']).trim_start() };
        in_code ^= words.starts_with("```");
        let columns = line.chars().count();
        let is_whole = ["|", "#", "!["].iter().any(|start| words.starts_with(start));
        (columns > WIDEST && !in_code && !is_whole).then_some((at, columns))
    })
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
        assert_eq!(faults(folder.path()), Ok(expected.map(String::from).into()));
    }

    #[test]
    fn wide_prose_is_found() {
        let (fits, wide) = ("é".repeat(WIDEST - 4), "é".repeat(WIDEST + 1));
        let page = format!("{fits}\n{wide}\n|{wide}|\n# {wide}\n![{wide}](a.svg)\n```sh\n{wide}\n```\n- {wide}\n");
        assert_eq!(wide_lines(&page, true).collect::<Vec<_>>(), [(2, WIDEST + 1), (9, WIDEST + 3)]);
        let code =
            format!("//! {fits}\n//! {wide}\nlet text = \"{wide}\";\n    // {wide}\n/// ```\n/// {wide}\n/// ```\n");
        assert_eq!(wide_lines(&code, false).collect::<Vec<_>>(), [(2, WIDEST + 5), (4, WIDEST + 8)]);

        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("docs")).unwrap();
        for name in ["README.md", "docs/speed.md", "docs/fronts.md"] {
            std::fs::write(folder.path().join(name), &wide).unwrap();
        }
        let found = faults(folder.path()).unwrap();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("README.md:1: ") && found[1].starts_with("docs/speed.md:1: "), "{found:?}");
    }
}

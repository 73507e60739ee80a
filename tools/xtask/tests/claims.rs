//! Claims of the documents about tests: a sentence that mentions a test names one that exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The files below a folder whose names end so.
fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
}

/// The names of all functions marked as tests.
fn tests() -> BTreeSet<String> {
    let mut sources = Vec::new();
    for folder in ["crates", "src", "tests", "tools"] {
        files(&root().join(folder), ".rs", &mut sources);
    }
    let mut names = BTreeSet::new();
    for source in sources {
        let text = fs::read_to_string(&source).expect("text");
        for after in text.split("#[test]").skip(1) {
            let name = after.split_once("fn ").and_then(|(_, rest)| rest.split_once('('));
            names.extend(name.map(|(name, _)| name.to_owned()));
        }
    }
    names
}

/// Whether a sentence says that something is tested: it has the word, or speaks of one or more tests of ours.
fn claims(sentence: &str) -> bool {
    let words: Vec<String> = sentence
        .split_whitespace()
        .map(|word| word.trim_matches(|c: char| !c.is_alphanumeric()).to_lowercase())
        .collect();
    let of_ours = |before: &str| ["a", "another", "the", "own", "its"].contains(&before);
    words.iter().any(|word| word == "tested")
        || words.windows(2).any(|pair| of_ours(&pair[0]) && ["test", "tests"].contains(&pair[1].as_str()))
}

/// The sentences of a page, without code blocks. A table is one sentence a row.
fn sentences(page: &str) -> Vec<String> {
    let prose: String = page.split("```").step_by(2).collect();
    let paragraphs = prose.split("\n\n").filter(|paragraph| !paragraph.starts_with("    "));
    let joined = paragraphs.flat_map(|paragraph| {
        let joint = if paragraph.starts_with('|') { ". " } else { " " };
        paragraph
            .lines()
            .map(str::trim)
            .collect::<Vec<_>>()
            .join(joint)
            .split(". ")
            .map(str::to_owned)
            .collect::<Vec<_>>()
    });
    joined.collect()
}

/// The claims of a page that name no test and no file or folder of tests.
fn unfounded(page: &str, tests: &BTreeSet<String>) -> Vec<String> {
    let founded = |sentence: &String| {
        sentence.split('`').skip(1).step_by(2).any(|name| {
            tests.contains(name)
                || (name.contains("tests/") || name.ends_with("tests.rs")) && root().join(name).exists()
        })
    };
    sentences(page).into_iter().filter(|sentence| claims(sentence) && !founded(sentence)).collect()
}

#[test]
fn every_claim_names_a_test_that_exists() {
    let tests = tests();
    assert!(tests.len() > 500, "{} tests", tests.len());
    let mut pages = Vec::new();
    files(&root().join("docs"), ".md", &mut pages);
    let mut wrong = Vec::new();
    for page in pages {
        let text = fs::read_to_string(&page).expect("text");
        wrong.extend(unfounded(&text, &tests).into_iter().map(|claim| format!("{}: {claim}", page.display())));
    }
    assert!(wrong.is_empty(), "no test that exists is named here:\n{}", wrong.join("\n"));
}

#[test]
fn a_claim_without_its_test_is_found() {
    let tests = tests();
    for (page, found) in [
        ("Each is tested.", 1),
        ("A test reads it. All is well.", 1),
        ("A test (`no_such_function`) reads it.", 1),
        ("A test (`every_claim_names_a_test_that_exists`) reads\nit.", 0),
        ("The tests in `tools/xtask/tests/claims.rs` read it.", 0),
        ("The tests in `tools/xtask/tests/gone.rs` read it.", 1),
        ("```\n# a test\n```\nNothing.", 0),
    ] {
        assert_eq!(unfounded(page, &tests).len(), found, "{page}");
    }
}

//! The licences of the crates that a package is built from.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::cargo::{cargo, printed};
use crate::failure::{Failure, Result};

/// A page with the licences of all crates of others that `package` links for `target`: each text once, with the crates
/// that have it.
///
/// # Errors
/// Cargo cannot tell the crates.
pub(crate) fn of(package: &str, target: &str) -> Result<String> {
    // The features are those of the package alone, which the metadata of the workspace do not tell.
    let format = ["--prefix", "none", "--format", "{p}|{l}", "--edges", "normal", "--target", target];
    let tree = printed(cargo(["tree", "--locked", "-p", package]).args(format))?;
    let metadata = printed(&mut cargo(["metadata", "--locked", "--format-version", "1"]))?;
    let folders = folders(&metadata).ok_or_else(|| Failure::new("cargo metadata: not what it used to print"))?;
    let mut crates: Vec<Linked> = String::from_utf8_lossy(&tree).lines().filter_map(linked).collect();
    crates.sort();
    crates.dedup();
    let texts =
        |it: &Linked| folders.get(&it.name).map(|folder| texts(Path::new(folder), &it.licence)).unwrap_or_default();
    Ok(page(&crates, texts))
}

/// A crate of others: `serde v1.0.1`, and its licence.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Linked {
    name: String,
    licence: String,
}

/// A line of the tree: `name v1.2.3|MIT`, or of this workspace `name v0.1.0 (/path)|MIT`.
fn linked(line: &str) -> Option<Linked> {
    let (name, licence) = line.split_once('|')?;
    let name = name.trim_end_matches(" (*)").trim_end_matches(" (proc-macro)");
    // A path is that of a crate of ours.
    if name.contains('(') {
        return None;
    }
    Some(Linked { name: name.to_owned(), licence: licence.trim_end_matches(" (*)").to_owned() })
}

/// The folder of each crate, by name and version.
fn folders(metadata: &[u8]) -> Option<BTreeMap<String, String>> {
    let metadata: Value = serde_json::from_slice(metadata).ok()?;
    let folder = |package: &Value| {
        let manifest = Path::new(package["manifest_path"].as_str()?);
        let name = format!("{} v{}", package["name"].as_str()?, package["version"].as_str()?);
        Some((name, manifest.parent()?.to_string_lossy().into_owned()))
    };
    metadata["packages"].as_array()?.iter().map(folder).collect()
}

/// The texts of the licence that is chosen for a crate: MIT where there is a choice, else all; and notices.
fn texts(folder: &Path, licence: &str) -> Vec<String> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = files.map(|file| file.path()).filter(|file| file.is_file()).collect();
    files.sort();
    let is_named = |file: &Path, words: &[&str]| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        words.iter().any(|word| name.contains(word))
    };
    let of_choice = |file: &&std::path::PathBuf| {
        let may_choose = licence.contains("MIT") && licence.contains("OR");
        !may_choose || is_named(file, &["MIT"])
    };
    let licences: Vec<_> = files.iter().filter(|file| is_named(file, &["LICENSE", "LICENCE", "COPYING"])).collect();
    let chosen: Vec<_> = licences.iter().copied().filter(of_choice).collect();
    let kept = if chosen.is_empty() { licences } else { chosen };
    let notices = files.iter().filter(|file| is_named(file, &["NOTICE"]));
    let read = |file: &std::path::PathBuf| fs::read_to_string(file).ok().map(|text| text.trim().replace("\r\n", "\n"));
    kept.into_iter().chain(notices).filter_map(read).filter(|text| !text.is_empty()).collect()
}

fn page(crates: &[Linked], texts: impl Fn(&Linked) -> Vec<String>) -> String {
    let mut by_text: BTreeMap<String, Vec<&Linked>> = BTreeMap::new();
    let mut without = Vec::new();
    for it in crates {
        let texts = texts(it);
        if texts.is_empty() {
            without.push(it);
        }
        for text in texts {
            by_text.entry(text).or_default().push(it);
        }
    }
    let mut page = "# Licences of the crates in this package\n".to_owned();
    let names = |crates: &[&Linked]| {
        crates.iter().map(|it| format!("{} ({})", it.name, it.licence)).collect::<Vec<_>>().join(", ")
    };
    for (text, crates) in &by_text {
        // Writing to a string does not fail.
        write!(page, "\n## {}\n\n```text\n{text}\n```\n", names(crates)).ok();
    }
    if !without.is_empty() {
        write!(page, "\n## Under the licences that they name, without a text\n\n{}\n", names(&without)).ok();
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crates_of_others_are_listed_once_with_their_texts() {
        let crates: Vec<_> = ["serde v1.0.1|MIT OR Apache-2.0", "halfway v0.1.0 (/a)|MIT", "zip v2.0.0|MIT (*)"]
            .into_iter()
            .filter_map(linked)
            .collect();
        assert_eq!(crates.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["serde v1.0.1", "zip v2.0.0"]);
        let page = page(&crates, |it| if it.name.starts_with("serde") { vec!["Use it.".into()] } else { Vec::new() });
        assert!(page.contains("## serde v1.0.1 (MIT OR Apache-2.0)\n\n```text\nUse it.\n```"));
        assert!(page.ends_with("without a text\n\nzip v2.0.0 (MIT)\n"));
    }

    #[test]
    fn the_shorter_licence_is_chosen_where_there_is_a_choice() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("LICENSE-MIT", "mit"), ("LICENSE-APACHE", "apache"), ("NOTICE", "by us")] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        assert_eq!(texts(folder.path(), "MIT OR Apache-2.0"), ["mit", "by us"]);
        assert_eq!(texts(folder.path(), "Apache-2.0"), ["apache", "mit", "by us"]);
    }
}

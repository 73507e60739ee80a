//! The chapters as they are written, and as mdBook is given them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::markdown::{Link, Stretch, links, stretches};
use super::{formulas, questions};
use crate::failure::{Failure, Result};

/// The folder of the chapters, from the root.
pub(crate) const SOURCE: &str = "docs/book/src";
/// The folder in it with the chapters that `halfway chart` writes, one for each known failure.
pub(crate) const FAILURES: &str = "failures";
/// The beginning of a link to a picture of the documentation, and of the same link in the built book.
const PICTURES: [&str; 2] = ["../../pictures/", "pictures/"];
/// The folders whose files may have anchors.
const CODE: [&str; 3] = ["crates", "examples", "src"];

/// A page of the book.
#[derive(Debug)]
pub(crate) struct Chapter {
    /// Its file, from the root.
    pub(crate) file: String,
    pub(crate) text: String,
}

/// The chapters in the order of the contents, but for those of known failures.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn all(root: &Path) -> Result<Vec<Chapter>> {
    let listed = contents(root)?.into_iter().filter(|target| Path::new(target).parent() != Some(Path::new(FAILURES)));
    listed.map(|target| Chapter::read(root, &target)).collect()
}

/// Checks that the contents list the chapters of known failures that were written.
///
/// # Errors
/// The first that is not listed, or a folder that cannot be read.
pub(crate) fn check_failures(root: &Path) -> Result {
    let listed = contents(root)?;
    let folder = Path::new(SOURCE).join(FAILURES);
    let failed = |error: std::io::Error| Failure::new(format!("{}: {error}", folder.display()));
    for entry in std::fs::read_dir(root.join(&folder)).map_err(failed)? {
        let target = format!("{FAILURES}/{}", entry.map_err(failed)?.file_name().to_string_lossy());
        if Path::new(&target).extension().is_some_and(|ending| ending == "md") && !listed.contains(&target) {
            return Err(Failure::new(format!("{SOURCE}/SUMMARY.md does not list {target}")));
        }
    }
    Ok(())
}

/// The files that the contents list.
fn contents(root: &Path) -> Result<Vec<String>> {
    let contents = Chapter::read(root, "SUMMARY.md")?;
    Ok(links(&contents.text).0.iter().map(|(_, link)| link.target.to_owned()).collect())
}

impl Chapter {
    fn read(root: &Path, name: &str) -> Result<Self> {
        let file = format!("{SOURCE}/{name}");
        let text =
            std::fs::read_to_string(root.join(&file)).map_err(|error| Failure::new(format!("{file}: {error}")))?;
        Ok(Self { file, text })
    }

    /// The chapter as mdBook is given it: formulas as `MathML`, pictures of the documentation in the book's own folder,
    /// links to other pages of the repository as text, since the built book stands alone, and code that was included from
    /// within an `impl` without its indentation.
    ///
    /// # Errors
    /// A formula that is not TeX.
    pub(crate) fn prepared(text: &str) -> std::result::Result<String, String> {
        let prepare = |stretch| match stretch {
            Stretch::Code(code) => Ok(moved_left(code)),
            Stretch::Prose(prose) => formulas::typeset(&relinked(prose)),
        };
        stretches(text).into_iter().map(prepare).collect()
    }

    /// The pictures of the documentation that it shows: their names.
    pub(crate) fn pictures(&self) -> BTreeSet<String> {
        let targets = self.links().into_iter().map(|(_, target)| target);
        targets.filter_map(|target| Some(target.strip_prefix(PICTURES[0])?.to_owned())).collect()
    }

    /// Whether each is a picture, and the targets.
    fn links(&self) -> Vec<(bool, String)> {
        let prose = stretches(&self.text).into_iter().filter_map(|it| match it {
            Stretch::Prose(prose) => Some(prose),
            Stretch::Code(_) => None,
        });
        let found = prose.flat_map(|prose| links(prose).0);
        found.map(|(_, link)| (link.is_picture, link.target.to_owned())).collect()
    }

    /// The files that it includes, from the root, with the anchors.
    fn includes(&self) -> Vec<(PathBuf, String)> {
        let include = |part: &str| {
            let (path, anchor) = part.split_once("}}")?.0.trim().split_once(':').unwrap_or((part, ""));
            let folder = Path::new(SOURCE);
            Some((flat(&folder.join(path.trim())), anchor.trim().to_owned()))
        };
        self.text.split("{{#include ").skip(1).filter_map(include).collect()
    }

    /// The faults of it: parts that every chapter has and this one lacks, files and anchors that are not there.
    fn problems(&self, root: &Path) -> Vec<String> {
        let mut problems = Vec::new();
        let prose = |count: fn(&str) -> usize| -> usize {
            let parts = stretches(&self.text).into_iter();
            parts.map(|it| if let Stretch::Prose(prose) = it { count(prose) } else { 0 }).sum()
        };
        let has_question = questions::of(&self.text).is_ok_and(|all| all.iter().any(|it| !it.expected.is_empty()));
        let parts = [
            ("formula", prose(formulas::count) > 0),
            ("lines of code", !self.includes().is_empty()),
            ("picture", self.links().iter().any(|(is_picture, _)| *is_picture)),
            ("question with a command and its answer", has_question),
        ];
        problems.extend(parts.iter().filter(|(_, is_there)| !is_there).map(|(name, _)| format!("it has no {name}")));
        for (file, anchor) in self.includes() {
            let text = std::fs::read_to_string(root.join(&file)).unwrap_or_default();
            let has = |mark: &str| text.lines().any(|line| line.trim() == format!("// {mark}: {anchor}"));
            if !has("ANCHOR") || !has("ANCHOR_END") {
                problems.push(format!("{} has no anchor {anchor:?}", file.display()));
            }
        }
        let outward = self.links().into_iter().map(|(_, target)| target).filter(|target| target.starts_with("../"));
        problems.extend(outward.filter_map(|target| {
            let path = target.split('#').next().unwrap_or_default();
            let is_there = root.join(SOURCE).join(path).exists();
            (!is_there).then(|| format!("there is no {target}"))
        }));
        problems.extend(Self::prepared(&self.text).err());
        problems
    }
}

/// A block of code without the indentation that all of its lines share.
fn moved_left(code: &str) -> String {
    let lines: Vec<&str> = code.lines().collect();
    let [first, inside @ .., last] = &lines[..] else { return code.to_owned() };
    let indents = inside.iter().filter(|line| !line.trim().is_empty());
    let indent = indents.map(|line| line.len() - line.trim_start().len()).min().unwrap_or(0);
    let inside = inside.iter().map(|line| line.get(indent..).unwrap_or_default());
    std::iter::once(*first).chain(inside).chain([*last]).collect::<Vec<_>>().join("\n")
}

/// Prose whose links fit the built book.
fn relinked(prose: &str) -> String {
    let (found, rest) = links(prose);
    let relinked = found.into_iter().map(|(before, Link { is_picture, text, target })| {
        let mark = if is_picture { "!" } else { "" };
        match target.strip_prefix(PICTURES[0]) {
            Some(name) => format!("{before}{mark}[{text}]({}{name})", PICTURES[1]),
            None if target.starts_with("../") => format!("{before}{text}"),
            None => format!("{before}{mark}[{text}]({target})"),
        }
    });
    relinked.collect::<String>() + rest
}

/// A path without `..`.
fn flat(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut flat, part| {
        if part.as_os_str() == ".." {
            flat.pop();
        } else {
            flat.push(part);
        }
        flat
    })
}

/// Checks the chapters as they are written.
///
/// # Errors
/// Everything that is wrong, a line each: what a chapter lacks, and anchors of the code that no chapter includes.
pub(crate) fn check(root: &Path) -> Result {
    let chapters = all(root)?;
    let mut problems = Vec::new();
    // The first page introduces the others.
    for chapter in chapters.iter().skip(1) {
        problems.extend(chapter.problems(root).into_iter().map(|problem| format!("{}: {problem}", chapter.file)));
    }
    let included: BTreeSet<_> = chapters.iter().flat_map(Chapter::includes).collect();
    let unused = anchors(root)?.into_iter().filter(|anchor| !included.contains(anchor));
    problems.extend(unused.map(|(file, anchor)| format!("{}: no chapter includes {anchor}", file.display())));
    if problems.is_empty() { Ok(()) } else { Err(Failure::new(problems.join("\n"))) }
}

/// All anchors in the code: the files from the root, and the names.
fn anchors(root: &Path) -> Result<BTreeSet<(PathBuf, String)>> {
    let mut found = BTreeSet::new();
    let mut folders: Vec<PathBuf> = CODE.iter().map(PathBuf::from).collect();
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| Failure::new(format!("{}: {error}", folder.display()));
        for entry in std::fs::read_dir(root.join(&folder)).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let path = folder.join(entry.file_name());
            if entry.file_type().map_err(failed)?.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "wgsl") {
                let text = std::fs::read_to_string(root.join(&path)).map_err(failed)?;
                let names = text.lines().filter_map(|line| line.trim().strip_prefix("// ANCHOR: "));
                found.extend(names.map(|name| (path.clone(), name.to_owned())));
            }
        }
    }
    Ok(found)
}

/// mdBook's preprocessor: reads the book as JSON and writes it with the chapters prepared.
///
/// # Errors
/// Input that is not mdBook's, or a formula that is not TeX.
pub(crate) fn preprocess(input: impl std::io::Read, output: impl std::io::Write) -> Result {
    let failed = |error: serde_json::Error| Failure::new(format!("the book as mdBook passes it: {error}"));
    let [_, mut book]: [Value; 2] = serde_json::from_reader(input).map_err(failed)?;
    prepare_all(&mut book)?;
    serde_json::to_writer(output, &book).map_err(failed)
}

fn prepare_all(value: &mut Value) -> Result {
    match value {
        Value::Array(items) => items.iter_mut().try_for_each(prepare_all),
        Value::Object(fields) => fields.iter_mut().try_for_each(|(name, value)| match value {
            Value::String(text) if name == "content" => {
                *text = Chapter::prepared(text).map_err(Failure::new)?;
                Ok(())
            }
            value => prepare_all(value),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cargo::root;

    #[test]
    fn the_chapters_are_sound() {
        check(&root()).unwrap_or_else(|failure| panic!("{failure}"));
        assert!(all(&root()).unwrap().len() >= 15);
    }

    #[test]
    fn what_a_chapter_lacks_is_named() {
        let text = "$\\alhpa$ ![a](../../pictures/no_such.png)\n```rust\n\
                    {{#include ../../../crates/lighting/src/shade.rs:no_such}}\n```\n";
        let chapter = Chapter { file: "a.md".to_owned(), text: text.to_owned() };
        let problems = chapter.problems(&root());
        let expected = [
            "it has no question with a command and its answer",
            "crates/lighting/src/shade.rs has no anchor \"no_such\"",
            "there is no ../../pictures/no_such.png",
            "\\alhpa: unknown primitive command found",
        ];
        assert_eq!(problems, expected);
    }

    #[test]
    fn chapters_are_prepared_for_a_book_that_stands_alone() {
        let book = r#"[{}, {"items": [{"Chapter": {"content": "![a](../../pictures/b.png) [c](../../d.md) [e](f.md) $x$"}}]}]"#;
        let mut output = Vec::new();
        preprocess(book.as_bytes(), &mut output).unwrap();
        let book: Value = serde_json::from_slice(&output).unwrap();
        let expected = "![a](pictures/b.png) c [e](f.md) <math display=\"inline\"><mi>x</mi></math>";
        assert_eq!(book["items"][0]["Chapter"]["content"], expected);
        assert!(preprocess("{}".as_bytes(), Vec::new()).is_err());
        let code = "```rust\n    /// `a`\n    fn a() {\n\n        b();\n    }\n```";
        assert_eq!(Chapter::prepared(code).unwrap(), "```rust\n/// `a`\nfn a() {\n\n    b();\n}\n```");
    }
}

//! No circle of files: if one file uses another, the other does not use it, directly or through others.
//!
//! A file uses the files whose items it names, by `use` or by a path; where the name is re-exported on the way, the
//! file that defines it counts. Declaring a module or re-exporting a name is not a use. Uses of a module's own children
//! do not count either: they are its parts, and it may know them.
//!
//! The same holds for folders that lie beside each other: the files of one together, with the file of the folder's own
//! module.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use super::metadata::packages;
use super::none_of;
use super::source::{Crate, Meaning};
use crate::failure::Result;

/// Files by number; for each, the files that it uses, with the names.
type Ties = BTreeMap<PathBuf, BTreeMap<PathBuf, BTreeSet<String>>>;

/// Checks every crate of the workspace in `root`.
pub(crate) fn run(root: &Path) -> Result {
    let mut faults = Vec::new();
    for package in packages(root)? {
        for first in &package.roots {
            let ties = ties(&Crate::read(first)?);
            faults.extend(circles(&ties, root, "files"));
            faults.extend(circles(&between_folders(&ties), root, "folders"));
        }
    }
    none_of(&faults)
}

/// Which file uses which names of which file.
fn ties(krate: &Crate) -> Ties {
    let mut ties = Ties::new();
    for (index, module) in krate.modules.iter().enumerate() {
        let mut take = |meaning: Option<Meaning>| {
            let Some(Meaning::Item(from, name)) = meaning else { return };
            let other = &krate.modules[from].file;
            if *other != module.file && !krate.is_within(from, index) {
                ties.entry(module.file.clone()).or_default().entry(other.clone()).or_default().insert(name);
            }
        };
        for import in &module.imports {
            match &import.name {
                Some(name) if import.handed_on && !module.words.contains(name) => {}
                Some(_) => take(krate.meaning(index, &import.path)),
                None => {
                    let Some(Meaning::Module(all)) = krate.meaning(index, &import.path) else { continue };
                    module.words.iter().for_each(|word| take(krate.named(all, word)));
                }
            }
        }
        module.paths.iter().for_each(|path| take(krate.meaning(index, path)));
    }
    ties
}

/// The same ties between folders that lie beside each other: each tie of two files counts for the folders in which their
/// paths part, where both are folders.
fn between_folders(ties: &Ties) -> Ties {
    let files = ties.iter().flat_map(|(file, used)| [file].into_iter().chain(used.keys()));
    let folders: BTreeSet<&Path> = files.flat_map(|file| file.ancestors().skip(1)).collect();
    let mut between = Ties::new();
    for (file, other, names) in ties.iter().flat_map(|(file, used)| used.iter().map(move |(o, names)| (file, o, names)))
    {
        let parent = file.ancestors().find(|folder| other.starts_with(folder)).unwrap_or(Path::new(""));
        // The file of a folder's module, `name.rs`, belongs to the folder `name`.
        let part = |file: &Path| {
            let next = file.strip_prefix(parent).ok()?.components().next()?;
            Some(parent.join(next).with_extension("")).filter(|part| folders.contains(part.as_path()))
        };
        if let (Some(from), Some(to)) = (part(file), part(other))
            && from != to
        {
            between.entry(from).or_default().entry(to).or_default().extend(names.iter().cloned());
        }
    }
    between
}

/// A description of each circle that shares no file with one described before: the shortest through its first file.
fn circles(ties: &Ties, root: &Path, kind: &str) -> Vec<String> {
    let mut done = BTreeSet::new();
    let mut found = Vec::new();
    for file in ties.keys() {
        if done.contains(file) {
            continue;
        }
        let reached = reachable(ties, file);
        let tied: BTreeSet<_> = reached.iter().filter(|other| reachable(ties, other).contains(file)).cloned().collect();
        if tied.is_empty() {
            continue;
        }
        found.push(described(ties, &shortest(ties, &tied), &tied, root, kind));
        done.extend(tied);
    }
    found
}

/// The files that one uses, directly or through others; itself only if it is in a circle.
fn reachable(ties: &Ties, start: &Path) -> BTreeSet<PathBuf> {
    let mut reached = BTreeSet::new();
    let mut left = vec![start];
    while let Some(file) = left.pop() {
        for next in ties.get(file).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(next.clone()) {
                left.push(next);
            }
        }
    }
    reached
}

/// The shortest circle among files that are all in circles: its files in order, the first again at the end.
fn shortest(ties: &Ties, tied: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
    let around = |start: &PathBuf| {
        let mut before: BTreeMap<&PathBuf, &PathBuf> = BTreeMap::new();
        let mut left = VecDeque::from([start]);
        while let Some(file) = left.pop_front() {
            for next in ties.get(file).into_iter().flat_map(BTreeMap::keys).filter(|next| tied.contains(*next)) {
                if next == start {
                    let back = std::iter::successors(Some(file), |file| before.get(file).copied());
                    let mut circle: Vec<PathBuf> = [start].into_iter().chain(back).cloned().collect();
                    circle.reverse();
                    return Some(circle);
                }
                if !before.contains_key(next) {
                    before.insert(next, file);
                    left.push_back(next);
                }
            }
        }
        None
    };
    tied.iter().filter_map(around).min_by_key(Vec::len).unwrap_or_default()
}

fn described(ties: &Ties, circle: &[PathBuf], tied: &BTreeSet<PathBuf>, root: &Path, kind: &str) -> String {
    let short = |file: &Path| file.strip_prefix(root).unwrap_or(file).display().to_string();
    let steps = circle.windows(2).map(|step| {
        let names: Vec<&str> = ties[&step[0]][&step[1]].iter().map(String::as_str).collect();
        format!("      {} takes {} from {}", short(&step[0]), names.join(", "), short(&step[1]))
    });
    let steps: Vec<String> = steps.collect();
    let text = format!("{} {kind} in a circle:\n{}", steps.len(), steps.join("\n"));
    if tied.len() == steps.len() {
        return text;
    }
    let all: Vec<String> = tied.iter().map(|file| short(file)).collect();
    format!("{text}\n      which is the shortest of the circles that tie {} {kind}: {}", all.len(), all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::source::tests::planted;

    /// The circles of a crate whose files are given.
    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let (folder, krate) = planted(files);
        circles(&ties(&krate), folder.path(), "files")
    }

    #[test]
    fn circles_of_folders_are_found_where_files_form_none() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a/mod.rs", "mod one; pub mod two;"),
            ("a/one.rs", "pub fn one() { crate::b::b() }"),
            ("a/two.rs", "pub fn two() {}"),
            ("b.rs", "mod inner; pub fn b() {}"),
            ("b/inner.rs", "pub fn inner() { crate::a::two::two(); crate::c::c() }"),
            ("c.rs", "pub fn c() { crate::a::two::two() }"),
        ];
        let (folder, krate) = planted(&files);
        let ties = ties(&krate);
        assert!(circles(&ties, folder.path(), "files").is_empty());
        let expected = "2 folders in a circle:\n      a takes b from b\n      b takes two from a";
        assert_eq!(circles(&between_folders(&ties), folder.path(), "folders"), [expected]);
    }

    #[test]
    fn circles_are_found_with_the_names_that_form_them() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use crate::b::Beta; pub struct Alpha(Beta);"),
            ("b.rs", "pub struct Beta; fn f() { assert!(super::c::gamma()) }"),
            ("c.rs", "pub fn gamma() -> bool { let _ = |_: crate::a::Alpha| (); true }"),
        ];
        let steps = ["a.rs takes Beta from b.rs", "b.rs takes gamma from c.rs", "c.rs takes Alpha from a.rs"];
        assert_eq!(found(&files), [format!("3 files in a circle:\n      {}", steps.join("\n      "))]);
    }

    #[test]
    fn every_kind_of_use_is_seen() {
        let back = "pub struct Beta; pub fn f(_: crate::a::Alpha) {}";
        let rows = [
            ("use", "use crate::b::Beta; pub struct Alpha;"),
            ("a group", "use crate::{b::{Beta as B}}; pub struct Alpha;"),
            ("a path", "pub struct Alpha; fn f() -> crate::b::Beta { todo!() }"),
            ("a path in a macro", "pub struct Alpha; fn f() { println!(\"{}\", super::b::f as usize) }"),
            ("everything", "use super::b::*; pub struct Alpha(Beta);"),
            ("a module", "use crate::b; pub struct Alpha(b::Beta);"),
            ("a re-export", "use crate::Beta; pub struct Alpha;"),
            ("a renamed one", "use crate::Gamma; pub struct Alpha;"),
            ("a macro", "pub struct Alpha; crate::b::make!();"),
        ];
        for (name, text) in rows {
            let lib = "mod a; mod b; pub use b::Beta; pub use b::Beta as Gamma;";
            let back = format!("{back} macro_rules! make {{ () => {{}} }} pub(crate) use make;");
            assert_eq!(found(&[("lib.rs", lib), ("a.rs", text), ("b.rs", &back)]).len(), 1, "{name}");
        }
    }

    #[test]
    fn unrelated_files_form_no_circle() {
        let parent = "mod child; pub use child::Child; pub struct Parent;";
        let rows: [(&str, &str, &str); 5] = [
            ("to declare and to hand on", parent, "pub struct Child(super::Parent);"),
            ("one way only", "mod child; fn f(_: child::Child) {}", "pub struct Child;"),
            (
                "what belongs together",
                "mod child; fn f(_: child::Child) {} struct Own;",
                "pub struct Child(super::Own);",
            ),
            (
                "tests",
                "mod child; fn f(_: child::Child) {} pub fn g() {}",
                "pub struct Child; #[cfg(test)] mod tests { use super::super::g; }",
            ),
            (
                "other crates",
                "mod child; fn f(_: child::Child) {} pub mod io {}",
                "use std::io::Read; pub struct Child;",
            ),
        ];
        for (name, lib, child) in rows {
            assert_eq!(found(&[("lib.rs", lib), ("child.rs", child)]), Vec::<String>::new(), "{name}");
        }
        let a = "pub use crate::b::Beta; pub struct Alpha;";
        let b = "pub struct Beta(crate::a::Alpha);";
        assert!(found(&[("lib.rs", "mod a; mod b;"), ("a.rs", a), ("b.rs", b)]).is_empty(), "handed on only");
        let used = format!("{a} fn f(_: Beta) {{}}");
        assert_eq!(found(&[("lib.rs", "mod a; mod b;"), ("a.rs", &used), ("b.rs", b)]).len(), 1, "used as well");
    }

    #[test]
    fn the_shortest_of_many_is_shown() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "pub fn a() { crate::b::b() }"),
            ("b.rs", "pub fn b() { crate::c::c(); crate::a::a() }"),
            ("c.rs", "pub fn c() { crate::a::a() }"),
        ];
        let found = found(&files);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("2 files in a circle:"), "{}", found[0]);
        assert!(found[0].ends_with("tie 3 files: a.rs, b.rs, c.rs"), "{}", found[0]);
    }
}

//! The built book: whether every link of it leads somewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result};

/// Checks the links of all pages in a folder to pages, parts of pages and files. Addresses on the network are not
/// followed.
///
/// # Errors
/// Every link that leads nowhere, with its page.
pub(crate) fn check(folder: &Path) -> Result {
    let mut pages = BTreeMap::new();
    read(folder, folder, &mut pages)?;
    let ids: BTreeMap<&PathBuf, BTreeSet<&str>> =
        pages.iter().map(|(file, text)| (file, values(text, "id").into_iter().collect())).collect();
    let mut problems = Vec::new();
    for (file, text) in &pages {
        for target in values(text, "href").into_iter().chain(values(text, "src")) {
            if target.contains(':') {
                continue;
            }
            let (path, part) = target.split_once('#').unwrap_or((target, ""));
            let path = path.split('?').next().unwrap_or_default();
            let aim = if path.is_empty() { file.clone() } else { joined(file, path) };
            let aim = if folder.join(&aim).is_dir() { aim.join("index.html") } else { aim };
            let has_part = part.is_empty() || ids.get(&aim).is_none_or(|ids| ids.contains(part));
            if !folder.join(&aim).is_file() || !has_part {
                problems.push(format!("{}: {target}", file.display()));
            }
        }
    }
    problems.dedup();
    if pages.is_empty() {
        return Err(Failure::new(format!("{}: there are no pages", folder.display())));
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::new(format!("dead links:\n{}", problems.join("\n")))) }
}

/// The HTML pages of a folder and those in it, by their paths.
fn read(root: &Path, folder: &Path, pages: &mut BTreeMap<PathBuf, String>) -> Result {
    let failed = |error: std::io::Error| Failure::new(format!("{}: {error}", folder.display()));
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            read(root, &path, pages)?;
        } else if path.extension().is_some_and(|ending| ending == "html") {
            let text = std::fs::read_to_string(&path).map_err(failed)?;
            pages.insert(path.strip_prefix(root).unwrap_or(&path).to_owned(), text);
        }
    }
    Ok(())
}

/// The values of an attribute, `data-…` left out.
fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let mark = format!(" {attribute}=\"");
    page.split(&mark as &str).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0)).collect()
}

/// A path that is relative to a page.
fn joined(page: &Path, path: &str) -> PathBuf {
    let start = if path.starts_with('/') { PathBuf::new() } else { page.parent().unwrap_or(Path::new("")).to_owned() };
    path.split('/').fold(start, |mut joined, part| {
        match part {
            "" | "." => {}
            ".." => {
                joined.pop();
            }
            part => joined.push(part),
        }
        joined
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_links_are_listed() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let file = folder.path().join(name);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, text).unwrap();
        };
        write(
            "a.html",
            r#"<a href="b/c.html#there">x</a> <img src="p.png"> <a href="https://x.org/y">z</a> <h1 id="top">"#,
        );
        write("b/c.html", r##"<a id="there" href="../a.html#top">x</a> <a href="#there"></a> <a href="."></a>"##);
        write("b/index.html", "");
        write("p.png", "");
        assert_eq!(check(folder.path()), Ok(()));
        write("d.html", r##"<a href="b/c.html#gone">x</a> <img src="q.png"> <a href="#top">y</a>"##);
        let problem = check(folder.path()).unwrap_err().to_string();
        assert_eq!(problem, "dead links:\nd.html: b/c.html#gone\nd.html: #top\nd.html: q.png");
        assert!(check(&folder.path().join("none")).is_err());
    }
}

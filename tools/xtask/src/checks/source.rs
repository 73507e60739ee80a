//! The modules of a crate, read from their files, and the meaning of paths in them.
//!
//! Code that is compiled for tests only is left out.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, Ident, ImplItem, Item, Meta, UseTree, Visibility};

use crate::failure::{Failure, Result};

/// A library or a program.
#[derive(Debug)]
pub(crate) struct Crate {
    /// The first is the root.
    pub(crate) modules: Vec<Module>,
}

/// A module: a file, or a block of one.
#[derive(Debug, Default)]
pub(crate) struct Module {
    pub(crate) file: PathBuf,
    parent: usize,
    children: HashMap<String, usize>,
    pub(crate) imports: Vec<Import>,
    /// The names of its items, re-exports left out.
    defines: HashSet<String>,
    /// The paths of two names and more in its items, imports left out.
    pub(crate) paths: Vec<Vec<String>>,
    /// Every name that occurs in its items.
    pub(crate) words: HashSet<String>,
}

/// A name that `use` brings into a module.
#[derive(Debug)]
pub(crate) struct Import {
    /// The name that it has here; none for `*`.
    pub(crate) name: Option<String>,
    pub(crate) path: Vec<String>,
    /// Whether it is re-exported.
    pub(crate) handed_on: bool,
}

/// The meaning of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Module(usize),
    /// The module that defines the item, and its name there.
    Item(usize, String),
}

impl Crate {
    /// Reads a crate from its first file on.
    ///
    /// # Errors
    /// The file that cannot be read or is not Rust.
    pub(crate) fn read(root: &Path) -> Result<Self> {
        let mut read = Self { modules: Vec::new() };
        let folder = root.parent().unwrap_or(Path::new("")).to_owned();
        read.file(root, &folder, 0)?;
        Ok(read)
    }

    /// Reads the file of a module whose children's files are in `folder`.
    fn file(&mut self, file: &Path, folder: &Path, parent: usize) -> Result<usize> {
        let failed = |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", file.display()));
        let text = std::fs::read_to_string(file).map_err(|error| failed(&error))?;
        let syntax = syn::parse_file(&text).map_err(|error| failed(&error))?;
        self.module(file, folder, parent, syntax.items)
    }

    fn module(&mut self, file: &Path, folder: &Path, parent: usize, items: Vec<Item>) -> Result<usize> {
        let index = self.modules.len();
        self.modules.push(Module { file: file.to_owned(), parent, ..Module::default() });
        for item in items.into_iter().filter(|item| !for_tests(attributes_and_name(item).0)) {
            match item {
                Item::Mod(item) => {
                    let name = plain(&item.ident);
                    let inner = folder.join(&name);
                    let child = match item.content {
                        Some((_, items)) => self.module(file, &inner, index, items)?,
                        None => self.file(&file_of(folder, &name), &inner, index)?,
                    };
                    self.modules[index].children.insert(name, child);
                }
                Item::Use(item) => {
                    let handed_on = !matches!(item.vis, Visibility::Inherited);
                    imports(&item.tree, &mut Vec::new(), handed_on, &mut self.modules[index].imports);
                }
                Item::Impl(mut item) => {
                    item.items.retain(|item| !matches!(item, ImplItem::Fn(item) if for_tests(&item.attrs)));
                    self.modules[index].scan(item.to_token_stream());
                }
                item => self.modules[index].take(&item),
            }
        }
        Ok(index)
    }

    /// The meaning of a path in module `from`, or `None` if it leads out of the crate.
    pub(crate) fn meaning(&self, from: usize, path: &[String]) -> Option<Meaning> {
        self.follow(from, path, &mut HashSet::new())
    }

    /// The meaning of `name` in module `at`, or `None`.
    pub(crate) fn named(&self, at: usize, name: &str) -> Option<Meaning> {
        self.look_up(at, name, &mut HashSet::new())
    }

    /// Whether a module is inside another, at any depth.
    pub(crate) fn is_within(&self, module: usize, other: usize) -> bool {
        let parents = std::iter::successors(Some(module), |&at| (at != 0).then(|| self.modules[at].parent));
        parents.skip(1).any(|at| at == other)
    }

    fn follow(&self, from: usize, path: &[String], seen: &mut HashSet<(usize, String)>) -> Option<Meaning> {
        let mut at = from;
        for (place, name) in path.iter().enumerate() {
            match name.as_str() {
                "crate" if place == 0 => at = 0,
                "self" => {}
                "super" => at = self.modules[at].parent,
                name => match self.look_up(at, name, seen)? {
                    Meaning::Module(module) => at = module,
                    item @ Meaning::Item(..) => return Some(item),
                },
            }
        }
        Some(Meaning::Module(at))
    }

    fn look_up(&self, at: usize, name: &str, seen: &mut HashSet<(usize, String)>) -> Option<Meaning> {
        let module = &self.modules[at];
        if let Some(&child) = module.children.get(name) {
            return Some(Meaning::Module(child));
        }
        if module.defines.contains(name) {
            return Some(Meaning::Item(at, name.to_owned()));
        }
        // Re-exports may form a circle.
        if !seen.insert((at, name.to_owned())) {
            return None;
        }
        let (globs, named): (Vec<_>, Vec<_>) = module.imports.iter().partition(|import| import.name.is_none());
        for import in named.into_iter().filter(|import| import.name.as_deref() == Some(name)) {
            if let Some(meaning) = self.follow(at, &import.path, seen) {
                return Some(meaning);
            }
        }
        for glob in globs {
            if let Some(Meaning::Module(module)) = self.follow(at, &glob.path, seen)
                && let Some(meaning) = self.look_up(module, name, seen)
            {
                return Some(meaning);
            }
        }
        None
    }
}

impl Module {
    /// Records an item other than `mod`, `use` and `impl`.
    fn take(&mut self, item: &Item) {
        self.defines.extend(attributes_and_name(item).1.map(plain));
        self.scan(item.to_token_stream());
    }

    /// Collects names and paths, also those inside calls of macros.
    fn scan(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        // The number of colons found so far, of the two that may continue the path.
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(name) => {
                    let name = plain(&name);
                    self.words.insert(name.clone());
                    if colons != 2 {
                        self.end(&mut path);
                    }
                    path.push(name);
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' && !path.is_empty() => colons += 1,
                TokenTree::Group(group) => {
                    self.end(&mut path);
                    colons = 0;
                    self.scan(group.stream());
                }
                _ => {
                    self.end(&mut path);
                    colons = 0;
                }
            }
        }
        self.end(&mut path);
    }

    fn end(&mut self, path: &mut Vec<String>) {
        let path = std::mem::take(path);
        if path.len() > 1 {
            self.paths.push(path);
        }
    }
}

/// A name without the `r#` that lets it be a keyword.
fn plain(name: &Ident) -> String {
    name.to_string().trim_start_matches("r#").to_owned()
}

fn file_of(folder: &Path, name: &str) -> PathBuf {
    let file = folder.join(format!("{name}.rs"));
    if file.is_file() { file } else { folder.join(name).join("mod.rs") }
}

fn imports(tree: &UseTree, path: &mut Vec<String>, handed_on: bool, all: &mut Vec<Import>) {
    let leaf = |name: Option<String>, path: Vec<String>| Import { name, path, handed_on };
    match tree {
        UseTree::Path(tree) => {
            path.push(plain(&tree.ident));
            imports(&tree.tree, path, handed_on, all);
            path.pop();
        }
        UseTree::Name(tree) if tree.ident == "self" => all.push(leaf(path.last().cloned(), path.clone())),
        UseTree::Name(tree) => all.push(leaf(Some(plain(&tree.ident)), joined(path, plain(&tree.ident)))),
        UseTree::Rename(tree) if tree.ident == "self" => all.push(leaf(Some(plain(&tree.rename)), path.clone())),
        UseTree::Rename(tree) => all.push(leaf(Some(plain(&tree.rename)), joined(path, plain(&tree.ident)))),
        UseTree::Glob(_) => all.push(leaf(None, path.clone())),
        UseTree::Group(tree) => tree.items.iter().for_each(|tree| imports(tree, path, handed_on, all)),
    }
}

fn joined(path: &[String], name: String) -> Vec<String> {
    path.iter().cloned().chain([name]).collect()
}

fn attributes_and_name(item: &Item) -> (&[Attribute], Option<&Ident>) {
    match item {
        Item::Mod(item) => (&item.attrs, Some(&item.ident)),
        Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
        Item::Use(item) => (&item.attrs, None),
        Item::Impl(item) => (&item.attrs, None),
        Item::Struct(item) => (&item.attrs, Some(&item.ident)),
        Item::Enum(item) => (&item.attrs, Some(&item.ident)),
        Item::Union(item) => (&item.attrs, Some(&item.ident)),
        Item::Trait(item) => (&item.attrs, Some(&item.ident)),
        Item::Const(item) => (&item.attrs, Some(&item.ident)),
        Item::Static(item) => (&item.attrs, Some(&item.ident)),
        Item::Type(item) => (&item.attrs, Some(&item.ident)),
        Item::TraitAlias(item) => (&item.attrs, Some(&item.ident)),
        Item::Macro(item) => (&item.attrs, item.ident.as_ref()),
        _ => (&[], None),
    }
}

/// Whether one of the attributes is `#[test]`, or `#[cfg(…)]` with `test` and without `not`.
fn for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("cfg") => {
            let words: Vec<String> =
                list.tokens.to_string().split(|c: char| !c.is_alphanumeric()).map(str::to_owned).collect();
            words.iter().any(|word| word == "test") && !words.iter().any(|word| word == "not")
        }
        _ => false,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use tempfile::TempDir;

    /// A crate made of files, each a name in `src` and a text; the first is the root.
    pub(crate) fn planted(files: &[(&str, &str)]) -> (TempDir, Crate) {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let read = Crate::read(&folder.path().join(files[0].0)).unwrap();
        (folder, read)
    }

    #[test]
    fn paths_resolve_to_definitions() {
        let (_folder, krate) = planted(&[
            ("lib.rs", "mod a; mod b; pub use a::*; pub use b::inner::Deep as Renamed;"),
            ("a.rs", "pub struct One; #[cfg(test)] pub struct ForTests;"),
            ("b/mod.rs", "pub mod inner; use crate::a as other; pub use super::One; pub fn two() {}"),
            ("b/inner.rs", "pub struct Deep; impl Deep { #[cfg(test)] fn t() { crate::a::One; } }"),
        ]);
        let file = |name: &str| krate.modules.iter().position(|module| module.file.ends_with(name)).unwrap();
        let rows = [
            (0, "crate::a::One", Some(Meaning::Item(file("a.rs"), "One".into()))),
            (0, "crate::One", Some(Meaning::Item(file("a.rs"), "One".into()))),
            (0, "Renamed::new", Some(Meaning::Item(file("b/inner.rs"), "Deep".into()))),
            (0, "crate::a", Some(Meaning::Module(file("a.rs")))),
            (0, "crate::a::ForTests", None),
            (0, "std::fs::read", None),
            (file("b/inner.rs"), "super::two", Some(Meaning::Item(file("b/mod.rs"), "two".into()))),
            (file("b/inner.rs"), "super::One", Some(Meaning::Item(file("a.rs"), "One".into()))),
            (file("b/mod.rs"), "other::One", Some(Meaning::Item(file("a.rs"), "One".into()))),
            (file("b/mod.rs"), "self::inner::Deep", Some(Meaning::Item(file("b/inner.rs"), "Deep".into()))),
        ];
        for (from, path, expected) in rows {
            let path: Vec<String> = path.split("::").map(str::to_owned).collect();
            assert_eq!(krate.meaning(from, &path), expected, "{path:?}");
        }
        assert!(krate.modules[file("b/inner.rs")].paths.is_empty(), "functions for tests are left out");
    }
}

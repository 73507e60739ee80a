//! Cargo's metadata about the packages of the workspace.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cargo::{cargo, printed};
use crate::failure::{Failure, Result};

/// A package of the workspace.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) name: String,
    /// The root files of its library and programs; not of its tests and examples.
    pub(crate) roots: Vec<PathBuf>,
    /// Its dependencies and those of its build script; not those of its tests alone.
    pub(crate) dependencies: Vec<Dependency>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Dependency {
    pub(crate) name: String,
    /// Whether it is in this workspace.
    pub(crate) inside: bool,
}

/// The packages of the workspace in a folder.
///
/// # Errors
/// Cargo cannot read the manifests.
pub(crate) fn packages(root: &Path) -> Result<Vec<Package>> {
    metadata(root, read)
}

/// The names of all test programs in the workspace's folders `tests`, each once.
///
/// # Errors
/// Cargo cannot read the manifests.
pub(crate) fn test_programs(root: &Path) -> Result<Vec<String>> {
    metadata(root, |json| {
        let metadata: Value = serde_json::from_slice(json).ok()?;
        let packages = metadata["packages"].as_array()?.iter();
        let targets = packages.map(|package| package["targets"].as_array()).collect::<Option<Vec<_>>>()?;
        let programs = targets.into_iter().flatten().filter(|target| target["kind"][0] == "test");
        let names: BTreeSet<_> = programs.filter_map(|target| Some(target["name"].as_str()?.to_owned())).collect();
        Some(names.into_iter().collect())
    })
}

fn metadata<T>(root: &Path, read: impl Fn(&[u8]) -> Option<T>) -> Result<T> {
    let mut command = cargo(["metadata", "--format-version", "1", "--no-deps"]);
    let output = printed(command.current_dir(root))?;
    read(&output).ok_or_else(|| Failure::new("cargo metadata: not what it used to print"))
}

fn read(json: &[u8]) -> Option<Vec<Package>> {
    let metadata: Value = serde_json::from_slice(json).ok()?;
    metadata["packages"].as_array()?.iter().map(package).collect()
}

fn package(json: &Value) -> Option<Package> {
    let kinds = |target: &Value| target["kind"].as_array().cloned().unwrap_or_default();
    let built = |target: &&Value| kinds(target).iter().any(|kind| kind == "lib" || kind == "bin");
    let needed = |dependency: &&Value| dependency["kind"] != "dev";
    let root = |target: &Value| Some(PathBuf::from(target["src_path"].as_str()?));
    let dependency = |json: &Value| {
        let name = json["name"].as_str()?.to_owned();
        Some(Dependency { name, inside: json["path"].is_string() })
    };
    Some(Package {
        name: json["name"].as_str()?.to_owned(),
        roots: json["targets"].as_array()?.iter().filter(built).map(root).collect::<Option<_>>()?,
        dependencies: json["dependencies"].as_array()?.iter().filter(needed).map(dependency).collect::<Option<_>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cargo::root;

    #[test]
    fn the_workspace_can_be_read() {
        let packages = packages(&root()).unwrap();
        let mesh = packages.iter().find(|package| package.name == "halfway_mesh").unwrap();
        assert_eq!(mesh.roots, [root().join("crates/mesh/src/lib.rs")]);
        assert!(mesh.dependencies.iter().any(|dependency| dependency.name == "thiserror" && !dependency.inside));
        let render = packages.iter().find(|package| package.name == "halfway_render").unwrap();
        assert!(render.dependencies.iter().any(|dependency| dependency.name == "halfway_mesh" && dependency.inside));
        assert_eq!(read(b"{}"), None);
    }
}

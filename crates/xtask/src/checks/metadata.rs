//! What cargo says about the packages of the workspace.

use serde_json::Value;
use std::path::{Path, PathBuf};

use crate::cargo::{cargo, ended, not_started};
use crate::failure::{Failure, Result};

/// A package of the workspace.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) manifest: PathBuf,
    /// As its manifest says, or nothing.
    pub(crate) description: String,
    pub(crate) license: String,
    pub(crate) readme: String,
    pub(crate) rust_version: String,
    /// The first files of its library and programs; not of its tests and examples.
    pub(crate) roots: Vec<PathBuf>,
    /// What it is built with, and what its build script is; not what only its tests need.
    pub(crate) dependencies: Vec<Dependency>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Dependency {
    pub(crate) name: String,
    /// Of this workspace.
    pub(crate) inside: bool,
    /// The versions that will do; `*` where the manifest does not say.
    pub(crate) versions: String,
}

/// The packages of the workspace in a folder.
///
/// # Errors
/// Cargo cannot read the manifests.
pub(crate) fn packages(root: &Path) -> Result<Vec<Package>> {
    metadata(root, read)
}

/// The folder that cargo builds into.
///
/// # Errors
/// Cargo cannot read the manifests.
pub(crate) fn target_folder(root: &Path) -> Result<PathBuf> {
    metadata(root, |json| {
        let metadata: Value = serde_json::from_slice(json).ok()?;
        Some(metadata["target_directory"].as_str()?.into())
    })
}

fn metadata<T>(root: &Path, read: impl Fn(&[u8]) -> Option<T>) -> Result<T> {
    let mut command = cargo(["metadata", "--format-version", "1", "--no-deps"]);
    let output = command.current_dir(root).output().map_err(|error| not_started(&command, &error))?;
    if !output.status.success() {
        eprint!("{}", String::from_utf8_lossy(&output.stderr));
        return Err(ended(&command, output.status));
    }
    read(&output.stdout).ok_or_else(|| Failure::new("cargo metadata: not what it used to print"))
}

fn read(json: &[u8]) -> Option<Vec<Package>> {
    let metadata: Value = serde_json::from_slice(json).ok()?;
    metadata["packages"].as_array()?.iter().map(package).collect()
}

fn package(json: &Value) -> Option<Package> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let kinds = |target: &Value| target["kind"].as_array().cloned().unwrap_or_default();
    let built = |target: &&Value| kinds(target).iter().any(|kind| kind == "lib" || kind == "bin");
    let needed = |dependency: &&Value| dependency["kind"] != "dev";
    let root = |target: &Value| Some(PathBuf::from(target["src_path"].as_str()?));
    let dependency = |json: &Value| {
        let name = json["name"].as_str()?.to_owned();
        Some(Dependency { name, inside: json["path"].is_string(), versions: text(&json["req"]) })
    };
    Some(Package {
        name: json["name"].as_str()?.to_owned(),
        manifest: json["manifest_path"].as_str()?.into(),
        description: text(&json["description"]),
        license: text(&json["license"]),
        readme: text(&json["readme"]),
        rust_version: text(&json["rust_version"]),
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

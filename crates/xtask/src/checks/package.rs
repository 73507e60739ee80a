//! The crates that a user would depend on can be packaged, and what is in the packages builds without the rest.
//!
//! Nothing is published. The packages are made without cargo's own trial, which would build every dependency again in
//! another profile; they are unpacked and checked together instead, as a user's dependency.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::metadata::{Package, packages};
use super::none_of;
use crate::cargo::{cargo, step};
use crate::failure::{Failure, Result};

/// The crate that users depend on.
const FRONT: &str = "halfway";
/// Where packages are made and tried, from the project's folder.
const FOLDER: &str = "target/packages";
/// What each package must hold beside its code.
const PAPERS: [&str; 3] = ["README.md", "LICENSE-MIT", "LICENSE-APACHE"];

/// Packages and tries the crates of the workspace in `root`.
pub(crate) fn run(root: &Path) -> Result {
    let all = packages(root)?;
    let wanted = behind(&all, FRONT);
    none_of(&wanted.iter().flat_map(|package| faults(package)).collect::<Vec<_>>())?;
    let folder = root.join(FOLDER);
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(failed(&folder))?;
    }
    // A lock file would need the packages themselves to be found in a registry.
    let mut package = cargo(["package", "--quiet", "--no-verify", "--allow-dirty", "--exclude-lockfile"]);
    package.args(["--target-dir", FOLDER]);
    package.args(wanted.iter().flat_map(|wanted| ["-p", &wanted.name]));
    step("making packages", package.current_dir(root))?;
    let unpacked = unpack(&folder)?;
    none_of(&unpacked.iter().flat_map(|package| missing(package)).collect::<Vec<_>>())?;
    try_as_user(root, &folder, &unpacked)
}

fn failed(path: &Path) -> impl Fn(std::io::Error) -> Failure {
    move |error| Failure::new(format!("{}: {error}", path.display()))
}

/// The package `name` and all of the workspace that it needs.
fn behind<'a>(all: &'a [Package], name: &str) -> Vec<&'a Package> {
    let mut wanted: Vec<&Package> = all.iter().filter(|package| package.name == name).collect();
    let mut next = 0;
    while next < wanted.len() {
        for dependency in wanted[next].dependencies.iter().filter(|dependency| dependency.inside) {
            let package = all.iter().find(|package| package.name == dependency.name);
            wanted.extend(package.filter(|&package| !wanted.contains(&package)));
        }
        next += 1;
    }
    wanted
}

/// What a manifest lacks of what a registry shows or needs.
fn faults(package: &Package) -> Vec<String> {
    let Package { name, description, license, readme, rust_version, .. } = package;
    let fields =
        [("description", description), ("license", license), ("readme", readme), ("rust-version", rust_version)];
    let empty = fields.iter().filter(|(_, value)| value.is_empty());
    let mut faults: Vec<String> = empty.map(|(field, _)| format!("{name}: the manifest has no {field}")).collect();
    let loose = package.dependencies.iter().filter(|dependency| dependency.versions == "*");
    faults.extend(loose.map(|dependency| format!("{name}: {} is asked for without a version", dependency.name)));
    faults
}

/// Unpacks every package, each into the folder that it brings, and names these. Files are as new as that, whatever
/// their package says: else what was built of older ones would be taken for built of these.
fn unpack(folder: &Path) -> Result<Vec<PathBuf>> {
    let packed = folder.join("package");
    let mut folders = Vec::new();
    for entry in fs::read_dir(&packed).map_err(failed(&packed))? {
        let path = entry.map_err(failed(&packed))?.path();
        if path.extension().is_some_and(|end| end == "crate") {
            step("unpacking", Command::new("tar").arg("-xzmf").arg(&path).current_dir(folder))?;
            folders.push(folder.join(path.file_stem().unwrap_or_default()));
        }
    }
    folders.sort();
    Ok(folders)
}

fn missing(package: &Path) -> Vec<String> {
    let name = package.file_name().unwrap_or_default().to_string_lossy();
    let absent = PAPERS.iter().filter(|paper| !package.join(paper).is_file());
    absent.map(|paper| format!("{name}: the package has no {paper}")).collect()
}

/// Checks a program that depends on the packages and on nothing else of this checkout.
fn try_as_user(root: &Path, folder: &Path, unpacked: &[PathBuf]) -> Result {
    let user = folder.join("user");
    let source = user.join("src");
    fs::create_dir_all(&source).map_err(failed(&source))?;
    let write = |path: PathBuf, text: &str| fs::write(&path, text).map_err(failed(&path));
    write(source.join("main.rs"), "//! Nothing: what counts is what is built for it.\n\nfn main() {}\n")?;
    write(user.join("Cargo.toml"), &manifest(unpacked))?;
    fs::copy(root.join("Cargo.lock"), user.join("Cargo.lock")).map_err(failed(&user))?;
    // The project's own target folder holds the dependencies already.
    let mut check = cargo(["check", "--release", "--quiet", "--target-dir"]);
    step("trying the packages", check.arg(root.join("target")).current_dir(&user))
}

/// The manifest of a user of the packages, with the project's release profile, so that dependencies are shared.
fn manifest(unpacked: &[PathBuf]) -> String {
    let mut text = format!(
        "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n[profile.release]\nstrip = \"symbols\"\n\n\
         [dependencies]\n{FRONT} = \"*\"\n\n[patch.crates-io]\n"
    );
    for folder in unpacked {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let name = name.split_once('-').map_or(name.as_ref(), |(name, _)| name);
        let _ = writeln!(text, "{name} = {{ path = '{}' }}", folder.display());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::metadata::Dependency;

    fn package(name: &str, inside: &[&str]) -> Package {
        let dependency = |name: &&str| Dependency { name: (*name).into(), inside: true, versions: "^0.1".into() };
        Package {
            name: name.into(),
            description: "a".into(),
            license: "b".into(),
            readme: "c".into(),
            rust_version: "1".into(),
            dependencies: inside.iter().map(dependency).collect(),
            ..Package::default()
        }
    }

    #[test]
    fn what_stands_behind_the_front_is_packaged() {
        let all = [package("top", &["front"]), package("front", &["a", "b"]), package("a", &[]), package("b", &["a"])];
        let names: Vec<&str> = behind(&all, "front").iter().map(|package| package.name.as_str()).collect();
        assert_eq!(names, ["front", "a", "b"]);
    }

    #[test]
    fn manifests_that_lack_something_are_found() {
        assert!(faults(&package("whole", &["other"])).is_empty());
        let mut poor = package("poor", &["other"]);
        poor.license.clear();
        poor.readme.clear();
        poor.dependencies[0].versions = "*".into();
        let expected = [
            "poor: the manifest has no license",
            "poor: the manifest has no readme",
            "poor: other is asked for without a version",
        ];
        assert_eq!(faults(&poor), expected);
    }

    #[test]
    fn packages_without_papers_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("a-0.1.0");
        fs::create_dir(&package).unwrap();
        fs::write(package.join("LICENSE-MIT"), "").unwrap();
        fs::write(package.join("README.md"), "").unwrap();
        assert_eq!(missing(&package), ["a-0.1.0: the package has no LICENSE-APACHE"]);
        assert!(
            manifest(std::slice::from_ref(&package)).contains(&format!("\na = {{ path = '{}' }}\n", package.display()))
        );
    }
}

//! `cargo xtask wheel`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::cargo::{root, step};
use crate::failure::{Failure, Result};
use crate::licences;
use crate::setup::{Need, PYTHON, Setup};

/// Build the package for Python, and with --test try it in an empty environment
///
/// The wheel lies in target/wheels: for Python 3.11 and newer, on every Linux since 2014 (glibc 2.17). maturin, and Zig
/// to link against so old a library, are installed from `PyPI` into target/wheel-tools. For another processor,
/// `rustup target add TRIPLE` comes first.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// The machines that the wheel is for
    #[arg(long, value_name = "TRIPLE", default_value_t = own())]
    target: String,
    /// Install the wheel into an empty environment, and run the tests of the package there
    #[arg(long)]
    test: bool,
}

/// The oldest Linux that the wheel is for, and that the compiler supports.
const COMPATIBILITY: &str = "manylinux2014";
/// Of `PyPI`, what builds, and what tests beside it.
const BUILDERS: [&str; 2] = ["maturin>=1.16,<2", "ziglang>=0.13,<0.18"];
const TESTERS: [&str; 3] = ["pytest>=7,<10", "hypothesis>=6,<7", "mypy>=1.15,<3"];
/// The packages that the tests in `crates/python/tests/peers` are about. pyrender asks for a version of `PyOpenGL` that
/// `MuJoCo` fails with, and works with newer ones.
const PEERS: [&str; 15] = [
    "trimesh",
    "pyvista",
    "meshio",
    "open3d",
    "mujoco",
    "pyrender",
    "pyglet<2",
    "pyopengl>=3.1.7",
    "dask[distributed]",
    "ray[data]",
    "pillow",
    "nbclient",
    "nbformat",
    "ipykernel",
    "ipywidgets",
];
/// The most bytes of a wheel. It has 4.97 MB, since what only passes values on, and the reference renderer, are optimised
/// for size and zip compresses as much as it can.
const MOST: u64 = 5_000_000;

const NEEDS: [Need; 1] = [PYTHON];

fn own() -> String {
    format!("{}-unknown-linux-gnu", std::env::consts::ARCH)
}

/// Builds, and tries.
pub(crate) fn run(options: &Options) -> Result {
    let wheel = built(options)?;
    if options.test { try_out(&wheel, &root().join("crates/python")) } else { Ok(()) }
}

/// Tests the package beside those of others.
pub(crate) fn beside_peers(setup: Setup) -> Result {
    let wheel = built(&Options { setup, target: own(), test: false })?;
    let tried = environment("wheel-peers", &["--force-reinstall", "--no-deps", &wheel.to_string_lossy()])?;
    let python = || Command::new(tried.join("bin/python"));
    let install = ["-m", "pip", "install", "-q", "--disable-pip-version-check"];
    step("what tests", python().args(install).args(TESTERS).arg("numpy"))?;
    for peer in PEERS {
        // One that is not there for this Python is left out by its tests, which say so.
        if let Err(failure) = step(peer, python().args(install).arg(peer)) {
            eprintln!("warning: {failure}");
        }
    }
    let tests = root().join("crates/python/tests/peers");
    step("tests", python().args(["-m", "pytest", "-q", "-rs"]).current_dir(tests))
}

/// Builds the wheel.
fn built(options: &Options) -> Result<PathBuf> {
    if !cfg!(target_os = "linux") {
        return Err(Failure::new("on other systems than Linux: maturin build --profile wheel, in crates/python"));
    }
    options.setup.meet(&NEEDS)?;
    let package = root().join("crates/python");
    let tools = environment("wheel-tools", &BUILDERS)?;
    write(&package.join("THIRD-PARTY.md"), &licences::of("halfway_python", &options.target)?)?;
    let wheels = root().join("target/wheels");
    // Of an earlier version, or for other machines.
    fs::remove_dir_all(&wheels).ok();
    let mut build = Command::new(tools.join("bin/maturin"));
    build.args(["build", "--profile", "wheel", "--zig", "--compatibility", COMPATIBILITY, "--target", &options.target]);
    build.args(["--compression-level", "9"]);
    build.arg("--out").arg(&wheels).current_dir(&package);
    // Zig is found by the environment that it is installed in.
    build.env("VIRTUAL_ENV", &tools).env("PATH", path_with(&tools.join("bin"))?);
    step("wheel", &mut build)?;
    let wheel = only_file(&wheels)?;
    let bytes = fs::metadata(&wheel).map_or(0, |file| file.len());
    println!("{}: {bytes} bytes", wheel.display());
    if bytes > MOST {
        return Err(Failure::new(format!("the wheel has {bytes} bytes; expected at most {MOST}")));
    }
    Ok(wheel)
}

/// Installs the wheel into an environment of its own, and runs the tests.
fn try_out(wheel: &Path, package: &Path) -> Result {
    fs::remove_dir_all(root().join("target/wheel-test")).ok();
    let wheel = wheel.to_string_lossy();
    let tried = environment("wheel-test", &[&*wheel])?;
    let python = || Command::new(tried.join("bin/python"));
    // All that the package needs came with it.
    let picture = "import halfway, numpy; halfway.render(numpy.eye(3), [[0, 1, 2]]).save('target/wheel-test/a.png')";
    step("a picture", python().args(["-c", picture]).current_dir(root()))?;
    step("what tests", python().args(["-m", "pip", "install", "-q"]).args(TESTERS))?;
    step("tests", python().args(["-m", "pytest", "-q", "--ignore", "peers"]).current_dir(package.join("tests")))?;
    step("types", python().args(["-m", "mypy"]).current_dir(package))
}

/// An environment of Python in the folder `target`, with packages of `PyPI`.
fn environment(name: &str, packages: &[&str]) -> Result<PathBuf> {
    let folder = root().join("target").join(name);
    if !folder.join("bin/python").is_file() {
        step("environment", Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
    }
    let mut install = Command::new(folder.join("bin/python"));
    install.args(["-m", "pip", "install", "-q", "--disable-pip-version-check"]).args(packages);
    step("packages", &mut install)?;
    Ok(folder)
}

fn path_with(folder: &Path) -> Result<std::ffi::OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_owned()).chain(std::env::split_paths(&path));
    std::env::join_paths(folders).map_err(|error| Failure::new(error.to_string()))
}

fn only_file(folder: &Path) -> Result<PathBuf> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    match files.collect::<Vec<_>>().as_slice() {
        [file] => Ok(file.clone()),
        files => Err(Failure::new(format!("{}: {} files; expected one wheel", folder.display(), files.len()))),
    }
}

fn write(file: &Path, text: &str) -> Result {
    fs::write(file, text).map_err(|error| Failure::new(format!("{}: {error}", file.display())))
}

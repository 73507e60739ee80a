//! `cargo xtask arm`.

use std::ffi::OsString;

use clap::Args;

use crate::cargo::{cargo, step};
use crate::failure::{Failure, Result};
use crate::setup::{ARM_EMULATOR, ARM_LINKER, Setup};

/// Test the rasterizer as 64-bit ARM processors run it, with NEON, under an emulator
///
/// Among its tests are ten pictures with the hashes that they have on every processor. The linker for ARM and the
/// emulator QEMU are installed first where they are missing. The compiler's library for ARM is installed by
/// `rustup target add aarch64-unknown-linux-gnu`, or RUSTC names a compiler that has it. On an ARM processor nothing is
/// emulated.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Arguments of the test program: parts of the names of tests
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

const TARGET: &str = "aarch64-unknown-linux-gnu";
/// The folder of Debian's ARM libraries for the linker and the emulator.
const LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// Sets up, builds and runs.
pub(crate) fn run(options: &Options) -> Result {
    let mut tests = cargo(["test", "--release", "-p", "halfway_raster"]);
    if !cfg!(target_arch = "aarch64") {
        if !cfg!(target_os = "linux") {
            return Err(Failure::new("ARM is emulated on Linux only"));
        }
        options.setup.meet(&[ARM_LINKER, ARM_EMULATOR])?;
        tests.args(["--target", TARGET]).envs(cross());
    }
    step("tests on ARM", tests.arg("--").args(&options.arguments))
}

/// Cargo's settings to link for ARM and to run the result.
fn cross() -> [(&'static str, String); 2] {
    [
        ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", "aarch64-linux-gnu-gcc".into()),
        ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", format!("qemu-aarch64-static -L {LIBRARIES}")),
    ]
}

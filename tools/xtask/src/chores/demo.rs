//! `cargo xtask demo`.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::display::Display;
use crate::failure::{Failure, Result};
use crate::setup::{Need, Setup, WAYLAND_WINDOWS, X11_WINDOWS};

const EXAMPLE: &str = "moving_lights";
/// Six seconds, the period of the example's lights, so that the animation loops without a jump.
const FRAMES: &str = "180";
const SIZE: &str = "640x360";

/// Show moving lights around a model in a window, or record them where there is no display
///
/// Records an animated PNG and a contact sheet in out/. Without a graphics card the CPU draws. Missing requirements of
/// windows (with a display, their libraries) are installed first, by apt-get where it may be used.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
    /// Record, even where a display is
    #[arg(long)]
    headless: bool,
    /// The model under the lights (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf); assets/teapot.obj unless given
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

/// Sets up, builds, and shows or records the moving lights.
pub(crate) fn run(options: &Options) -> Result {
    let model = options.model.as_deref().map(model).transpose()?;
    let display = Display::here().filter(|_| !options.headless);
    options.setup.meet(needs(display))?;
    step("build", &mut example("build", display))?;
    let mut command = example("run", display);
    command.args(["--quiet", "--"]);
    if let Some(model) = model {
        command.arg("--model").arg(model);
    }
    if display.is_some() { show(command) } else { record(command) }
}

/// The model's absolute path: what runs later runs in the workspace's root.
fn model(given: &Path) -> Result<PathBuf> {
    let path = std::path::absolute(given).map_err(|error| Failure::usage(format!("{}: {error}", given.display())))?;
    if path.is_file() { Ok(path) } else { Err(Failure::usage(format!("{}: there is no such file", given.display()))) }
}

fn needs(display: Option<Display>) -> &'static [Need] {
    match display {
        Some(Display::X11) => &[X11_WINDOWS],
        Some(Display::Wayland) => &[WAYLAND_WINDOWS],
        Some(Display::System) | None => &[],
    }
}

/// The cargo command that builds or runs the example: with wgpu and windows if there is a display, else with the CPU
/// renderer alone.
fn example(verb: &str, display: Option<Display>) -> Command {
    let mut command = cargo([verb, "--release", "-p", "halfway", "--example", EXAMPLE]);
    if display.is_none() {
        command.arg("--no-default-features");
    }
    command
}

fn show(mut command: Command) -> Result {
    eprintln!(
        "\nA window opens. Drag to look around; 1, 2, 3: flat, Gouraud, Phong; B: reflectance; Escape closes it."
    );
    step("moving lights", &mut command)
}

fn record(mut command: Command) -> Result {
    let folder = root().join("out");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::new(format!("{}: {error}", folder.display())))?;
    let animation = folder.join(format!("{EXAMPLE}.png"));
    let sheet = folder.join(format!("{EXAMPLE}_sheet.png"));
    eprintln!("\nNo display answers, or none was asked for: the lights are recorded.");
    command.arg("--headless").arg(&animation).arg("--contact-sheet").arg(&sheet);
    // The example prints its files' names too, but without an explanation.
    step("moving lights", command.args(["--frames", FRAMES, "--size", SIZE]).stdout(Stdio::null()))?;
    println!("animation:     {}\ncontact sheet: {}", animation.display(), sheet.display());
    eprintln!("\nWeb browsers play the animation; most picture viewers show its first frame only.");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_checked_before_the_build() {
        // Tests run in their package's folder.
        assert_eq!(model(Path::new("Cargo.toml")), Ok(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")));
        let problem = model(Path::new("no/such.obj")).unwrap_err();
        assert_eq!(problem, Failure::usage("no/such.obj: there is no such file"));
    }

    #[test]
    fn the_example_is_there() {
        assert!(root().join(format!("examples/{EXAMPLE}.rs")).is_file());
    }

    #[test]
    fn windows_need_their_libraries() {
        let rows = [(None, 0), (Some(Display::System), 0), (Some(Display::X11), 1), (Some(Display::Wayland), 1)];
        for (display, expected) in rows {
            assert_eq!(needs(display).len(), expected, "{display:?}");
        }
    }
}

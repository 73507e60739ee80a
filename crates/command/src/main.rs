//! The `halfway` command: draws scenes and models into pictures and windows, and measures them.

mod adapters;
#[cfg(feature = "measure")]
mod bench;
#[cfg(feature = "measure")]
mod chart;
mod choices;
mod compare;
mod convert;
mod demo;
mod drawing;
mod edges;
mod empty;
mod explain;
mod failure;
mod figures;
mod framing;
mod info;
mod input;
mod lines;
mod look;
mod mark;
mod picture;
mod progress;
mod reading;
mod render;
mod scalars;
#[cfg(feature = "measure")]
mod scenery;
mod steps;
mod terms;
mod thumbnail;
mod tolerance;
mod verify;
#[cfg(feature = "window")]
mod view;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Classic lighting and shading of scenes and models: flat, Gouraud and Phong, with Phong and Blinn–Phong reflectance.
#[derive(Debug, Parser)]
#[command(
    name = "halfway",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 done; 1 the graphics device \
    failed; 2 the input or the command line cannot be used; 3 the adapter that is asked for is not there; 4 pictures differ by more \
    than they may; 130 stopped by Ctrl-C or SIGTERM."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw a scene file (.json) or models (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf) into a picture
    Render(render::RenderArgs),
    /// Draw a small picture of a model for a file manager, on the CPU, within limits of time and memory
    Thumbnail(thumbnail::ThumbnailArgs),
    /// Show a scene or a model in a window
    ///
    /// Left drag turns, right drag pans, the wheel zooms, Home resets; 1, 2, 3 choose flat, Gouraud and Phong shading,
    /// T the steps of the tolerance, B the reflectance, I the intensity policy; Escape or Q closes.
    #[cfg(feature = "window")]
    View(view::ViewArgs),
    /// Measure the difference between two pictures, and draw it
    ///
    /// Figures are of the errors of A, with B as expected, on the pixels that both cover. Exit code 4 if a pixel
    /// differs by more than --max allows.
    Compare(compare::CompareArgs),
    /// Draw a scene with the adapter and with the reference renderer, and judge the one by the other
    ///
    /// Pixels on edges, where rounding decides which side is visible, are judged separately. Exit code 4 if another
    /// differs by more than --max allows.
    Verify(verify::VerifyArgs),
    /// Mark a picture that somebody drew of a scene, and find the mistake that explains how it differs
    ///
    /// It passes or differs as by verify --picture. Where it differs the scene is drawn with each of a list of mistakes,
    /// such as normals that are not normalised, and with two at once; those are named that explain the difference, the
    /// best first, with where they do. A rubric says how many points they take away. Exit code 4 if the picture differs.
    Mark(mark::MarkArgs),
    /// Explain a pixel: its surfaces, every light and term there, their sum, its clamping and encoding, in 64-bit arithmetic
    ///
    /// The numbers are those of the reference renderer as it draws the pixel. Vectors are in eye space.
    Explain(explain::ExplainArgs),
    /// Draw each term of each light by itself, and their sums, on one sheet with captions
    ///
    /// A row a light with its ambient, diffuse and specular term and their sum; a row without lights: the global ambient
    /// light with an environment's, emission with the background, and what an environment mirrors; a row of sums.
    Terms(terms::TermsArgs),
    /// Print the contents of models, and their problems
    Info(info::InfoArgs),
    /// Write a model in another format, mended, refined, simplified or with other normals; print what is lost
    ///
    /// The steps asked for are taken in the order in which their options are listed here, on each mesh by itself.
    /// Lengths are in the units of the file's meshes, before a glTF node scales them.
    Convert(convert::ConvertArgs),
    /// Time a benchmark scene in every shading, relative to a constant colour; or the cost of features
    #[cfg(feature = "measure")]
    Bench(bench::BenchArgs),
    /// Chart error against time of every method on a scene, with a recommendation; or of all scenes of the project's
    ///
    /// Writes a page that opens offline, index.html, and beside it chart.json and drawings. Each file appears only when
    /// it is complete.
    #[cfg(feature = "measure")]
    Chart(chart::ChartArgs),
    /// Show an example that comes with the command, in a window or, with -o FILE, as a picture; without a name, list all
    Demo(demo::DemoArgs),
    /// List the renderers, graphics adapters and the CPU, the default first
    Adapters,
    /// Print the JSON schema of scene files
    Schema,
}

/// By default, Rust programs continue when their output is closed, until printing panics. With the signal's default
/// action, `halfway info … | head` ends quietly.
#[cfg_attr(unix, expect(unsafe_code, reason = "a signal's default action is set, and no handler that could race"))]
fn restore_sigpipe() {
    #[cfg(unix)]
    // SAFETY: both arguments are constants that `signal` documents, and the default action runs no code of this
    // process.
    unsafe {
        libc::signal(libc::SIGPIPE, libc::SIG_DFL);
    }
}

fn main() -> ExitCode {
    let command = Cli::parse().command;
    // A window's connection to its display must not end the process.
    #[cfg(feature = "window")]
    let has_window = match &command {
        Command::View(_) => true,
        Command::Demo(args) => args.has_window(),
        _ => false,
    };
    #[cfg(not(feature = "window"))]
    let has_window = false;
    // The commands print errors of frames themselves, and why a picture is empty.
    let empty = if has_window { "" } else { ",halfway_render::empty=off" };
    let filter = format!("warn,wgpu_hal=off,egui_wgpu=error,halfway_render::errors=off{empty}");
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or(filter))
        .format(|line, record| writeln!(line, "{}: {}", record.level().as_str().to_lowercase(), record.args()))
        .init();
    if !has_window {
        restore_sigpipe();
    }
    let result = match command {
        Command::Render(args) => render::run(&args),
        Command::Thumbnail(args) => thumbnail::run(&args),
        #[cfg(feature = "window")]
        Command::View(args) => view::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Mark(args) => mark::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Terms(args) => terms::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Convert(args) => convert::run(&args),
        #[cfg(feature = "measure")]
        Command::Bench(args) => bench::run(&args),
        #[cfg(feature = "measure")]
        Command::Chart(args) => chart::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Adapters => adapters::run(),
        Command::Schema => {
            print!("{}", halfway::scene::json_schema());
            Ok(())
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { code, error }) => {
            if let Some(error) = error {
                eprintln!("error: {error}");
            }
            ExitCode::from(code)
        }
    }
}

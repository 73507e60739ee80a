//! The command line and what its subcommands share.

mod adapters;
mod bench;
mod compare;
mod convert;
mod figures;
mod info;
mod input;
mod levels;
mod picture;
mod progress;
mod render;
mod steps;
mod verify;
#[cfg(feature = "window")]
mod view;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Classic lighting and shading of scenes and models: flat, Gouraud and Phong, with Phong and Blinn–Phong reflectance.
#[derive(Debug, Parser)]
#[command(
    name = "halfway",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 done; 1 the graphics device \
    failed; 2 the input or the command line cannot be used; 3 there is no graphics adapter; 4 pictures differ by more than they \
    may; 130 stopped by Ctrl-C."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw a scene file (.json) or a model (.smf, .obj, .gltf, .glb, .ply, .stl) into a picture
    Render(render::RenderArgs),
    /// Show a scene or a model in a window
    ///
    /// Left drag turns, right drag pans, the wheel zooms; 1, 2, 3 switch flat, Gouraud and Phong, B the reflectance,
    /// Home resets, Escape closes.
    #[cfg(feature = "window")]
    View(view::ViewArgs),
    /// Say how far one picture is from another, and draw where
    ///
    /// Figures are of the errors of A, with B as what is expected, on the pixels that both cover. Exit code 4 where a pixel
    /// differs by more than --max allows.
    Compare(compare::CompareArgs),
    /// Draw a scene with the graphics adapter and with the reference renderer, and judge the one by the other
    ///
    /// Pixels on edges, where rounding decides which side is seen, are told apart. Exit code 4 where another differs by
    /// more than --max allows.
    Verify(verify::VerifyArgs),
    /// Print what a model holds, and what is wrong with it
    Info(info::InfoArgs),
    /// Write a model in another format, mended, refined, simplified or with other normals; print what is lost
    ///
    /// The steps asked for are taken in the order in which their options are listed here, on each mesh by itself. Lengths
    /// are in the units of the file's meshes, before a glTF node scales them.
    Convert(convert::ConvertArgs),
    /// Time a benchmark scene in every shading, beside a constant colour; or what features cost
    Bench(bench::BenchArgs),
    /// List the graphics adapters; exit code 3 where there is none
    Adapters,
    /// Print the JSON schema of scene files
    Schema,
}

/// How the scene is drawn; what is given here wins over the scene file.
#[derive(Args, Clone, Debug)]
struct LookArgs {
    /// A scene file (.json) or a model (.smf, .obj, .gltf, .glb, .ply, .stl)
    #[arg(value_name = "SCENE|MODEL")]
    input: PathBuf,
    /// How often surfaces are shaded [default: the scene's; phong for a model]
    #[arg(long, value_enum)]
    shading: Option<ShadingArg>,
    /// How surfaces reflect [default: the scene's; blinn-phong for a model]
    #[arg(long, value_enum)]
    reflectance: Option<ReflectanceArg>,
    /// Coverage samples a pixel: 1, or 4 for smooth edges [default: the scene's; 1 for a model]
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(["1", "4"]))]
    samples: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ShadingArg {
    /// Once a triangle
    Flat,
    /// Once a vertex
    Gouraud,
    /// Once a pixel
    Phong,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ReflectanceArg {
    /// (v·r)^α
    Phong,
    /// (n·h)^β, β the shininess as it is
    BlinnPhong,
    /// (n·h)^β, β matched to the α that the shininess means
    BlinnPhongMatched,
}

/// Why a command failed, and the exit code that says so.
#[derive(Debug)]
struct Failure {
    code: u8,
    error: Box<dyn Error>,
}

/// The exit code of pictures that differ by more than they may.
const DIFFERENT: u8 = 4;
/// The exit code of work that Ctrl-C stopped, as shells have it.
const STOPPED: u8 = 130;

impl Failure {
    fn new(code: u8, error: impl Into<Box<dyn Error>>) -> Self {
        Self { code, error: error.into() }
    }
}

/// Input that cannot be used is exit code 2.
macro_rules! bad_input {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::new(2, error)
            }
        })*
    };
}
bad_input!(
    halfway::scene::SceneError,
    halfway::mesh::LoadError,
    halfway::mesh::WriteError,
    halfway::output::OutputError,
    halfway::reference::OracleError,
    String
);

impl From<halfway::render::RenderError> for Failure {
    fn from(error: halfway::render::RenderError) -> Self {
        use halfway::render::RenderError as E;
        let code = match error {
            E::NoAdapter | E::NoDevice { .. } => 3,
            E::Device(_) => 1,
            _ => 2,
        };
        Self::new(code, error)
    }
}

impl From<halfway::record::RecordError> for Failure {
    fn from(error: halfway::record::RecordError) -> Self {
        use halfway::record::RecordError as E;
        match error {
            E::Render(error) => error.into(),
            E::Stopped(_) => Self::new(STOPPED, error),
            other => Self::new(2, other),
        }
    }
}

/// Rust programs go on when nobody reads their output any more, until printing panics. With the system's own way back,
/// `halfway info … | head` ends quietly.
#[cfg_attr(unix, expect(unsafe_code, reason = "a signal's default action is set, and no handler that could race"))]
fn end_with_the_reader() {
    #[cfg(unix)]
    // SAFETY: both arguments are constants that `signal` documents, and the default action runs no code of this process.
    unsafe {
        libc::signal(libc::SIGPIPE, libc::SIG_DFL);
    }
}

pub(crate) fn main() -> ExitCode {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("warn,wgpu_hal=off"))
        .format_timestamp(None)
        .init();
    let command = Cli::parse().command;
    // A window's connection to its display must not end it so.
    #[cfg(feature = "window")]
    let has_window = matches!(command, Command::View(_));
    #[cfg(not(feature = "window"))]
    let has_window = false;
    if !has_window {
        end_with_the_reader();
    }
    let result = match command {
        Command::Render(args) => render::run(&args),
        #[cfg(feature = "window")]
        Command::View(args) => view::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Adapters => adapters::run(),
        Command::Schema => {
            print!("{}", halfway::scene::json_schema());
            Ok(())
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { code, error }) => {
            eprintln!("error: {error}");
            ExitCode::from(code)
        }
    }
}

//! `halfway thumbnail`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use halfway::output::{to_bytes, write_bytes};
use halfway::prelude::*;
use halfway::render::AdapterChoice;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::failure::Failure;
use crate::input::SceneInput;
use crate::reading::STANDARD;

#[derive(Args, Debug)]
pub(crate) struct ThumbnailArgs {
    /// A model (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf)
    model: PathBuf,
    /// The picture, a PNG whatever its name ends in; - writes to standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=2048))]
    size: u32,
    /// The most megabytes (10^6 bytes) of the model and of each file it refers to; memory is limited to eight times as
    /// much and 256 MB
    #[arg(long, value_name = "MB", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    limit: u64,
}

const MEGABYTE: u64 = 1_000_000;
/// The most seconds of processor time.
const SECONDS: u64 = 10;

pub(crate) fn run(args: &ThumbnailArgs) -> Result<(), Failure> {
    limit_process(8 * args.limit * MEGABYTE + 256 * MEGABYTE);
    let mut input = SceneInput::open_model(&args.model, args.limit * MEGABYTE)?;
    let size = UVec2::splat(args.size);
    input.scene.size = size.to_array();
    input.scene.samples = 4;
    // Sides that are not seen are cheaper to draw than to find out.
    input.scene.objects.iter_mut().for_each(|object| object.faces = Some(Faces::Both));
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size)).insert_resource(AdapterChoice::cpu());
    input.spawn_once(&mut app)?;
    let picture = render_picture(&mut app)?;
    // The system takes everything back sooner.
    std::mem::forget(app);
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", args.output.display());
    // Small pictures are read more often than they are kept: encoding takes a tenth of the time, and twice the bytes.
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
    let written = to_bytes(&picture, Encoding::Srgb).write_with_encoder(encoder);
    written.map_err(|error| failed(&error))?;
    if args.output == Path::new(STANDARD) {
        std::io::stdout().lock().write_all(&bytes).map_err(|error| failed(&error))?;
    } else {
        write_bytes(&args.output, &bytes)?;
    }
    Ok(())
}

/// Ends the process where it takes more memory than so many bytes, or more time than [`SECONDS`]: a file manager shows
/// many files, and any of them may be made to harm.
#[cfg_attr(
    target_os = "linux",
    expect(unsafe_code, reason = "the limits of the process are set, before it has threads")
)]
fn limit_process(memory: u64) {
    #[cfg(target_os = "linux")]
    for (resource, most) in [(libc::RLIMIT_DATA, memory), (libc::RLIMIT_CPU, SECONDS)] {
        let limit = libc::rlimit { rlim_cur: most, rlim_max: most };
        // SAFETY: the limit lives during the call, which reads it. A refusal, where a stricter limit holds already, is
        // as good.
        unsafe {
            libc::setrlimit(resource, &raw const limit);
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (memory, SECONDS);
}

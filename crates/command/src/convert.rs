//! `halfway convert`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use halfway::mesh::{LoadError, Model, Normals, Subdivision, Weld, load_with, write, write_ascii, write_quantised};
use halfway::scene::options::parse;

use crate::failure::{Failure, STOPPED};
use crate::progress::Progress;
use crate::reading::{ReadingArgs, STANDARD};
use crate::steps::Meshes;

#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// A model (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf); - reads one from standard input, of --format
    input: PathBuf,
    /// The file to write (.smf, .obj, .glb, .gltf, .ply, .stl); .obj brings an .mtl of the same name where there are
    /// materials, .gltf a .bin, and both the images; - writes to standard output, of --format (of both, the second:
    /// --format stl,glb)
    output: PathBuf,
    #[command(flatten)]
    reading: ReadingArgs,
    /// Merge vertices that are equal in everything; with a DISTANCE those no further apart, whatever their attributes
    #[arg(long, value_name = "DISTANCE", num_args = 0..=1, require_equals = true, default_missing_value = EQUAL)]
    #[arg(value_parser = parse_weld)]
    weld: Option<Weld>,
    /// Drop degenerate and duplicate triangles and unused vertices; orient the others consistently, closed pieces
    /// outward
    #[arg(long)]
    repair: bool,
    /// Cut each triangle into four, N times over: in place, or to the smooth surface of Loop
    #[arg(long, value_name = "midpoint=N|loop=N", value_parser = parse_subdivision)]
    subdivide: Option<(Subdivision, u32)>,
    /// Collapse edges until about N triangles are left, shared among the parts by their number
    #[arg(long, value_name = "TRIANGLES")]
    simplify: Option<usize>,
    /// Collapse edges as far as no point is further off than this; with --simplify whichever ends first
    #[arg(long, value_name = "LENGTH", value_parser = parse_length)]
    max_error: Option<f64>,
    /// Make new normals: one a face, a mean by these weights, or a mean that stops where faces differ by more degrees
    #[arg(long, value_name = "auto|keep|face|uniform|area|angle|max|creased=DEGREES", value_parser = parse::normals)]
    normals: Option<Normals>,
    /// Write vertices as integers of 16 bits, which makes large meshes about 40 % smaller; .glb only
    #[arg(long)]
    quantise: bool,
    /// Write in ASCII; .ply only, which is binary without it
    #[arg(long, conflicts_with = "quantise")]
    ascii: bool,
}

pub(crate) fn run(args: &ConvertArgs) -> Result<(), Failure> {
    args.reading.without_picture()?;
    let from_standard = args.input == Path::new(STANDARD);
    let to_standard = args.output == Path::new(STANDARD);
    // Messages do not mix with the written model.
    let say: fn(String) = if to_standard { |line| eprintln!("{line}") } else { |line| println!("{line}") };
    let formats = args.reading.model_formats();
    let of_output = formats.last().filter(|_| to_standard);
    let of_input = formats.first().filter(|_| from_standard || !to_standard || formats.len() > 1);
    let mut model = if from_standard {
        args.reading.load(&args.input)?
    } else {
        let progress = Progress::for_bytes();
        let options = args.reading.options(of_input.copied());
        load_with(&args.input, options, &mut |at| progress.bytes(at.done, at.of)).map_err(|error| match error {
            LoadError::Stopped { .. } => Failure::new(STOPPED, error),
            _ => error.into(),
        })?
    };
    for warning in &model.warnings {
        say(format!("warning    {warning}"));
    }
    change(args, &mut model, say)?;
    let folder = if to_standard { Some(Folder::new()?) } else { None };
    let output = match (&folder, of_output) {
        (None, _) => args.output.clone(),
        (Some(folder), Some(format)) => folder.0.join("model").with_extension(format.extension()),
        (Some(_), None) => {
            return Err("standard output: the format is not known; expected --format smf, obj, glb, ply or stl"
                .to_owned()
                .into());
        }
    };
    let mut lost = if args.quantise {
        let (moved, lost) = write_quantised(&output, &model)?;
        say(format!("quantise   positions moved by at most {moved:.3e}"));
        lost
    } else if args.ascii {
        write_ascii(&output, &model)?
    } else {
        write(&output, &model)?
    };
    if to_standard {
        let failed = |error: std::io::Error| format!("standard output: {error}");
        let bytes = std::fs::read(&output).map_err(failed)?;
        std::io::stdout().lock().write_all(&bytes).map_err(failed)?;
        if output.with_extension("mtl").exists() {
            lost.push("materials: their file has no place beside standard output".to_owned());
        }
        if output.with_extension("bin").exists() {
            return Err("standard output: .gltf has files beside it; expected --format glb".to_owned().into());
        }
    }
    for lost in &lost {
        say(format!("lost       {lost}"));
    }
    let of_lines = model.lines.iter().map(|part| part.lines.positions().len());
    let vertices: usize = model.parts.iter().map(|part| part.mesh.positions().len()).chain(of_lines).sum();
    let (parts, triangles) = (model.parts.len(), model.triangle_count());
    let name = if to_standard { "standard output".to_owned() } else { args.output.display().to_string() };
    let counts = [(model.line_count(), "lines"), (model.point_count(), "points")];
    let counts = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!(", {count} {what}"));
    let more: String = counts.collect();
    say(format!("{name}: {parts} parts, {triangles} triangles, {vertices} vertices{more}"));
    Ok(())
}

/// A folder of its own for what goes to standard output, since writers replace whole files. It is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, Failure> {
        let folder = std::env::temp_dir().join(format!("halfway-convert-{}", std::process::id()));
        std::fs::create_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self(folder))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Takes the chosen steps, in the order of their options.
fn change(args: &ConvertArgs, model: &mut Model, say: fn(String)) -> Result<(), Failure> {
    let mut meshes = Meshes::from_model(model, say);
    if let Some(weld) = args.weld {
        meshes.weld(weld);
    }
    if args.repair {
        meshes.repair();
    }
    if let Some((scheme, times)) = args.subdivide {
        meshes.subdivide(scheme, times).map_err(|error| format!("{}: {error}", args.input.display()))?;
    }
    if args.simplify.is_some() || args.max_error.is_some() {
        meshes.simplify(args.simplify.unwrap_or(0), args.max_error.unwrap_or(f64::INFINITY));
    }
    if let Some(normals) = args.normals {
        meshes.make_normals(normals);
    }
    meshes.put_into(model);
    if model.is_empty() {
        return Err(format!("{}: no triangle is left of any part", args.input.display()).into());
    }
    Ok(())
}

/// The value of `--weld` without a distance.
const EQUAL: &str = "equal";

fn parse_weld(text: &str) -> Result<Weld, String> {
    if text == EQUAL {
        return Ok(Weld::default());
    }
    Ok(Weld::positions(parse_length(text)? as f32))
}

fn parse_length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length| (0.0..=f64::from(f32::MAX)).contains(length));
    length.ok_or_else(|| "expected a finite length, not below 0".into())
}

fn parse_subdivision(text: &str) -> Result<(Subdivision, u32), String> {
    let expected = || "expected midpoint=N or loop=N".to_owned();
    let (scheme, times) = text.split_once('=').ok_or_else(expected)?;
    let scheme = match scheme {
        "midpoint" => Subdivision::Midpoint,
        "loop" => Subdivision::Loop,
        _ => return Err(expected()),
    };
    Ok((scheme, times.parse().map_err(|_| expected())?))
}

//! `halfway convert`.

use std::path::PathBuf;

use clap::Args;
use halfway::mesh::{LoadError, LoadOptions, Model, Normals, Subdivision, Weld, load_with, write, write_quantised};

use crate::failure::{Failure, STOPPED};
use crate::look::parse_normals;
use crate::progress::Progress;
use crate::steps::Meshes;

#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// A model (.smf, .obj, .gltf, .glb, .ply, .stl)
    input: PathBuf,
    /// The file to write (.smf, .obj, .glb); .obj brings an .mtl of the same name where there are materials
    output: PathBuf,
    /// Read files that the model refers to outside its own folder, too
    #[arg(long)]
    outside: bool,
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
    #[arg(long, value_name = "auto|keep|face|uniform|area|angle|max|creased=DEGREES", value_parser = parse_normals)]
    normals: Option<Normals>,
    /// Write vertices as integers of 16 bits, which makes large meshes about 40 % smaller; .glb only
    #[arg(long)]
    quantise: bool,
}

pub(crate) fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let progress = Progress::for_bytes();
    let options = LoadOptions { outside: args.outside, ..LoadOptions::default() };
    let mut model =
        load_with(&args.input, options, &mut |at| progress.bytes(at.done, at.of)).map_err(|error| match error {
            LoadError::Stopped { .. } => Failure::new(STOPPED, error),
            _ => error.into(),
        })?;
    drop(progress);
    for warning in &model.warnings {
        println!("warning    {warning}");
    }
    change(args, &mut model)?;
    let lost = if args.quantise {
        let (moved, lost) = write_quantised(&args.output, &model)?;
        println!("quantise   positions moved by at most {moved:.3e}");
        lost
    } else {
        write(&args.output, &model)?
    };
    for lost in &lost {
        println!("lost       {lost}");
    }
    let of_lines = model.lines.iter().map(|part| part.lines.positions().len());
    let vertices: usize = model.parts.iter().map(|part| part.mesh.positions().len()).chain(of_lines).sum();
    let (parts, triangles) = (model.parts.len(), model.triangle_count());
    let counts = [(model.line_count(), "lines"), (model.point_count(), "points")];
    let counts = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!(", {count} {what}"));
    let more: String = counts.collect();
    println!("{}: {parts} parts, {triangles} triangles, {vertices} vertices{more}", args.output.display());
    Ok(())
}

/// Takes the chosen steps, in the order of their options.
fn change(args: &ConvertArgs, model: &mut Model) -> Result<(), Failure> {
    let mut meshes = Meshes::from_model(model);
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

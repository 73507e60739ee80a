//! `halfway convert`.

use std::path::PathBuf;

use clap::Args;
use halfway::mesh::{LoadError, LoadOptions, load_with, write};

use super::progress::Progress;
use super::{Failure, STOPPED};

#[derive(Args, Debug)]
pub(super) struct ConvertArgs {
    /// A model (.smf, .obj, .gltf, .glb, .ply, .stl)
    input: PathBuf,
    /// The file to write (.smf, .obj, .glb); .obj brings an .mtl of the same name where there are materials
    output: PathBuf,
    /// Read files that the model refers to outside its own folder, too
    #[arg(long)]
    outside: bool,
}

pub(super) fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let progress = Progress::of_bytes();
    let options = LoadOptions { outside: args.outside };
    let model =
        load_with(&args.input, options, &mut |at| progress.bytes(at.done, at.of)).map_err(|error| match error {
            LoadError::Stopped { .. } => Failure::new(STOPPED, error),
            _ => error.into(),
        })?;
    drop(progress);
    let lost = write(&args.output, &model)?;
    println!("{}: {} parts, {} triangles", args.output.display(), model.parts.len(), model.triangle_count());
    for warning in &model.warnings {
        println!("warning    {warning}");
    }
    for lost in &lost {
        println!("lost       {lost}");
    }
    Ok(())
}

//! The parts of the time from a model file to its first picture.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use halfway::mesh::{Mesh, MeshError, Model, load};
use halfway::prelude::*;
use halfway_chart::timing::median;
use serde_json::{Map, json};

use super::args::BenchArgs;
use super::own_process::peak_kb;
use crate::failure::Failure;
use crate::input::SceneInput;

pub(super) fn run(args: &BenchArgs, file: &Path) -> Result<(), Failure> {
    args.expect_no_scene("load")?;
    let begun = Instant::now();
    first_picture(args, file)?;
    let (whole, peak_mb) = (begun.elapsed(), peak_kb() as f64 / 1024.0);
    let read = || std::fs::read(file).map_err(|error| Failure::new(1, format!("{}: {error}", file.display())));
    let model = load(file)?;
    let meshes: Vec<&Mesh> = model.parts.iter().map(|part| &part.mesh).collect();
    let bytes = read()?.len();
    let mut parts: Vec<(&str, Duration)> = vec![("first picture, with all before it", whole)];
    let mut time = |name, work: &mut dyn FnMut() -> Result<(), Failure>| -> Result<(), Failure> {
        let mut times = Vec::new();
        for _ in 0..args.rounds.min(MOST_ROUNDS) {
            let begun = Instant::now();
            work()?;
            times.push(begun.elapsed().as_secs_f64());
        }
        parts.push((name, Duration::from_secs_f64(median(&times))));
        Ok(())
    };
    time("bytes read", &mut || read().map(|bytes| drop(black_box(bytes))))?;
    time("model loaded, with bytes, meshes and normals", &mut || {
        black_box(load(file)?);
        Ok(())
    })?;
    time("meshes of it checked", &mut || made(&meshes, true))?;
    time("the same, vertices numbered and normals computed", &mut || made(&meshes, false))?;
    time("patches cut, which one picture does without", &mut || {
        for mesh in &meshes {
            let mut triangles: Vec<_> = mesh.triangles().collect();
            black_box(mesh.cut_into_patches(&mut triangles, mesh.triangles_of_a_patch()));
        }
        Ok(())
    })?;
    print(args, &model, bytes, &parts, peak_mb);
    Ok(())
}

/// Large models would take minutes otherwise.
const MOST_ROUNDS: u32 = 5;

fn first_picture(args: &BenchArgs, file: &Path) -> Result<(), Failure> {
    let mut input = SceneInput::open(file)?;
    let size = input.resize(args.size);
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size));
    args.adapter.choice().open()?.insert_into(app.world_mut());
    input.spawn_once(&mut app)?;
    black_box(render_picture(&mut app)?);
    Ok(())
}

/// Makes the meshes anew, from their lists.
fn made(meshes: &[&Mesh], with_normals: bool) -> Result<(), Failure> {
    let refused = |error: MeshError| Failure::new(1, error);
    for mesh in meshes {
        let normals = with_normals.then(|| mesh.normals().to_vec());
        let made = Mesh::from_parts(mesh.positions().to_vec(), normals, None, mesh.indices().to_vec());
        black_box(made.map_err(refused)?);
    }
    Ok(())
}

fn print(args: &BenchArgs, model: &Model, bytes: usize, parts: &[(&str, Duration)], peak_mb: f64) {
    let triangles = model.triangle_count();
    if args.json {
        let ms = |(name, time): &(&str, Duration)| ((*name).to_owned(), json!(time.as_secs_f64() * 1e3));
        let parts: Map<_, _> = parts.iter().map(ms).collect();
        println!("{}", json!({ "triangles": triangles, "bytes": bytes, "ms": parts, "peak_mb": peak_mb }));
        return;
    }
    println!("{triangles} triangles, {bytes} bytes\n\n| part | ms |\n|---|--:|");
    for (name, time) in parts {
        println!("| {name} | {:.1} |", time.as_secs_f64() * 1e3);
    }
    println!("\npeak memory at the first picture: {peak_mb:.0} MB");
}

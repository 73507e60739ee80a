//! Times the readers against `tobj` and `gltf` alone, and counts the memory that they take:
//! `cargo run --release -p halfway_mesh --example load_speed [TRIANGLES]`.
//!
//! A bumpy grid is written as OBJ, GLB and SMF. Each pair of readers takes turns, and of each the fastest run counts,
//! so that other work on the machine weighs on both alike. The figure of memory is the most that was taken while
//! loading, over the bytes of the meshes that come out; a system that reads a file adds its own buffers.

#[path = "../tests/common/counting.rs"]
mod counting;

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use counting::Counting;
use glam::{Mat4, Vec2, Vec3};
use gltf::mesh::util::{ReadIndices, ReadTexCoords};
use halfway_mesh::{Mesh, Model, Part, load, write};

#[global_allocator]
static ALLOCATOR: Counting = Counting::new();

const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let triangles: u32 = std::env::args().nth(1).map_or(Ok(1_000_000), |text| text.parse())?;
    let side = (triangles / 2).isqrt().max(1);
    let folder = std::env::temp_dir().join(format!("halfway-load-speed-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let measured = measure(&folder, side);
    std::fs::remove_dir_all(&folder)?;
    measured
}

fn measure(folder: &Path, side: u32) -> Result<(), Box<dyn std::error::Error>> {
    let model = grid(side);
    println!("{} triangles, fastest of {RUNS} runs each", model.triangle_count());
    let [obj, glb, smf, bare, bare_smf] =
        ["grid.obj", "grid.glb", "grid.smf", "bare.obj", "bare.smf"].map(|name| folder.join(name));
    for path in [&obj, &glb, &smf] {
        write(path, &model)?;
    }
    // Positions and faces alone, which are the same in both formats.
    let text = std::fs::read_to_string(&obj)?;
    let lines = text.lines().filter(|line| line.starts_with("v ") || line.starts_with('f'));
    let plain: String = lines.map(|line| plain_face(line) + "\n").collect();
    std::fs::write(&bare, &plain)?;
    std::fs::write(&bare_smf, plain)?;
    drop(text);

    let tobj = |path: &Path, options: &tobj::LoadOptions| tobj::load_obj(path, options).expect("tobj reads it");
    let with_polygons = tobj::LoadOptions { ignore_lines: true, ignore_points: true, ..tobj::LoadOptions::default() };
    for path in [&obj, &bare] {
        pair("tobj", path, || drop(black_box(tobj(path, &tobj::GPU_LOAD_OPTIONS))))?;
        // As decision 0012 would have it: a scan before `tobj` for the features that it lacks.
        pair("a scan and tobj", path, || {
            black_box(scan(&std::fs::read(path).expect("it is there")));
            drop(black_box(tobj(path, &with_polygons)));
        })?;
    }
    pair("gltf", &glb, || {
        let bytes = std::fs::read(&glb).expect("it is there");
        let file = gltf::Gltf::from_slice(&bytes).expect("gltf reads it");
        let blob = file.blob.as_deref();
        for primitive in file.meshes().flat_map(|mesh| mesh.primitives()) {
            let reader = primitive.reader(|_| blob);
            let positions: Vec<[f32; 3]> = reader.read_positions().into_iter().flatten().collect();
            let normals: Vec<[f32; 3]> = reader.read_normals().into_iter().flatten().collect();
            let uvs: Vec<[f32; 2]> = reader.read_tex_coords(0).into_iter().flat_map(ReadTexCoords::into_f32).collect();
            let indices: Vec<u32> = reader.read_indices().into_iter().flat_map(ReadIndices::into_u32).collect();
            black_box((positions, normals, uvs, indices));
        }
    })?;
    let per_byte = |path: &Path| -> Result<f64, Box<dyn std::error::Error>> {
        let fastest = (0..RUNS).map(|_| timed(|| drop(black_box(load(path))))).min().unwrap_or_default();
        Ok(fastest.as_secs_f64() / std::fs::metadata(path)?.len() as f64 * 1e9)
    };
    for path in [&obj, &smf, &bare, &bare_smf] {
        println!("{}: {:.2} ns a byte", name(path), per_byte(path)?);
    }
    for path in [&obj, &bare, &glb, &smf] {
        let (loaded, peak) = ALLOCATOR.peak_of(|| load(path));
        let size: usize = loaded?.parts.iter().map(|part| size_of_mesh(&part.mesh)).sum();
        println!("{}: at most {:.2} times the mesh of {} MiB", name(path), peak as f64 / size as f64, size >> 20);
    }
    Ok(())
}

/// The least that a scan must find: the smoothing group of each face, and text that is not UTF-8.
fn scan(bytes: &[u8]) -> (Vec<u32>, bool) {
    let (mut groups, mut group) = (Vec::new(), 0);
    for line in bytes.split(|&byte| byte == b'\n') {
        match line.trim_ascii_start() {
            [b'f', b' ' | b'\t', ..] => groups.push(group),
            [b's', b' ' | b'\t', rest @ ..] => {
                group = str::from_utf8(rest.trim_ascii()).ok().and_then(|word| word.parse().ok()).unwrap_or(0);
            }
            _ => {}
        }
    }
    (groups, str::from_utf8(bytes).is_ok())
}

fn pair(other: &str, path: &Path, mut theirs: impl FnMut()) -> Result<(), Box<dyn std::error::Error>> {
    let (mut fastest, mut fastest_of_theirs) = (Duration::MAX, Duration::MAX);
    load(path)?;
    for _ in 0..RUNS {
        fastest = fastest.min(timed(|| drop(black_box(load(path)))));
        fastest_of_theirs = fastest_of_theirs.min(timed(&mut theirs));
    }
    let ratio = fastest.as_secs_f64() / fastest_of_theirs.as_secs_f64();
    println!("{}: {fastest:.1?}, {other} alone {fastest_of_theirs:.1?}, ratio {ratio:.2}", name(path));
    Ok(())
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

fn name(path: &Path) -> std::borrow::Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}

fn plain_face(line: &str) -> String {
    line.split(' ').map(|word| word.split('/').next().unwrap_or(word)).collect::<Vec<_>>().join(" ")
}

fn size_of_mesh(mesh: &Mesh) -> usize {
    let vertex = 24 + if mesh.uvs().is_some() { 8 } else { 0 };
    mesh.positions().len() * vertex + mesh.indices().len() * 4
}

/// A square of bumps, of `side` by `side` cells.
fn grid(side: u32) -> Model {
    let step = 1.0 / side as f32;
    let vertices = (0..=side).flat_map(|j| (0..=side).map(move |i| Vec2::new(i as f32 * step, j as f32 * step)));
    let uvs: Vec<Vec2> = vertices.collect();
    let positions = uvs.iter().map(|uv| Vec3::new(uv.x, 0.05 * (40.0 * uv.x).sin() * (30.0 * uv.y).cos(), -uv.y));
    let row = side + 1;
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| j * row + i));
    let indices = cells.flat_map(|a| [a, a + 1, a + row + 1, a, a + row + 1, a + row]).collect();
    let mesh = Mesh::from_parts(positions.collect(), None, Some(uvs), indices).expect("a grid is a mesh");
    let part = Part { name: String::new(), mesh, material: None, world_from_part: Mat4::IDENTITY };
    Model { parts: vec![part], ..Model::default() }
}

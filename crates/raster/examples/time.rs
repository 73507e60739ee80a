//! Times scenes S1, S2 and S4, and a model, by shading, SIMD level and threads, in milliseconds a frame: with one
//! thread the mean CPU time (on Linux, so that a busy machine disturbs less), with two the shortest wall time.
//!
//! `cargo run --release -p halfway_raster --example time [FRAMES [FOLDER]]`; pictures go into the folder, unless it is
//! `-`. `ONLY` selects rows by words of their lines, such as `ONLY="S1 avx2 1"`, and shadings by name, as in `ONLY="S1
//! avx2 1 Phong"`. `MODEL` is the path of a model to draw as well, large and small.

mod common;

use common::{Scene, Shading, draw, lens, pieces, sphere};
use halfway_lighting::Samples;
use halfway_lighting::record::InstanceRecord;
use halfway_mesh::{Mesh, UvSphere};
use halfway_raster::{ClearTiles, Output, RasterError, RasterOptions, Rasterizer, TriangleOrder, VectorWidth};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let frames: u32 = arguments.next().map_or(Ok(200), |argument| argument.parse())?;
    let folder = arguments.next().filter(|folder| folder != "-");
    let only = std::env::var("ONLY").unwrap_or_default();
    let named = |shading: &Shading| only.split_whitespace().any(|word| word == format!("{shading:?}"));
    let mut shadings: Vec<_> = Shading::ALL.into_iter().filter(named).collect();
    let only: Vec<_> =
        only.split_whitespace().filter(|word| !Shading::ALL.iter().any(|s| format!("{s:?}") == **word)).collect();
    if shadings.is_empty() {
        shadings.extend(Shading::ALL);
    }
    println!("{:12}{:>8}{:>8} {shadings:?}", "scene", "width", "threads");
    let model = std::env::var_os("MODEL").map(|path| halfway_mesh::load(path.as_ref())).transpose()?;
    for name in ["S1", "S1x4", "S1coarse", "S1coarsex4", "S2", "S4", "model", "small_model"] {
        if name.ends_with("model") && model.is_none() {
            continue;
        }
        let scene_of = |shading| {
            let mut scene = match (name, &model) {
                ("S2", _) => spheres(shading)?,
                ("model", Some(model)) => turntable(&model.parts[0].mesh, [1280, 720], shading)?,
                ("small_model", Some(model)) => turntable(&model.parts[0].mesh, [320, 180], shading)?,
                _ => sphere(name == "S4", shading)?,
            };
            if name.ends_with("x4") {
                scene.samples = Samples::Four;
            }
            if name.starts_with("S1coarse") {
                let mesh = pieces(&UvSphere { radius: 1.0, segments: 78, rings: 40 }.into(), TriangleOrder::Clustered)?;
                (scene.draws, scene.meshes) = (vec![draw(&mesh, 1, shading)], vec![mesh]);
            }
            Ok::<_, RasterError>(scene)
        };
        for width in VectorWidth::available() {
            for threads in [1, 2] {
                let mut rasterizer = Rasterizer::new(RasterOptions { width: Some(width), threads: Some(threads) })?;
                let line = format!("{name:12}{:>8}{threads:>8}", width.to_string());
                if !only.iter().all(|&word| line.split_whitespace().any(|found| found == word)) {
                    continue;
                }
                print!("{line}");
                for &shading in &shadings {
                    let scene = scene_of(shading)?;
                    let mut bytes = vec![0; 4 * scene.size[0] as usize * scene.size[1] as usize];
                    let mut clear_tiles = ClearTiles::default();
                    let mut shortest = f64::INFINITY;
                    let first = running();
                    for _ in 0..frames {
                        let start = Instant::now();
                        let output = Output::Bytes(&mut bytes);
                        scene.with_pass(|pass| rasterizer.draw(pass, output, &mut clear_tiles))?;
                        shortest = shortest.min(start.elapsed().as_secs_f64());
                    }
                    let mean = first.zip(running()).map(|(first, last)| (last - first) / f64::from(frames));
                    print!(" {:8.3}", 1e3 * mean.filter(|_| threads == 1).unwrap_or(shortest));
                    if let Some(folder) = folder.as_ref().filter(|_| threads == 1) {
                        write_png(&format!("{folder}/{name}_{shading:?}_{width}.png"), scene.size, &bytes)?;
                    }
                }
                println!();
            }
        }
    }
    Ok(())
}

/// 10,000 spheres of 224 triangles under one light, seen from afar.
fn spheres(shading: Shading) -> Result<Scene, RasterError> {
    let mut scene = sphere(true, shading)?;
    scene.size = [1280, 720];
    scene.lens = lens(scene.size, 45.0);
    let mesh = pieces(&UvSphere { radius: 1.0, segments: 16, rings: 8 }.into(), TriangleOrder::Clustered)?;
    // The eye at (0, 60, 160) looks at the origin.
    let length = 60.0_f32.hypot(160.0);
    let (sin, cos) = (60.0 / length, 160.0 / length);
    scene.instances.clear();
    // Front to back, as the renderer sorts them.
    for i in (0..10_000_u16).rev() {
        let (x, z) = ((f32::from(i % 100) - 49.5) * 2.5, (f32::from(i / 100) - 49.5) * 2.5);
        let (turn_sin, turn_cos) = (0.01 * f32::from(i % 97)).sin_cos();
        let rows = [
            [turn_cos, 0.0, turn_sin, x],
            [sin * turn_sin, cos, -sin * turn_cos, -sin * z],
            [-cos * turn_sin, sin, cos * turn_cos, cos * z - length],
        ];
        let column = |c: usize| [rows[0][c], rows[1][c], rows[2][c]];
        let normal = [column(0), column(1), column(2)];
        scene.instances.push(InstanceRecord { eye_from_model: rows, normal, surface: u32::from(i % 10) });
    }
    scene.surfaces = vec![scene.surfaces[0]; 10];
    scene.draws = vec![draw(&mesh, 10_000, shading)];
    scene.meshes = vec![mesh];
    Ok(scene)
}

/// A model under the lights of S1, as large as the picture.
fn turntable(mesh: &Mesh, size: [u32; 2], shading: Shading) -> Result<Scene, RasterError> {
    let mut scene = sphere(false, shading)?;
    (scene.size, scene.lens) = (size, lens(size, 45.0));
    let bounds = mesh.bounds();
    let center = bounds.center().to_array();
    let scale = 1.2 / bounds.radius();
    let row = |axis: usize| {
        let mut row = [0.0; 4];
        (row[axis], row[3]) = (scale, -scale * center[axis]);
        row
    };
    let mut rows = [row(0), row(1), row(2)];
    rows[2][3] -= 3.3;
    scene.instances = vec![InstanceRecord { eye_from_model: rows, ..scene.instances[0] }];
    let mesh = pieces(mesh, TriangleOrder::Clustered)?;
    scene.draws = vec![draw(&mesh, 1, shading)];
    scene.meshes = vec![mesh];
    Ok(scene)
}

/// The CPU time of this thread in seconds.
fn running() -> Option<f64> {
    let line = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

fn write_png(path: &str, [width, height]: [u32; 2], bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(bytes)?;
    Ok(())
}

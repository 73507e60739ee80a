//! The levels of detail of some meshes, or of the models named: the time and the peak memory to make them, their
//! triangles and their errors. Run with `--release`; `--times 5` makes each five times and gives the median,
//! `RAYON_NUM_THREADS=1` makes them on one thread.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use glam::Vec3;
use halfway_mesh::{LodGroup, LodHierarchy, Mesh, Plane, Teapot, UvSphere};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut meshes, mut times) = (Vec::new(), 1_usize);
    let mut args = std::env::args().skip(1);
    while let Some(name) = args.next() {
        if name == "--times" {
            times = args.next().ok_or("--times wants a number")?.parse()?;
        } else if let Some((_, made)) = MADE.iter().find(|(made, _)| *made == name) {
            meshes.push((name, made()));
        } else {
            let model = halfway_mesh::load(name.as_ref())?;
            meshes.extend(model.parts.into_iter().map(|part| (name.clone(), part.mesh)));
        }
    }
    if meshes.is_empty() {
        meshes.extend(MADE.iter().map(|&(name, made)| (name.to_owned(), made())));
    }
    for (name, mesh) in &meshes {
        print_levels(name, mesh, times.max(1));
    }
    Ok(())
}

type NamedMesh = (&'static str, fn() -> Mesh);

/// The meshes that can be named instead of a model.
const MADE: [NamedMesh; 6] = [
    ("stone", || stone(1000, 501)),
    ("heights", heights),
    ("sphere", || UvSphere::new(1.0, 512, 256).into()),
    ("ball", || UvSphere::new(1.0, 255, 128).into()),
    ("marble", || UvSphere::new(1.0, 64, 32).into()),
    ("teapot", || Teapot::new(24).into()),
];

/// A scan: a sphere with hills, and with noise of up to a thousandth.
fn stone(segments: u32, rings: u32) -> Mesh {
    let smooth = Mesh::from(UvSphere::new(1.0, segments, rings));
    let moved = smooth.displaced(|i| {
        let p = smooth.positions()[i];
        let hills = (3.0 * p.x + 1.0).sin() * (4.0 * p.y).sin() + 0.4 * (9.0 * p.z + 5.0 * p.x).sin();
        0.07 * hills + 0.002 * (random(p) - 0.5)
    });
    moved.expect("finite heights").0
}

/// A plain of 500,000 triangles with hills.
fn heights() -> Mesh {
    let plain = Mesh::from(Plane { divisions: 500, size: 2.0 });
    let moved = plain.displaced(|i| {
        let Vec3 { x, z, .. } = plain.positions()[i];
        0.1 * (5.0 * x + (3.0 * z).sin()).sin() + 0.02 * (31.0 * x).sin() * (27.0 * z + 7.0 * x).sin()
    });
    moved.expect("finite heights").0
}

/// A random number from 0 to 1 by position, the same for both ends of a seam.
fn random(p: Vec3) -> f32 {
    let mix = |all: u32, x: f32| (all ^ (x + 2.0).to_bits()).wrapping_mul(0x9E37_79B1).rotate_left(13);
    p.to_array().into_iter().fold(0, mix) as f32 / u32::MAX as f32
}

/// Prints the triangles drawn if groups with at most this error are accepted.
fn print_levels(name: &str, mesh: &Mesh, times: usize) {
    let mut seconds = Vec::new();
    let (mut hierarchy, mut memory) = (None, 0);
    for _ in 0..times {
        drop(hierarchy.take());
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let start = Instant::now();
        hierarchy = mesh.lod_hierarchy(&AtomicBool::new(false));
        seconds.push(start.elapsed().as_secs_f64());
        memory = memory.max(MEMORY.peak_usage() - before);
    }
    let hierarchy: LodHierarchy = hierarchy.expect("nothing stops it");
    seconds.sort_by(f64::total_cmp);
    let median = seconds[times / 2];
    println!(
        "{name}: {} triangles, {} clusters, {} groups, {:.1} ms, {:.2} s a million triangles, at most {:.1} MB of \
        memory, {:.2} of the mesh's",
        mesh.triangle_count(),
        hierarchy.clusters.len(),
        hierarchy.groups.len(),
        median * 1e3,
        median * 1e6 / mesh.triangle_count() as f64,
        memory as f64 / 1e6,
        memory as f64 / bytes_of(mesh) as f64,
    );
    let radius = mesh.bounds().radius();
    for exponent in 0..16 {
        let most = radius * 0.1 * 0.5f32.powi(exponent);
        let count = |error: &dyn Fn(&LodGroup) -> f32| -> usize {
            let cut = hierarchy.cut(|group| error(group) <= most);
            cut.into_iter().map(|cluster| hierarchy.triangles_of(cluster).len()).sum()
        };
        let [surface, lit, textured] =
            [[false, false], [true, false], [true, true]].map(|[lit, images]| count(&|group| group.error(lit, images)));
        println!("  within {most:.2e}: {surface:8} triangles, {lit:8} if lit, {textured:8} with images, too");
    }
}

/// The memory that positions, normals and indices of a mesh take.
fn bytes_of(mesh: &Mesh) -> usize {
    size_of_val(mesh.positions()) + size_of_val(mesh.normals()) + size_of_val(mesh.indices())
}

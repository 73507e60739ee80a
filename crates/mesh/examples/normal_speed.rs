//! The cost of vertex normals of a mesh of a million triangles, relative to passes that only read the same arrays, and
//! their peak memory. Run with `--release`.

use std::hint::black_box;
use std::time::Instant;

use glam::{DVec3, Vec3};
use halfway_mesh::{Mesh, NormalWeighting, Normals};

/// A torus of 1000 × 500 cells, its vertices in rows, every one used.
fn torus() -> (Vec<Vec3>, Vec<u32>) {
    const CELLS: [u32; 2] = [1000, 500];
    let turn = |i: u32, n: u32| (std::f32::consts::TAU * i as f32 / n as f32).sin_cos();
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for i in 0..CELLS[0] {
        for j in 0..CELLS[1] {
            let ((sin_u, cos_u), (sin_v, cos_v)) = (turn(i, CELLS[0]), turn(j, CELLS[1]));
            let out = 1.0 + 0.4 * cos_v;
            positions.push(Vec3::new(out * cos_u, 0.4 * sin_v, out * sin_u));
            let at = |i: u32, j: u32| (i % CELLS[0]) * CELLS[1] + j % CELLS[1];
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
            indices.extend([a, b, c, b, d, c]);
        }
    }
    (positions, indices)
}

/// The shortest of nine runs, in milliseconds: other work of the machine only adds to it.
fn shortest(mut run: impl FnMut()) -> f64 {
    let times = (0..9).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64() * 1e3
    });
    times.fold(f64::INFINITY, f64::min)
}

/// The peak memory of the process since the last call, in MiB; on Linux only.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kib: f64 = status.lines().find(|line| line.starts_with("VmHWM"))?.split_whitespace().nth(1)?.parse().ok()?;
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    Some(kib / 1024.0)
}

fn main() {
    let (positions, indices) = torus();
    println!("{} triangles, {} vertices", indices.len() / 3, positions.len());
    let along = shortest(|| {
        let sum: DVec3 = positions.iter().map(|p| p.as_dvec3()).sum();
        black_box((sum, indices.iter().map(|&i| u64::from(i)).sum::<u64>()));
    });
    let through = shortest(|| {
        let sum: DVec3 = indices.iter().map(|&i| positions[i as usize].as_dvec3()).sum();
        black_box(sum);
    });
    println!("read both arrays in order           {along:8.2} ms");
    println!("read the positions by the indices   {through:8.2} ms");
    let mesh = Mesh::new(positions, indices).expect("a torus is a mesh");
    let mib = (mesh.positions().len() * 24 + mesh.indices().len() * 4) as f64 / f64::from(1 << 20);
    let creased = |weighting| Normals::Creased { angle: 1.0, weighting };
    for (name, policy) in [
        ("uniform", Normals::Weighted(NormalWeighting::Uniform)),
        ("area", Normals::Weighted(NormalWeighting::Area)),
        ("angle", Normals::Weighted(NormalWeighting::Angle)),
        ("Max", Normals::Weighted(NormalWeighting::Max)),
        ("face", Normals::Face),
        ("creased, Max", creased(NormalWeighting::Max)),
    ] {
        let before = peak();
        let made = mesh.clone().with_normals(policy).0;
        let more = peak().zip(before).map_or(0.0, |(after, _)| after);
        drop(made);
        // The clone that `with_normals` changes is part of the time.
        let time = shortest(|| drop(black_box(mesh.clone().with_normals(policy))));
        print!("{name:14} {time:8.2} ms, {:6.2} and {:6.2} passes", time / along, time / through);
        println!(", peak {more:.0} MiB with the {mib:.0} MiB of the mesh itself");
    }
}

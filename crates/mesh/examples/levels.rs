//! The levels of detail of spheres, or of the models named: how long they take and how far off they are. Run with
//! `--release`.

use std::time::Instant;

use halfway_mesh::{Mesh, UvSphere};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut meshes = Vec::new();
    for name in std::env::args().skip(1) {
        let model = halfway_mesh::load(name.as_ref())?;
        meshes.extend(model.parts.into_iter().map(|part| (name.clone(), part.mesh)));
    }
    if meshes.is_empty() {
        let sphere = |(segments, rings)| (format!("{segments} × {rings}"), UvSphere::new(1.0, segments, rings).into());
        meshes.extend([(512, 256), (64, 32), (16, 8)].map(sphere));
    }
    for (name, mesh) in &meshes {
        print_levels(name, mesh);
    }
    Ok(())
}

fn print_levels(name: &str, mesh: &Mesh) {
    let start = Instant::now();
    let levels = mesh.levels();
    println!("{name}: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    println!("  triangles  error      normal     spread     of a sphere's even triangles");
    for level in [mesh.finest_level()].iter().chain(&levels) {
        // N equal equilateral triangles on a unit sphere have the circumradius √(9.67/N).
        let even = (9.67 / level.triangle_count() as f32).sqrt();
        let [error, spread] = [level.normal_error, level.normal_spread].map(f32::to_degrees);
        let ratio = level.normal_spread / even;
        println!("  {:9}  {:.3e}  {error:8.4}°  {spread:8.4}°  {ratio:.2}", level.triangle_count(), level.error);
    }
}

//! The hierarchies of patches of spheres, or of the models named: how long they take and how far off they are. Run with
//! `--release`.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use halfway_mesh::{Mesh, PatchGroup, UvSphere};

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
        print_hierarchy(name, mesh);
    }
    Ok(())
}

/// What would be drawn if every group would do that is no further off than this.
fn print_hierarchy(name: &str, mesh: &Mesh) {
    let start = Instant::now();
    let hierarchy = mesh.patch_hierarchy(&AtomicBool::new(false)).expect("nothing stops it");
    let time = start.elapsed().as_secs_f64() * 1e3;
    let groups = hierarchy.groups.len();
    println!(
        "{name}: {} triangles, {} patches, {groups} groups, {time:.1} ms",
        mesh.triangle_count(),
        hierarchy.patches.len()
    );
    let radius = mesh.bounds().radius();
    for exponent in 0..10 {
        let most = radius * 0.1 * 0.5f32.powi(exponent);
        let within = || hierarchy.groups.iter().filter(|group| group.error <= most);
        let largest = |of: fn(&PatchGroup) -> f32| within().map(of).fold(0.0, f32::max);
        let [normal, spread] = [largest(|g| g.normal_error), largest(|g| g.normal_spread)].map(f32::to_degrees);
        let (triangles, edge) = (hierarchy.triangles_within(most), largest(|group| group.longest_edge));
        println!(
            "  within {most:.2e}: {triangles:7} triangles, {normal:8.3}° off, spread {spread:7.2}°, edges {edge:.2e}"
        );
    }
}

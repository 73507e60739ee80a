//! The levels of detail of spheres, or of the models named: how long they take and how far off they are. Run with
//! `--release`.

use std::f32::consts::PI;
use std::time::Instant;

use bevy_math::Vec3;
use halfway_mesh::{Level, Mesh, UvSphere};

/// So many triangles of a level are looked at.
const LOOKED_AT: usize = 1 << 24;

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
    println!("  triangles  error      normal     of 99 %    spread     of a sphere's even triangles");
    for level in [mesh.finest_level()].iter().chain(&levels) {
        // N equal equilateral triangles on a unit sphere have the circumradius √(9.67/N).
        let even = (9.67 / level.triangle_count() as f32).sqrt();
        let [error, spread] = [level.normal_error, level.normal_spread].map(f32::to_degrees);
        let (ratio, most) = (level.normal_spread / even, normal_error_of_most(mesh, level).to_degrees());
        let count = level.triangle_count();
        println!("  {count:9}  {:.3e}  {error:8.4}°  {most:8.4}°  {spread:8.4}°  {ratio:.2}", level.error);
    }
}

/// The angle between the mesh's normal and the level's, in radians, that 99 % of some vertices do not pass: of those
/// that the level has not, each against all its triangles.
fn normal_error_of_most(mesh: &Mesh, level: &Level) -> f32 {
    let mut is_used = vec![false; mesh.positions().len()];
    level.indices.iter().for_each(|&vertex| is_used[vertex as usize] = true);
    let gone: Vec<usize> = (0..is_used.len()).filter(|&vertex| !is_used[vertex]).collect();
    let samples = (LOOKED_AT / level.triangle_count()).clamp(1, gone.len().max(1));
    let vertices = gone.iter().step_by(gone.len().div_ceil(samples).max(1));
    let mut angles: Vec<f32> = vertices.map(|&vertex| normal_error_at(mesh, level, vertex)).collect();
    angles.sort_unstable_by(f32::total_cmp);
    angles.get(angles.len() * 99 / 100).copied().unwrap_or(0.0)
}

/// The angle at a vertex: at the nearest point, where a difference of normals counts as that part of the distance from
/// the level's nearest vertex.
fn normal_error_at(mesh: &Mesh, level: &Level, vertex: usize) -> f32 {
    let (p, n) = (mesh.positions()[vertex], mesh.normals()[vertex]);
    let to_vertex2 = |&i: &u32| p.distance_squared(mesh.positions()[i as usize]);
    let scale2 = level.indices.iter().map(to_vertex2).fold(f32::INFINITY, f32::min);
    let (mut least, mut angle) = (f32::INFINITY, PI);
    for triangle in level.indices.as_chunks::<3>().0 {
        let corners = triangle.map(|i| mesh.positions()[i as usize]);
        let weights = nearest_on(p, corners);
        let sum = |of: [Vec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
        let m = sum(triangle.map(|i| mesh.normals()[i as usize])).normalize_or_zero();
        let cost = p.distance_squared(sum(corners)) + scale2 * m.distance_squared(n);
        if cost < least {
            (least, angle) = (cost, m.cross(n).length().atan2(m.dot(n)));
        }
    }
    angle
}

/// The weights of a triangle's corners at the point nearest to another.
fn nearest_on(p: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let n = ab.cross(ac);
    let [v, w] = [ap.cross(ac), ab.cross(ap)].map(|part| part.dot(n) / n.length_squared());
    if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
        return [1.0 - v - w, v, w];
    }
    let along = |from: Vec3, to: Vec3| ((p - from).dot(to - from) / from.distance_squared(to)).clamp(0.0, 1.0);
    let [ab, bc, ca] = [along(a, b), along(b, c), along(c, a)];
    let sides = [[1.0 - ab, ab, 0.0], [0.0, 1.0 - bc, bc], [ca, 0.0, 1.0 - ca]];
    let distance2 = |w: &[f32; 3]| p.distance_squared(a * w[0] + b * w[1] + c * w[2]);
    sides.into_iter().min_by(|a, b| distance2(a).total_cmp(&distance2(b))).unwrap_or([1.0, 0.0, 0.0])
}

//! Vertex order, meshlets and simplified meshes.
#![cfg(feature = "prepare")]

use bevy_math::Vec3;
use halfway_mesh::{Cuboid, DirectionCone, Mesh, Meshlets, Teapot, UvSphere};

fn models() -> [(&'static str, Mesh); 3] {
    [
        ("sphere", Mesh::from(UvSphere::new(1.0, 48, 24))),
        ("teapot", Mesh::from(Teapot::new(6))),
        ("cuboid", Mesh::from(Cuboid::default())),
    ]
}

/// The triangles by all that their corners have, each begun at its least corner, in a fixed order.
fn content(mesh: &Mesh) -> Vec<[[u32; 8]; 3]> {
    let corner = |i: u32| {
        let i = i as usize;
        let uv = mesh.uvs().map_or([0.0; 2], |uvs| uvs[i].to_array());
        let (p, n) = (mesh.positions()[i].to_array(), mesh.normals()[i].to_array());
        [p[0], p[1], p[2], n[0], n[1], n[2], uv[0], uv[1]].map(f32::to_bits)
    };
    let rotated = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(corner);
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
    };
    let mut triangles: Vec<_> = mesh.triangles().map(rotated).collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn the_optimised_mesh_is_the_same_in_a_better_order() {
    for (name, mesh) in models() {
        let optimized = mesh.optimized();
        assert_eq!(content(&optimized), content(&mesh), "{name}");
        let (before, after) = (mesh.report().cache_misses, optimized.report().cache_misses);
        // The order may lose 5 % for the sake of overdraw; the teapot's patches are in a good order already.
        assert!(after <= 1.05 * before, "{name}: {before} {after}");
        // Vertices are used in order.
        let mut next = 0;
        for &i in optimized.indices() {
            assert!(i <= next);
            next = next.max(i + 1);
        }
    }
    let sphere = Mesh::from(UvSphere::new(1.0, 48, 24));
    // A row of the sphere is longer than the cache: about one load a triangle; a good order takes about 0.7.
    assert!(sphere.optimized().report().cache_misses < 0.8, "{}", sphere.optimized().report().cache_misses);
}

fn is_inside(cone: &DirectionCone, n: Vec3) -> bool {
    n.as_dvec3().dot(cone.axis.as_dvec3()) >= f64::from(cone.cos)
}

#[test]
fn meshlets_hold_what_they_say() {
    for (name, mesh) in models() {
        for exponent in [-18, 0, 18] {
            let scale = 10_f32.powi(exponent);
            let scaled = mesh.positions().iter().map(|p| *p * scale + Vec3::X * scale).collect();
            let normals = Some(mesh.normals().to_vec());
            let mesh = Mesh::from_parts(scaled, normals, None, mesh.indices().to_vec()).unwrap();
            for most in [0, 64, Meshlets::DEFAULT_TRIANGLES, u32::MAX] {
                let cut = mesh.meshlets(most);
                assert_eq!(content(&cut.mesh), content(&mesh), "{name}");
                check_meshlets(&cut, most.clamp(4, 512), &format!("{name} 1e{exponent} {most}"));
            }
        }
    }
}

fn check_meshlets(cut: &Meshlets, most: u32, name: &str) {
    let mut end = 0;
    for meshlet in &cut.meshlets {
        assert_eq!(meshlet.triangles.start, end, "{name}");
        end = meshlet.triangles.end;
        assert!((1..=most).contains(&(end - meshlet.triangles.start)), "{name}");
        for triangle in cut.mesh.triangles().skip(meshlet.triangles.start as usize).take(meshlet.triangles.len()) {
            let corners = triangle.map(|i| cut.mesh.positions()[i as usize]);
            for p in corners {
                let distance = p.as_dvec3().distance(meshlet.sphere.center.as_dvec3());
                assert!(distance <= f64::from(meshlet.sphere.radius), "{name}");
            }
            assert!(triangle.iter().all(|&i| is_inside(&meshlet.normals, cut.mesh.normals()[i as usize])), "{name}");
            let [a, b, c] = corners;
            assert!(halfway_mesh::face_normal(a, b, c).is_none_or(|n| is_inside(&meshlet.faces, n)), "{name}");
            // A point inside a triangle has a normal inside the cone of a narrow meshlet.
            let sum = triangle.iter().map(|&i| cut.mesh.normals()[i as usize]).sum::<Vec3>().as_dvec3().normalize();
            let cos = sum.dot(meshlet.normals.axis.as_dvec3());
            // Rounded once more than the normals themselves.
            assert!(meshlet.normals.cos <= 0.0 || cos > f64::from(meshlet.normals.cos) - 1e-6, "{name}");
        }
    }
    assert_eq!(end as usize, cut.mesh.triangle_count(), "{name}");
}

#[test]
fn meshlets_are_small() {
    let cut = Mesh::from(UvSphere::new(1.0, 128, 64)).meshlets(Meshlets::DEFAULT_TRIANGLES);
    let (count, most) = (cut.meshlets.len() as f32, Meshlets::DEFAULT_TRIANGLES as f32);
    // At least two thirds full.
    assert!(cut.mesh.triangle_count() as f32 / count > most * 2.0 / 3.0, "{count}");
    // A round patch with its share of the sphere's area 4π has the radius 2/√count; half as large again is good.
    let mean = cut.meshlets.iter().map(|meshlet| meshlet.sphere.radius).sum::<f32>() / count;
    assert!(mean < 1.5 * 2.0 / count.sqrt(), "{mean} {count}");
    // And normals as far from its middle as the sphere turns.
    assert!(cut.meshlets.iter().all(|meshlet| meshlet.normals.cos > 0.8));
}

#[test]
fn simplifying_at_any_scale_and_to_any_number() {
    let sphere = Mesh::from(UvSphere::new(1.0, 32, 16));
    let reference = sphere.simplified(200, f64::INFINITY);
    for exponent in [-18, 18] {
        let scale = 10_f32.powi(exponent);
        let scaled = sphere.positions().iter().map(|p| *p * scale).collect();
        let uvs = sphere.uvs().map(<[_]>::to_vec);
        let mesh = Mesh::from_parts(scaled, Some(sphere.normals().to_vec()), uvs, sphere.indices().to_vec()).unwrap();
        let level = mesh.simplified(200, f64::INFINITY);
        // Not scaled by a power of two, so that rounding may decide an edge.
        let ratio = level.mesh.triangle_count() as f64 / reference.mesh.triangle_count() as f64;
        assert!((ratio - 1.0).abs() < 0.1 && (level.error / f64::from(scale) / reference.error - 1.0).abs() < 0.2);
    }
    for limit in [0.0, -1.0, f64::NAN] {
        // Only what is flat may go; on a sphere nothing is.
        assert!(sphere.simplified(0, limit).mesh.triangle_count() > 900);
    }
    let none = sphere.simplified(0, f64::INFINITY);
    assert!(none.mesh.triangle_count() >= 1);
    assert_eq!(sphere.simplified(usize::MAX, f64::INFINITY).mesh.triangle_count(), sphere.triangle_count());
    let limited = sphere.simplified(0, 0.05);
    assert!(limited.error <= 0.05 && limited.mesh.triangle_count() < sphere.triangle_count());
}

//! Levels of detail.

use std::collections::HashMap;

use bevy_math::{DVec3, Vec3};
use halfway_mesh::{Cuboid, Level, Mesh, Plane, Subdivision, Teapot, UvSphere};

fn triangles(level: &Level) -> &[[u32; 3]] {
    level.indices.as_chunks::<3>().0
}

fn position(mesh: &Mesh, vertex: u32) -> Vec3 {
    mesh.positions()[vertex as usize]
}

/// How many triangles pass each edge, by the bits of its ends' positions.
fn edges(mesh: &Mesh, indices: &[u32]) -> HashMap<[[u32; 3]; 2], usize> {
    let key = |vertex: u32| (position(mesh, vertex) + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut passes = HashMap::new();
    for [a, b, c] in indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(key)) {
        for ends in [[a, b], [b, c], [c, a]] {
            *passes.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_insert(0) += 1;
        }
    }
    passes
}

fn check_order(mesh: &Mesh, levels: &[Level], name: &str) {
    let mut before = mesh.finest_level();
    for level in levels {
        let (count, most) = (level.triangle_count(), 0.93 * before.triangle_count() as f64);
        assert!(count >= 32 && count as f64 <= most, "{name}: {count}");
        assert!(level.error >= before.error && level.normal_error >= before.normal_error, "{name}");
        assert!(level.indices.iter().all(|&i| (i as usize) < mesh.positions().len()), "{name}");
        before = level.clone();
    }
}

#[test]
fn a_sphere_stays_a_sphere() {
    let mesh = Mesh::from(UvSphere::new(1.0, 64, 32));
    let levels = mesh.levels();
    assert!(levels.len() >= 4, "{}", levels.len());
    check_order(&mesh, &levels, "sphere");
    for level in &levels {
        let count = level.triangle_count();
        // Vertices lie on the sphere, so a triangle is furthest from it at its circumcentre if it is acute, and else at
        // the middle of its longest side.
        let sagitta = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| position(&mesh, i).as_dvec3());
            let n = (b - a).cross(c - a).normalize();
            let is_acute = [[a, b, c], [b, c, a], [c, a, b]].iter().all(|[a, b, c]| (b - a).dot(c - a) > 0.0);
            let nearest = [a + b, b + c, c + a].map(|sum| 0.5 * sum.length()).into_iter().fold(1.0, f64::min);
            1.0 - if is_acute { n.dot(a).abs() } else { nearest }
        };
        let sagitta = triangles(level).iter().map(sagitta).fold(0.0, f64::max);
        let error = f64::from(level.error);
        // The mesh itself is up to 1 − cos(π/64) = 0.0012 inside the sphere, so what is furthest in may be nearer to it
        // by that; other points than the deepest are sampled, and the nearest that faces alike is not quite the
        // nearest.
        assert!(error > 0.9 * sagitta - 0.0012 && error < 1.02 * sagitta, "{count}: {error} {sagitta}");
        // Interpolated normals of a sphere point away from its centre, whatever the triangles are; 0.063 is what 48 of
        // them are off by.
        assert!(level.normal_error < 0.07, "{count}: {}", level.normal_error);
        // Even triangles have the circumradius √(9.67/N); 1.9 is the worst that was found.
        let even = (9.67 / count as f32).sqrt();
        assert!(level.normal_spread < 2.1 * even, "{count}: {}", level.normal_spread / even);
        assert!(level.longest_edge < 2.1 * 3.0_f32.sqrt() * even, "{count}: {}", level.longest_edge);
    }
}

#[test]
fn large_meshes_of_any_number_of_triangles_have_levels() {
    // Above 32,768 triangles a candidate keeps about half: exactly half of 34,322 = 4k + 2 or of an odd number cannot
    // be left, since triangles vanish by twos.
    let sphere = Mesh::from(UvSphere::new(1.0, 131, 132));
    for left_out in [0, 1] {
        let indices = sphere.indices()[3 * left_out..].to_vec();
        let mesh =
            Mesh::from_parts(sphere.positions().to_vec(), Some(sphere.normals().to_vec()), None, indices).unwrap();
        let (count, levels) = (mesh.triangle_count(), mesh.levels());
        assert_eq!(count, 34_322 - left_out);
        assert!(levels.len() >= 8, "{count}: {} levels", levels.len());
        check_order(&mesh, &levels, &format!("{count} triangles"));
        let first = levels[0].triangle_count();
        assert!(first.abs_diff(count / 2) <= 2, "{count}: {first}");
    }
}

#[test]
fn seams_do_not_crack() {
    // The sphere repeats its first meridian and its poles; here each meridian end also misses its twin by some bits.
    let sphere = Mesh::from(UvSphere::new(1.0, 48, 24));
    let shaken = |(i, p): (usize, &Vec3)| if i % 49 == 48 { *p * (1.0 + 2.0 * f32::EPSILON) } else { *p };
    let positions: Vec<Vec3> = sphere.positions().iter().enumerate().map(shaken).collect();
    let normals = Some(sphere.normals().to_vec());
    let shaken = Mesh::from_parts(positions, normals, None, sphere.indices().to_vec()).unwrap();
    for (name, mesh) in [("with uvs", sphere), ("shaken, without uvs", shaken)] {
        let levels = mesh.levels();
        assert!(levels.len() >= 4, "{name}: {}", levels.len());
        for level in &levels {
            assert!(edges(&mesh, &level.indices).values().all(|&passes| passes == 2), "{name}");
        }
    }
}

#[test]
fn a_plane_keeps_its_border() {
    let mesh = Mesh::from(Plane { divisions: 32, ..Plane::default() });
    let levels = mesh.levels();
    assert!(levels.len() >= 4, "{}", levels.len());
    let area = |indices: &[u32]| -> f32 {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| position(&mesh, i));
            0.5 * (b - a).cross(c - a).length()
        };
        indices.as_chunks::<3>().0.iter().map(area).sum()
    };
    for level in &levels {
        // All lies in the plane and covers it; rounding only.
        assert!(level.error < 1e-5 && level.normal_error < 1e-6 && level.normal_spread < 1e-6, "{level:?}");
        assert!((area(&level.indices) / area(mesh.indices()) - 1.0).abs() < 1e-5);
        let passes = edges(&mesh, &level.indices);
        let border = passes.iter().filter(|(_, passes)| **passes == 1).map(|(ends, _)| {
            let [a, b] = ends.map(|end| Vec3::from_array(end.map(f32::from_bits)));
            a.distance(b)
        });
        let size = mesh.bounds().size();
        assert!((border.sum::<f32>() / (2.0 * (size.x + size.z)) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn creases_stay() {
    let mesh = Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 3).unwrap();
    let levels = mesh.levels();
    assert!(levels.len() >= 2, "{}", levels.len());
    for level in &levels {
        // Every triangle lies in a face, has its normal, and all edges are closed.
        assert!(level.error < 1e-5 && level.normal_error < 1e-6 && level.normal_spread < 1e-6, "{level:?}");
        assert!(edges(&mesh, &level.indices).values().all(|&passes| passes == 2));
        let corner = mesh.bounds().max;
        let at_corner = |i: &&u32| position(&mesh, **i).abs_diff_eq(corner, 1e-6);
        let normals: Vec<Vec3> = level.indices.iter().filter(at_corner).map(|&i| mesh.normals()[i as usize]).collect();
        assert!([Vec3::X, Vec3::Y, Vec3::Z].iter().all(|n| normals.contains(n)));
    }
}

#[test]
fn sampled_points_are_within_the_error() {
    let mesh = Mesh::from(Teapot::new(6));
    let levels = mesh.levels();
    assert!(!levels.is_empty());
    check_order(&mesh, &levels, "teapot");
    for level in &levels {
        let coarse = Mesh::from_parts(mesh.positions().to_vec(), None, None, level.indices.clone()).unwrap();
        // All centroids are among what is measured: there are fewer than samples.
        let centroid = |t: &[u32; 3]| t.map(|i| position(&mesh, i).as_dvec3()).iter().sum::<DVec3>() / 3.0;
        let centroids: Vec<Vec3> = triangles(level).iter().map(|t| centroid(t).as_vec3()).collect();
        let points = (0..centroids.len() as u32).flat_map(|i| [i; 3]).collect();
        let points = Mesh::new(centroids, points).unwrap();
        assert!(points.distance_to(&mesh, 0.0).least <= 1.01 * f64::from(level.error));
        // Nor is it far from the greatest distance of all points.
        let all = mesh.distance_to(&coarse, 1e-3).most.max(coarse.distance_to(&mesh, 1e-3).most);
        // That of all points is of any side: 1.17 was found, where what faces alike is further off than the nearest.
        let error = f64::from(level.error);
        assert!(error > 0.8 * all && error < 1.5 * all, "{error} {all}");
    }
}

#[test]
fn thin_sheets_keep_their_sides() {
    // A wavy sheet and its back, nearer to each other than levels are to either.
    let plane = Mesh::from(Plane { divisions: 48, ..Plane::default() });
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    let (size, thickness) = (plane.bounds().size().x, 1e-4);
    for side in [1.0, -1.0] {
        let first = positions.len() as u32;
        for p in plane.positions() {
            let (turn, height) = (9.0 / size, 0.05 * size);
            positions.push(Vec3::new(p.x, height * (turn * p.x).sin() + side * thickness * size, p.z));
            normals.push(side * Vec3::new(-height * turn * (turn * p.x).cos(), 1.0, 0.0).normalize());
        }
        let order = if side > 0.0 { [0, 1, 2] } else { [0, 2, 1] };
        indices.extend(plane.triangles().flat_map(|triangle| order.map(|corner| first + triangle[corner])));
    }
    let mesh = Mesh::from_parts(positions, Some(normals), None, indices).unwrap();
    let levels = mesh.levels();
    assert!(levels.last().is_some_and(|level| level.error > 10.0 * thickness * size), "{}", levels.len());
    for level in &levels {
        // The sheet slopes by up to 0.42, so normals of one side are less than 2 · 0.42 apart; the others are more than
        // π − 0.84 away.
        assert!(level.normal_error < 0.84, "{}: {}", level.triangle_count(), level.normal_error);
    }
}

#[test]
fn what_cannot_be_coarser_has_no_levels() {
    let meshes = [
        ("a triangle", vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2]),
        ("points", vec![Vec3::ONE; 300], (0..300).collect()),
        ("a line", (0..300).map(|i| Vec3::X * i as f32).collect(), (0..300).collect()),
        ("one triangle often", vec![Vec3::ZERO, Vec3::X, Vec3::Y], [0, 1, 2].repeat(100)),
        ("a fan on one edge", (0..102).map(|i| Vec3::new((i % 7) as f32, i as f32, (i % 3) as f32)).collect(), {
            (2..102).flat_map(|i| [0, 1, i]).collect()
        }),
        ("the largest", vec![Vec3::MIN, Vec3::MAX, Vec3::X * f32::MAX], [0, 1, 2].repeat(50)),
    ];
    for (name, positions, indices) in meshes {
        let mesh = Mesh::new(positions, indices).unwrap();
        assert!(mesh.levels().is_empty(), "{name}");
    }
}

#[test]
fn levels_do_not_depend_on_scale() {
    let sphere = Mesh::from(UvSphere::new(1.0, 32, 16));
    let levels = sphere.levels();
    for exponent in [-60, 60] {
        let scale = 2.0_f32.powi(exponent);
        let scaled = sphere.positions().iter().map(|p| *p * scale).collect();
        let uvs = sphere.uvs().map(<[_]>::to_vec);
        let mesh = Mesh::from_parts(scaled, Some(sphere.normals().to_vec()), uvs, sphere.indices().to_vec()).unwrap();
        let found = mesh.levels();
        assert_eq!(found.len(), levels.len());
        for (a, b) in found.iter().zip(&levels) {
            assert_eq!(a.indices, b.indices);
            // Powers of two change no digits; the snapping distance is rounded apart.
            assert!((a.error / scale / b.error - 1.0).abs() < 1e-6);
        }
    }
}

//! Displacement and subdivision.
#![expect(clippy::float_cmp, reason = "heights and halves are whole fractions of powers of two")]

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfway_mesh::{Cuboid, Mesh, MeshError, NormalWeighting, Normals, Plane, Subdivision, UvSphere, Weld};

/// A cube of eight vertices and edge 1.
fn cube() -> Mesh {
    Mesh::from(Cuboid::default()).welded(Weld::positions(0.0)).unwrap().0
}

/// A square in the plane y = 0 from −1 to 1, seen from +Y, cut by 2^`times`.
fn sheet(times: u32) -> Mesh {
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::ONE, Vec2::new(1.0, -1.0)];
    let positions = corners.iter().map(|c| Vec3::new(c.x, 0.0, c.y)).collect();
    let uvs = corners.iter().map(|c| *c * 0.5 + 0.5).collect();
    let mesh = Mesh::from_parts(positions, None, Some(uvs), vec![0, 1, 2, 0, 2, 3]).unwrap();
    mesh.subdivided(Subdivision::Midpoint, times).unwrap()
}

#[test]
fn uniform_displacement_is_an_offset() {
    let sphere = Mesh::from(UvSphere::new(1.0, 24, 12));
    let (larger, report) = sphere.displaced(|_| 0.5).unwrap();
    assert_eq!(report.cancelled, 0);
    for (p, n) in larger.positions().iter().zip(larger.normals()) {
        // Half a step of f32 below 2 in each coordinate.
        assert!((p.length() - 1.5).abs() < 3e-7);
        assert!(n.distance(p.normalize()) < 0.02);
    }
    // Poles and seam stay closed.
    assert_eq!((larger.report().closed, larger.report().problems.open_edges), (1, 0));
    let (plane, _) = Mesh::from(Plane::default()).displaced(|_| -2.0).unwrap();
    assert!(plane.positions().iter().all(|p| p.y == -2.0) && plane.normals().iter().all(|n| *n == Vec3::Y));
}

#[test]
fn displacement_keeps_creases_and_seams_closed() {
    // Every vertex another height; the cuboid has three vertices at each corner.
    let (mesh, _) = Mesh::from(Cuboid::default()).displaced(|vertex| vertex as f32 * 0.01).unwrap();
    let report = mesh.report();
    assert_eq!((report.positions, report.closed, report.problems.open_edges), (8, 1, 0));
}

#[test]
fn normals_follow_the_heights() {
    // y = sin(4x)/8 and its normal (−cos(4x)/2, 1, 0); edges of 1/32 make an error of the order of their square times
    // the third derivative, 8·(1/32)²/6.
    let sheet = sheet(6);
    let (mesh, report) = sheet.displaced(|vertex| (4.0 * sheet.positions()[vertex].x).sin() / 8.0).unwrap();
    assert!(report.is_clean());
    for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
        assert!((p.y - (4.0 * p.x).sin() / 8.0).abs() < 1e-6);
        if p.x.abs() < 0.99 && p.z.abs() < 0.99 {
            let expected = Vec3::new(-(4.0 * p.x).cos() / 2.0, 1.0, 0.0).normalize();
            assert!(n.distance(expected) < 2e-3, "{p} {n} {expected}");
        }
    }
}

#[test]
fn bad_heights_are_refused() {
    let not_finite = |attribute, vertex, value| Err(MeshError::NotFinite { attribute, vertex, value });
    let inf = f32::INFINITY;
    assert_eq!(cube().displaced(|v| if v == 3 { inf } else { 0.0 }), not_finite("height", 3, [inf, 0.0, 0.0]));
    let far = sheet(0).displaced(|_| f32::MAX).unwrap().0;
    assert_eq!(far.displaced(|_| f32::MAX), not_finite("position", 0, [-1.0, inf, -1.0]));
}

#[test]
fn midpoints_keep_the_shape() {
    for mesh in [Mesh::from(Cuboid::default()), cube(), Mesh::from(UvSphere::new(1.0, 8, 4))] {
        let fine = mesh.subdivided(Subdivision::Midpoint, 3).unwrap();
        let (before, after) = (mesh.report(), fine.report());
        assert_eq!(after.triangles, before.triangles * 64);
        // Sums of 64 times as many terms, of positions rounded anew.
        assert!((after.area / before.area - 1.0).abs() < 1e-6 && (after.volume / before.volume - 1.0).abs() < 1e-6);
        assert_eq!((after.pieces, after.closed, after.problems.open_edges), (before.pieces, before.closed, 0));
        assert_eq!(after.bounds, before.bounds);
        assert_eq!(fine.uvs().is_some(), mesh.uvs().is_some());
        // Old vertices come first and stay.
        assert_eq!(fine.positions()[..mesh.positions().len()], *mesh.positions());
        assert_eq!(fine.normals()[..mesh.normals().len()], *mesh.normals());
    }
}

#[test]
fn attributes_are_interpolated() {
    let mesh = sheet(0);
    let colors = vec![Vec4::X, Vec4::Y, Vec4::Z, Vec4::W];
    let fine = mesh.with_colors(colors).unwrap().subdivided(Subdivision::Midpoint, 1).unwrap();
    assert_eq!((fine.positions().len(), fine.triangle_count()), (9, 8));
    for (p, uv) in fine.positions().iter().zip(fine.uvs().unwrap()) {
        assert_eq!(*uv, Vec2::new(p.x, p.z) * 0.5 + 0.5);
    }
    // Between vertices 0 and 1, the first side of the first triangle.
    assert_eq!(fine.colors().unwrap()[4], Vec4::new(0.5, 0.5, 0.0, 0.0));
    assert_eq!(fine.indices()[..6], [0, 4, 6, 4, 1, 5]);
}

/// Loop's limit of each vertex of a closed smooth mesh of distinct positions: (1 − nχ) p + χ Σ pᵢ with
/// χ = 1 / (3/(8β) + n), β the weight of a neighbour.
fn loop_limits(mesh: &Mesh) -> Vec<DVec3> {
    let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // Closed: each neighbour comes once as the next corner.
            neighbours.entry(from).or_default().push(to);
        }
    }
    let p = |vertex: u32| mesh.positions()[vertex as usize].as_dvec3();
    (0..mesh.positions().len() as u32)
        .map(|vertex| {
            let ring = &neighbours[&vertex];
            let n = ring.len() as f64;
            let beta = (0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / n).cos()).powi(2)) / n;
            let chi = 1.0 / (0.375 / beta + n);
            (1.0 - n * chi) * p(vertex) + chi * ring.iter().map(|&other| p(other)).sum::<DVec3>()
        })
        .collect()
}

#[test]
fn loop_subdivision_goes_to_its_limit() {
    // Smooth everywhere: one normal a position, so that no edge is sharp.
    let mesh = cube();
    let fine = mesh.subdivided(Subdivision::Loop, 6).unwrap();
    let report = fine.report();
    assert_eq!((report.triangles, report.closed, report.conflicts), (12 * 4096, 1, 0));
    assert_eq!(report.positions, fine.positions().len());
    // The old vertices have lost their order by being split between fans; they are the nearest ones.
    for limit in loop_limits(&mesh) {
        let nearest = fine.positions().iter().map(|p| p.as_dvec3().distance(limit)).fold(f64::INFINITY, f64::min);
        // The slowest part of the distance to the limit falls to a quarter each time: 4⁻⁶ of the cube's edge.
        assert!(nearest < 2.5e-4, "{nearest}");
    }
    // A smooth surface: neighbouring normals are alike.
    for triangle in fine.triangles() {
        let [a, b, c] = triangle.map(|i| fine.normals()[i as usize]);
        assert!(a.dot(b) > 0.98 && b.dot(c) > 0.98);
    }
}

#[test]
fn borders_become_b_splines() {
    // One triangle: the limit of a corner is (4p + q + r)/6, of the curve between two corners their middle's.
    let corners = [Vec3::ZERO, Vec3::X * 6.0, Vec3::Y * 6.0];
    let mesh = Mesh::new(corners.to_vec(), vec![0, 1, 2]).unwrap();
    let fine = mesh.subdivided(Subdivision::Loop, 7).unwrap();
    for i in 0..3 {
        let limit = (corners[i] * 4.0 + corners[(i + 1) % 3] + corners[(i + 2) % 3]) / 6.0;
        let nearest = fine.positions().iter().map(|p| p.distance(limit)).fold(f32::INFINITY, f32::min);
        // 4⁻⁷ of the triangle.
        assert!(nearest < 6.0 / 16384.0, "{nearest}");
    }
    assert!(fine.normals().iter().all(|n| *n == Vec3::Z));
}

#[test]
fn sharp_edges_stay_sharp() {
    // The cuboid's sides have normals of their own: all twelve edges are sharp and all corners stay.
    let mesh = Mesh::from(Cuboid::default());
    let fine = mesh.subdivided(Subdivision::Loop, 3).unwrap();
    let report = fine.report();
    assert_eq!(report.bounds, mesh.bounds());
    assert!((report.volume - 1.0).abs() < 1e-6 && (report.area - 6.0).abs() < 1e-6);
    assert_eq!((report.closed, report.positions), (1, 6 * 49 + 12 * 7 + 8));
    for n in fine.normals() {
        // Flat sides, to the rounding of their positions over edges of an eighth.
        assert!((n.abs().max_element() - 1.0).abs() < 1e-6, "{n}");
    }
    // Faceted, every edge that is not flat is sharp.
    let (faceted, _) = Mesh::from(UvSphere::new(1.0, 6, 3)).with_normals(Normals::Face);
    let before = faceted.report();
    let after = faceted.subdivided(Subdivision::Loop, 2).unwrap().report();
    assert!((after.volume / before.volume - 1.0).abs() < 1e-6);
}

#[test]
fn seams_are_not_sharp() {
    // The sphere's seam and poles are split for the texture; its shape must not know.
    let sphere = Mesh::from(UvSphere::new(1.0, 12, 6));
    let welded = sphere.welded(Weld::positions(0.0)).unwrap().0;
    let (a, b) = (sphere.subdivided(Subdivision::Loop, 2).unwrap(), welded.subdivided(Subdivision::Loop, 2).unwrap());
    let (a, b) = (a.report(), b.report());
    assert_eq!((a.positions, a.closed), (b.positions, 1));
    assert!((a.volume / b.volume - 1.0).abs() < 1e-6);
}

#[test]
fn too_much_is_refused() {
    let error = |times| cube().subdivided(Subdivision::Midpoint, times).unwrap_err();
    let most = Subdivision::MAX_TRIANGLES;
    assert_eq!(error(11), MeshError::TooFine { count: 12 << 22, times: 11, most });
    assert_eq!(error(u32::MAX), MeshError::TooFine { count: u64::MAX, times: u32::MAX, most });
    assert_eq!(cube().subdivided(Subdivision::Loop, 0), Ok(cube()));
    // Degenerate input passes through.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::X, Vec3::ZERO];
    let mesh = Mesh::new(positions, vec![0, 1, 2, 0, 3, 0, 1, 1, 1]).unwrap();
    for scheme in [Subdivision::Midpoint, Subdivision::Loop] {
        let fine = mesh.subdivided(scheme, 2).unwrap();
        assert_eq!(fine.triangle_count(), 48);
        assert!(fine.normals().iter().all(|n| n.is_normalized()));
    }
    let (mesh, _) = cube().with_normals(Normals::Weighted(NormalWeighting::Max));
    assert!(mesh.subdivided(Subdivision::Loop, 1).is_ok());
}

//! Normals by crease angle, and normals across seams.
#![expect(clippy::float_cmp, reason = "vertices that share a mean share its bits")]

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use halfway_mesh::{Cuboid, Mesh, NormalReport, NormalWeighting, Normals, UvSphere, Weld, face_normal};

fn creased(angle: f32) -> Normals {
    Normals::Creased { angle: angle.to_radians(), weighting: NormalWeighting::Angle }
}

/// A cube of eight vertices.
fn cube() -> Mesh {
    Mesh::from(Cuboid::default()).welded(Weld::positions(0.0)).unwrap().0
}

/// The largest distance between the normals of two vertices at one position.
fn worst_seam(mesh: &Mesh) -> f32 {
    let mut vertices: Vec<usize> = (0..mesh.positions().len()).collect();
    let key = |&i: &usize| mesh.positions()[i].to_array().map(|x| (x + 0.0).to_bits());
    vertices.sort_by_key(key);
    let pairs = vertices.windows(2).filter(|pair| key(&pair[0]) == key(&pair[1]));
    pairs.map(|pair| mesh.normals()[pair[0]].distance(mesh.normals()[pair[1]])).fold(0.0, f32::max)
}

#[test]
fn a_cube_is_creased_below_its_right_angle() {
    for angle in [0.0, 45.0, 89.0] {
        let (mesh, report) = cube().with_normals(creased(angle));
        assert!(report.is_clean());
        // Each side is flat and keeps its four vertices.
        assert_eq!((mesh.positions().len(), mesh.triangle_count()), (24, 12), "{angle}");
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
            let expected = face_normal(a, b, c).unwrap();
            assert!(triangle.iter().all(|&i| mesh.normals()[i as usize].distance(expected) < 1e-6));
        }
    }
    let (smooth, _) = cube().with_normals(creased(91.0));
    assert_eq!(smooth.positions().len(), 8);
    // 0.0: sums run over the same triangles in the same order.
    let (weighted, _) = cube().with_normals(Normals::Weighted(NormalWeighting::Angle));
    for (p, n) in smooth.positions().iter().zip(smooth.normals()) {
        let same = weighted.positions().iter().position(|q| q == p).unwrap();
        assert_eq!(*n, weighted.normals()[same]);
    }
}

#[test]
fn a_nan_angle_creases_every_edge() {
    let (mesh, _) = cube().with_normals(creased(f32::NAN));
    let (flat, _) = cube().with_normals(Normals::Face);
    assert_eq!((mesh.positions(), mesh.normals()), (flat.positions(), flat.normals()));
}

/// A cone about +Y: 32 sides, the apex, and a flat bottom that shares the rim.
fn cone() -> (Vec<Vec3>, Vec<u32>) {
    const SIDES: u32 = 32;
    let mut positions = vec![Vec3::Y * 4.0, Vec3::ZERO];
    positions.extend((0..SIDES).map(|i| {
        let (sin, cos) = (i as f32 / SIDES as f32 * TAU).sin_cos();
        Vec3::new(cos, 0.0, sin)
    }));
    let sides = (0..SIDES).flat_map(|i| {
        let (a, b) = (2 + i, 2 + (i + 1) % SIDES);
        [0, b, a, 1, a, b]
    });
    (positions, sides.collect())
}

#[test]
fn fans_are_walked_rather_than_compared_pairwise() {
    let (positions, indices) = cone();
    let (mesh, report) = Mesh::new(positions, indices).unwrap().with_normals(creased(60.0));
    assert!(report.is_clean());
    // Opposite sides face 152° apart, but neighbours only 11°: the apex stays one vertex, the rim is two.
    assert_eq!(mesh.positions().len(), 2 + 2 * 32);
    for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
        if p.y > 0.0 {
            assert!(n.distance(Vec3::Y) < 1e-6, "{n}");
        } else if *n != Vec3::NEG_Y {
            // The sides' own: perpendicular to the line to the apex, but for the 32 flat sides.
            assert!(n.dot((Vec3::Y * 4.0 - *p).normalize()).abs() < 2e-2, "{p} {n}");
        }
    }
}

#[test]
fn seams_do_not_crease() {
    let sphere = Mesh::from(UvSphere::new(1.0, 24, 12));
    for policy in [creased(60.0), creased(180.0), Normals::Weighted(NormalWeighting::Angle)] {
        let (mesh, report) = sphere.clone().with_normals(policy);
        // The last vertex of the row at each pole has no triangle, which is counted and no matter.
        assert_eq!(report.cancelled + report.degenerate_triangles, 0);
        assert_eq!(worst_seam(&mesh), 0.0, "{policy:?}");
        assert!(mesh.positions().iter().zip(mesh.normals()).all(|(p, n)| n.distance(*p) < 0.02));
    }
    // Faceted, there are seams everywhere.
    assert!(worst_seam(&sphere.with_normals(Normals::Face).0) > 0.1);
}

#[test]
fn a_textured_cube_with_smooth_shading() {
    // Every side has texture coordinates of its own, so that each corner of the cube is three vertices.
    let cuboid = Mesh::from(Cuboid::default());
    assert_eq!(cuboid.positions().len(), 24);
    let (positions, uvs) = (cuboid.positions().to_vec(), cuboid.uvs().map(<[_]>::to_vec));
    let mesh = Mesh::from_parts(positions, None, uvs, cuboid.indices().to_vec()).unwrap();
    for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
        assert!(n.distance(p.normalize()) < 3e-7, "{p} {n}");
    }
    assert_eq!(worst_seam(&mesh), 0.0);
}

#[test]
fn crowded_edges_are_creases() {
    // Pages of a book: triangles around one edge, each 10° from the next.
    let book = |pages: u16, step: f32| {
        let mut positions = vec![Vec3::ZERO, Vec3::Y];
        positions.extend((0..pages).map(|page| {
            let (sin, cos) = (f32::from(page) * step).to_radians().sin_cos();
            Vec3::new(cos, 0.5, sin)
        }));
        let indices = (0..u32::from(pages)).flat_map(|page| [0, 2 + page, 1]).collect();
        Mesh::new(positions, indices).unwrap()
    };
    let corners = |pages, step, angle| book(pages, step).with_normals(creased(angle)).0.positions().len();
    assert_eq!(corners(4, 10.0, 5.0), 12);
    assert_eq!(corners(4, 10.0, 15.0), 6);
    // Too many to look at every pair.
    assert_eq!(corners(40, 1.0, 15.0), 120);
}

#[test]
fn degenerate_triangles_make_no_vertices() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 0.5, Vec3::Z * 9.0];
    let mesh = Mesh::new(positions, vec![0, 3, 2, 3, 1, 2, 0, 1, 3, 0, 0, 1]).unwrap();
    let (mesh, report) = mesh.with_normals(creased(30.0));
    // The vertex of no triangle goes.
    assert_eq!((mesh.positions().len(), mesh.triangle_count()), (4, 4));
    assert_eq!(mesh.normals(), [Vec3::Z; 4]);
    assert_eq!(report, NormalReport { degenerate_triangles: 2, ..NormalReport::default() });
}

#[test]
fn creases_at_any_scale() {
    let (positions, indices) = cone();
    for exponent in (-18..=18).step_by(6) {
        let scale = 10_f32.powi(exponent);
        let scaled = positions.iter().map(|p| *p * scale).collect();
        let (mesh, _) = Mesh::new(scaled, indices.clone()).unwrap().with_normals(creased(60.0));
        assert_eq!(mesh.positions().len(), 66, "1e{exponent}");
        assert!(mesh.normals().iter().all(|n| n.is_normalized()));
    }
    assert!(creased(180.0) == Normals::Creased { angle: PI, weighting: NormalWeighting::Angle });
}

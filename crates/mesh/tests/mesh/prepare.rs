//! Welding, repair, the report and simplification.

use glam::{Vec2, Vec3};
use halfway_mesh::{
    Cuboid, Mesh, MeshError, Plane, RepairReport, SimplifiedMesh, Subdivision, UvSphere, Weld, WeldReport,
};

/// The mesh with every `step`-th triangle turned over.
fn partly_turned(mesh: &Mesh, step: usize) -> Mesh {
    let turned = mesh.triangles().enumerate().map(|(i, [a, b, c])| if i % step == 0 { [a, c, b] } else { [a, b, c] });
    let normals = Some(mesh.normals().to_vec());
    Mesh::from_parts(mesh.positions().to_vec(), normals, None, turned.flatten().collect()).unwrap()
}

/// A band of `count` squares, its end joined to its beginning after `half_turns` half turns.
fn band(count: u32, half_turns: u32) -> Mesh {
    let mut positions = Vec::new();
    for i in 0..count {
        let along = i as f32 / count as f32 * std::f32::consts::TAU;
        let turn = along * half_turns as f32 / 2.0;
        let (out, up) = (Vec3::new(along.cos(), 0.0, along.sin()), Vec3::Y);
        let across = (out * turn.cos() + up * turn.sin()) * 0.3;
        positions.extend([out + across, out - across]);
    }
    let square = |i: u32| {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 < count {
            [a + 2, b + 2]
        } else if half_turns.is_multiple_of(2) {
            [0, 1]
        } else {
            [1, 0]
        };
        [a, b, d, a, d, c]
    };
    Mesh::new(positions, (0..count).flat_map(square).collect()).unwrap()
}

#[test]
fn identical_vertices_become_one() {
    let cuboid = Mesh::from(Cuboid::default());
    let (flat, _) = cuboid.clone().with_normals(halfway_mesh::Normals::Face);
    assert_eq!(flat.positions().len(), 36);
    let (mesh, report) = flat.welded(Weld::default()).unwrap();
    assert_eq!(report, WeldReport { merged_vertices: 12, collapsed_triangles: 0 });
    assert_eq!(mesh.positions().len(), 24);
    // Triangle by triangle what it was.
    for (a, b) in mesh.triangles().zip(flat.triangles()) {
        for (a, b) in a.into_iter().zip(b) {
            let (a, b) = (a as usize, b as usize);
            assert_eq!(mesh.positions()[a], flat.positions()[b]);
            assert_eq!(mesh.normals()[a], flat.normals()[b]);
            assert_eq!(mesh.uvs().unwrap()[a], flat.uvs().unwrap()[b]);
        }
    }
    assert_eq!(cuboid.welded(Weld::default()).unwrap(), (cuboid, WeldReport::default()));
}

#[test]
fn welding_by_position_takes_mean_normals() {
    let (mesh, report) = Mesh::from(Cuboid::default()).welded(Weld::positions(0.0)).unwrap();
    assert_eq!(report.merged_vertices, 16);
    for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
        assert!(n.distance(p.normalize()) < 3e-7);
    }
    assert_eq!(mesh.report().problems.open_edges, 0);
}

#[test]
fn welding_within_a_distance() {
    // A row of points 0.4 apart and a far one: the first takes the second, the third is too far from the first.
    let row = [0.0, 0.4, 0.8, 1.2, 9.0];
    let mut positions: Vec<Vec3> = row.iter().map(|&x| Vec3::new(x, 0.0, 0.0)).collect();
    positions.extend(row.iter().map(|&x| Vec3::new(x, 5.0, 0.0)));
    let indices = vec![0, 4, 5, 1, 4, 6, 2, 4, 7, 3, 4, 8, 0, 1, 9];
    let mesh = Mesh::new(positions, indices).unwrap();
    for scale in [1e-18, 1.0, 1e18] {
        let scaled = mesh.positions().iter().map(|p| *p * scale).collect();
        let mesh = Mesh::new(scaled, mesh.indices().to_vec()).unwrap();
        let (welded, report) = mesh.welded(Weld::positions(0.5 * scale)).unwrap();
        assert_eq!(report, WeldReport { merged_vertices: 4, collapsed_triangles: 1 }, "{scale:e}");
        let x: Vec<f32> = welded.positions()[..3].iter().map(|p| p.x / scale).collect();
        for (found, expected) in x.iter().zip([0.0, 0.8, 9.0]) {
            assert!((found - expected).abs() < 1e-6, "{x:?}");
        }
    }
    let (same, report) = mesh.welded(Weld::positions(f32::NAN)).unwrap();
    assert_eq!((same.positions().len(), report), (10, WeldReport::default()));
}

#[test]
fn attributes_are_compared_after_rounding() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::Y, Vec3::NEG_X];
    let uvs = [0.0, 0.0, 0.0, 0.001, 0.5, 0.0].map(|u| Vec2::new(u, 0.0)).to_vec();
    let mesh = Mesh::from_parts(positions, None, Some(uvs), vec![0, 1, 2, 3, 4, 5]).unwrap();
    let merged = |attributes| mesh.welded(Weld { distance: 0.0, attributes }).unwrap().1.merged_vertices;
    assert_eq!([Some(0.0), Some(0.01), Some(10.0), None].map(merged), [0, 1, 2, 2]);
}

#[test]
fn welding_all_away_is_refused() {
    assert_eq!(Mesh::from(Cuboid::default()).welded(Weld::positions(10.0)), Err(MeshError::NoTriangles));
}

#[test]
fn closed_pieces_are_turned_outward() {
    let sphere = Mesh::from(UvSphere::new(2.0, 16, 8));
    let volume = sphere.report().volume;
    for (name, mesh) in [
        ("some", partly_turned(&sphere, 7)),
        ("half", partly_turned(&sphere, 2)),
        ("all", partly_turned(&sphere, 1)),
        ("none", sphere.clone()),
    ] {
        let (mended, report) = mesh.repaired().unwrap();
        assert_eq!((report.against_normals, report.conflicts), (0, 0), "{name}");
        let after = mended.report();
        assert_eq!(
            (after.closed, after.inward, after.to_turn, after.problems.misoriented_edges),
            (1, 0, 0, 0),
            "{name}"
        );
        assert!((after.volume - volume).abs() < 1e-9 * volume, "{name}");
        for (triangle, was) in mended.triangles().zip(sphere.triangles()) {
            let corners = |mesh: &Mesh, triangle: [u32; 3]| triangle.map(|i| mesh.positions()[i as usize]);
            let [a, b, c] = corners(&mended, triangle);
            let [d, e, f] = corners(&sphere, was);
            assert!([[d, e, f], [e, f, d], [f, d, e]].contains(&[a, b, c]), "{name}");
        }
    }
    assert_eq!(partly_turned(&sphere, 1).report().inward, 1);
    let (_, report) = partly_turned(&sphere, 7).repaired().unwrap();
    assert_eq!(report.turned, sphere.triangle_count().div_ceil(7));
}

#[test]
fn scale_does_not_matter_to_repair() {
    let sphere = Mesh::from(UvSphere::new(1.0, 8, 4));
    for exponent in (-18..=18).step_by(6) {
        let scaled = sphere.positions().iter().map(|p| *p * 10_f32.powi(exponent)).collect();
        let mesh = Mesh::from_parts(scaled, Some(sphere.normals().to_vec()), None, sphere.indices().to_vec()).unwrap();
        let (_, report) = partly_turned(&mesh, 3).repaired().unwrap();
        assert_eq!((report.turned, report.against_normals), (sphere.triangle_count().div_ceil(3), 0), "1e{exponent}");
    }
}

#[test]
fn open_pieces_follow_the_most() {
    let plane = Mesh::from(Plane { divisions: 4, ..Plane::default() });
    let (mended, report) = partly_turned(&plane, 5).repaired().unwrap();
    assert_eq!((report.turned, report.against_normals), (plane.triangle_count().div_ceil(5), 0));
    assert_eq!((mended.report().closed, mended.report().pieces), (0, 1));
}

#[test]
fn a_band_of_one_side_cannot_be_wound_alike() {
    for (half_turns, conflicts) in [(0, 0), (1, 1), (2, 0), (3, 1)] {
        let (_, report) = band(24, half_turns).repaired().unwrap();
        assert_eq!(report.conflicts, conflicts, "{half_turns} half turns");
    }
}

#[test]
fn repair_drops_invisible_triangles() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::X * 0.5];
    let indices = vec![0, 1, 2, 0, 1, 4, 2, 1, 0, 1, 1, 1];
    let (mesh, report) = Mesh::new(positions, indices).unwrap().repaired().unwrap();
    let expected =
        RepairReport { removed_degenerate: 2, removed_duplicate: 1, removed_vertices: 2, ..RepairReport::default() };
    assert_eq!(report, expected);
    assert_eq!((mesh.triangle_count(), mesh.positions().len()), (1, 3));
    let text = "2 degenerate triangles left out, 1 duplicate triangles left out, 2 unused vertices left out";
    assert_eq!(report.to_string(), text);
    assert_eq!(RepairReport::default().to_string(), "nothing");
    let nothing = Mesh::new(vec![Vec3::ZERO; 3], vec![0, 1, 2]).unwrap();
    assert_eq!(nothing.repaired(), Err(MeshError::NoTriangles));
}

#[test]
fn the_report_of_a_cube() {
    let report = Mesh::from(Cuboid::default()).report();
    assert_eq!((report.triangles, report.vertices, report.positions, report.edges), (12, 24, 8, 18));
    assert_eq!((report.pieces, report.closed, report.inward, report.to_turn), (1, 1, 0, 0));
    assert!((report.area - 6.0).abs() < 1e-12 && (report.volume - 1.0).abs() < 1e-12);
    let [shortest, mean, longest] = report.edge_lengths;
    assert_eq!((shortest, longest), (1.0, 2.0_f64.sqrt()));
    assert!((mean - (12.0 + 6.0 * 2.0_f64.sqrt()) / 18.0).abs() < 1e-12);
    let text = report.to_string();
    let first = "shape      12 triangles, 24 vertices at 8 positions, 18 edges";
    assert_eq!(text.lines().next(), Some(first));
    assert_eq!(text.lines().last(), Some("problems   none"));
    assert_eq!(text.lines().count(), 7);
}

#[test]
fn the_report_of_two_pieces() {
    let cube = Mesh::from(Cuboid::default());
    let mut positions = cube.positions().to_vec();
    positions.extend(cube.positions().iter().map(|p| *p * 0.5 + Vec3::X * 9.0));
    let mut indices = cube.indices().to_vec();
    // The second is inside out.
    indices.extend(cube.triangles().flat_map(|[a, b, c]| [a + 24, c + 24, b + 24]));
    let report = Mesh::new(positions, indices).unwrap().report();
    assert_eq!((report.pieces, report.closed, report.inward, report.to_turn), (2, 2, 1, 12));
    assert!((report.volume - 1.125).abs() < 1e-6);
}

#[test]
fn the_distance_between_meshes() {
    let (small, large) = (Mesh::from(UvSphere::new(1.0, 24, 12)), Mesh::from(UvSphere::new(1.5, 24, 12)));
    let unit = Mesh::from(Cuboid::default());
    let moved = |mesh: &Mesh, by: Vec3| {
        let positions = mesh.positions().iter().map(|p| *p + by).collect();
        Mesh::new(positions, mesh.indices().to_vec()).unwrap()
    };
    let square = |half: f32| {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let positions = corners.map(|[x, y]| Vec3::new(x, y, 0.0) * half).to_vec();
        Mesh::new(positions, vec![0, 1, 2, 0, 2, 3]).unwrap()
    };
    let rows = [
        ("itself", small.clone(), small.clone(), 0.0),
        ("beside", moved(&unit, Vec3::X * 3.0), unit.clone(), 3.0),
        // The corners of the larger sphere are half a unit from the corners below them; the planes of the smaller one
        // are lower, but the corners hold.
        ("around", large, small, 0.5),
        ("a corner that sticks out", square(2.0), square(1.0), 2.0_f64.sqrt()),
        ("a part of it", square(1.0), square(2.0), 0.0),
        // Greatest in the middle of the one triangle that spans two walls: no corner shows it.
        ("inside a ditch", bridge(), ditch(), 1.0),
    ];
    for (name, from, to, expected) in rows {
        for tolerance in [0.1, 1e-3] {
            let found = from.distance_to(&to, tolerance);
            assert!(found.most >= expected - 1e-6 && found.least <= expected + 1e-6, "{name}: {found:?}");
            assert!(found.most - found.least <= tolerance * 1.000_001, "{name}: {found:?}");
        }
    }
}

/// Two walls at x = ±1 from z = −3 to 3, tall enough to be nearest to all between them.
fn ditch() -> Mesh {
    let wall = |x: f32| [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[y, z]| Vec3::new(x, y, z));
    Mesh::new([wall(-1.0), wall(1.0)].concat(), (0..6).collect()).unwrap()
}

/// A triangle from one wall to the other.
fn bridge() -> Mesh {
    Mesh::new(vec![Vec3::NEG_X, Vec3::X, Vec3::new(1.0, 0.1, 0.0)], vec![0, 1, 2]).unwrap()
}

#[test]
fn simplifying_at_any_scale_and_to_any_number() {
    let sphere = Mesh::from(UvSphere::new(1.0, 32, 16));
    let reference = sphere.simplified(200, f64::INFINITY);
    for exponent in [-60, 60] {
        // A power of two, so that all is rounded alike: on a sphere much costs the same, and rounding would decide.
        let scale = 2_f32.powi(exponent);
        let scaled = sphere.positions().iter().map(|p| *p * scale).collect();
        let uvs = sphere.uvs().map(<[_]>::to_vec);
        let mesh = Mesh::from_parts(scaled, Some(sphere.normals().to_vec()), uvs, sphere.indices().to_vec()).unwrap();
        let level = mesh.simplified(200, f64::INFINITY);
        assert_eq!(level.mesh.indices(), reference.mesh.indices(), "2^{exponent}");
        let error = level.error / f64::from(scale) / reference.error;
        assert!((error - 1.0).abs() < 1e-3, "2^{exponent}: {error}");
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

#[test]
fn simplified_meshes_are_nearly_optimal() {
    // N equilateral triangles with an area of 4π/N each are off a unit sphere by 8π/(3√3·N) in their middles.
    let sphere = Mesh::from(UvSphere::new(1.0, 128, 64));
    for triangles in [200, 1000, 4000] {
        let SimplifiedMesh { mesh, error } = sphere.simplified(triangles, f64::INFINITY);
        assert!(mesh.triangle_count() <= triangles && mesh.triangle_count() + 2 > triangles);
        let best = 8.0 * std::f64::consts::PI / (27.0_f64.sqrt() * triangles as f64);
        println!("{triangles} triangles: {error} off, {best} at best");
        assert!(error < 5.0 * best, "{triangles} triangles: {error} off, {best} at best");
    }
    // Flat sides and straight edges need nothing, and borders move along themselves only.
    let plane = Mesh::from(Plane { divisions: 40, ..Plane::default() });
    let flat = plane.simplified(0, 0.01);
    assert!(flat.mesh.triangle_count() <= 8 && flat.error <= 0.01, "{} triangles", flat.mesh.triangle_count());
    assert!((flat.mesh.report().area / plane.report().area - 1.0).abs() < 1e-5);
}

#[test]
fn simplified_seams_stay_closed() {
    // A seam along the prime meridian, and creases along the edges of a box.
    let sphere = Mesh::from(UvSphere::new(1.0, 64, 32));
    let boxed = Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 4).unwrap();
    for (name, mesh, triangles) in [("sphere", sphere, 200), ("box", boxed, 12)] {
        let simplified = mesh.simplified(triangles, f64::INFINITY).mesh;
        let report = simplified.report();
        assert_eq!((report.closed, report.problems.open_edges), (1, 0), "{name}");
        assert!(simplified.triangle_count() <= triangles, "{name}: {} triangles", simplified.triangle_count());
        for (n, uv) in simplified.normals().iter().zip(simplified.uvs().unwrap()) {
            let is_kept = mesh.normals().iter().zip(mesh.uvs().unwrap()).any(|vertex| vertex == (n, uv));
            assert!(is_kept, "{name}: a vertex that the mesh has not");
        }
    }
}

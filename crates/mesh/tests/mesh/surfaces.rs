//! Surfaces: counts and orders, closedness, analytic normals.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};
use halfway_mesh::{Cuboid, Mesh, Plane, SurfaceError, Teapot, UvSphere, face_normal};

fn sphere(segments: u32, rings: u32) -> Mesh {
    UvSphere::new(1.0, segments, rings).into()
}

/// Six times the signed volume under the triangles over 6: the volume of a closed mesh that winds outward.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.positions()[i as usize].as_dvec3();
    let parts = mesh.triangles().map(|[a, b, c]| corner(a).dot(corner(b).cross(corner(c))));
    parts.sum::<f64>() / 6.0
}

/// Checks the invariants of every surface: unit normals, on the side from which the triangles wind counter-clockwise;
/// texture coordinates in the image; no degenerate triangle.
fn check(name: &str, mesh: &Mesh) {
    for n in mesh.normals() {
        // Rounded from f64: half a step in each coordinate.
        assert!((n.length() - 1.0).abs() < 2e-7, "{name}: {n}");
    }
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
        let face = face_normal(a, b, c).unwrap_or_else(|| panic!("{name}: {triangle:?} is degenerate"));
        for i in triangle {
            let n = mesh.normals()[i as usize];
            assert!(n.dot(face) > 0.0, "{name}: {triangle:?} {n} {face}");
        }
    }
    let unit = |uv: &Vec2| uv.min_element() >= 0.0 && uv.max_element() <= 1.0;
    assert!(mesh.uvs().unwrap().iter().all(unit), "{name}");
}

#[test]
fn every_surface_keeps_the_invariants() {
    let rows: Vec<(&str, Mesh, usize, usize, usize)> = vec![
        // Vertices, triangles, open edges.
        ("plane 1", Plane::default().into(), 4, 2, 4),
        ("plane 5", Plane { size: 3.0, divisions: 5 }.into(), 36, 50, 20),
        ("cuboid", Cuboid::new(1.0, 2.0, 3.0).into(), 24, 12, 0),
        ("smallest sphere", sphere(3, 2), 12, 6, 0),
        ("octahedron", sphere(4, 2), 15, 8, 0),
        ("sphere of S2", sphere(16, 8), 153, 224, 0),
        ("sphere of S3", UvSphere::new(1.5, 32, 16).into(), 561, 960, 0),
        ("sphere of S4", sphere(64, 32), 2145, 3968, 0),
        ("sphere of S1", sphere(512, 256), 131_841, 261_120, 0),
        // 32 (n + 1)² vertices, 64 n² − 8 n triangles; see `the_teapot_is_open_where_newell_left_it`.
        // Coarser ones have facets at the lip of the spout that face away from the surface's normals.
        ("teapot 8", Teapot::new(8).into(), 2592, 4032, 128),
        ("teapot 11", Teapot::new(11).into(), 4608, 7656, 176),
        ("teapot 20", Teapot::new(20).into(), 14_112, 25_440, 320),
    ];
    for (name, mesh, vertices, triangles, open) in rows {
        check(name, &mesh);
        assert_eq!((mesh.positions().len(), mesh.triangle_count()), (vertices, triangles), "{name}");
        let problems = mesh.report().problems;
        assert_eq!(problems.open_edges, open, "{name}: {problems}");
        assert_eq!((problems.crowded_edges, problems.misoriented_edges), (0, 0), "{name}: {problems}");
        assert_eq!(problems.duplicate_triangles, 0, "{name}: {problems}");
    }
}

#[test]
fn the_plane_is_laid_out_row_by_row() {
    let mesh = Mesh::from(Plane { size: 4.0, divisions: 2 });
    let expected: Vec<Vec3> =
        [-2.0, 0.0, 2.0].iter().flat_map(|&z| [-2.0, 0.0, 2.0].map(|x| Vec3::new(x, 0.0, z))).collect();
    assert_eq!(mesh.positions(), expected);
    assert_eq!(mesh.normals(), [Vec3::Y; 9]);
    assert_eq!(mesh.uvs().unwrap()[5], Vec2::new(1.0, 0.5));
    // Cells (a, c, b), (b, c, d) with a b on one row, c d on the next.
    let cells = [[0, 1, 3, 4], [1, 2, 4, 5], [3, 4, 6, 7], [4, 5, 7, 8]];
    let triangles: Vec<[u32; 3]> = cells.iter().flat_map(|&[a, b, c, d]| [[a, c, b], [b, c, d]]).collect();
    assert_eq!(mesh.triangles().collect::<Vec<_>>(), triangles);
}

#[test]
fn the_sphere_is_laid_out_as_its_formula() {
    let (segments, rings, radius) = (6_u32, 4_u32, 2.5_f32);
    let mesh = Mesh::from(UvSphere::new(radius, segments, rings));
    for j in 0..=rings {
        for i in 0..=segments {
            let theta = std::f64::consts::PI * f64::from(j) / f64::from(rings);
            let phi = std::f64::consts::TAU * f64::from(i) / f64::from(segments);
            let n = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            let vertex = (j * (segments + 1) + i) as usize;
            // Both are rounded to f32 from f64 values that differ by its rounding.
            assert!(mesh.normals()[vertex].distance(n.as_vec3()) < 1.5e-7);
            assert!(mesh.positions()[vertex].distance((n * f64::from(radius)).as_vec3()) < 1.5e-7 * radius);
            let uv = Vec2::new(1.0 - i as f32 / segments as f32, j as f32 / rings as f32);
            assert_eq!(mesh.uvs().unwrap()[vertex], uv);
        }
    }
    let mut expected = Vec::new();
    for j in 0..rings {
        for i in 0..segments {
            let a = j * (segments + 1) + i;
            let (b, c, d) = (a + 1, a + segments + 1, a + segments + 2);
            expected.extend((j > 0).then_some([a, b, d]));
            expected.extend((j < rings - 1).then_some([a, d, c]));
        }
    }
    assert_eq!(mesh.triangles().collect::<Vec<_>>(), expected);
}

#[test]
fn volumes_are_those_of_the_solids() {
    assert!((volume(&Cuboid::new(1.0, 2.0, 3.0).into()) - 6.0).abs() < 1e-6);
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    let errors = [16, 32, 64].map(|segments| 1.0 - volume(&sphere(segments, segments / 2)) / ball);
    // An inscribed polyhedron is smaller; its deficit is of second order, so each is about a quarter of the last.
    assert!(errors[2] > 0.0 && errors[1] < errors[0] / 3.5 && errors[2] < errors[1] / 3.5, "{errors:?}");
}

#[test]
fn textures_are_upright_and_unmirrored_from_outside() {
    // Going right in the image and then up turns counter-clockwise as seen from the front, on every triangle.
    for (name, mesh) in [
        ("plane", Mesh::from(Plane::default())),
        ("cuboid", Cuboid::default().into()),
        ("sphere", sphere(16, 8)),
        ("teapot", Teapot::new(3).into()),
    ] {
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.uvs().unwrap()[i as usize] * Vec2::new(1.0, -1.0));
            assert!((b - a).perp_dot(c - a) > 0.0, "{name}: {triangle:?}");
        }
    }
    let front_of = |mesh: &Mesh, n: Vec3| -> Vec<(Vec3, Vec2)> {
        let all = mesh.positions().iter().zip(mesh.normals()).zip(mesh.uvs().unwrap());
        all.filter(|((_, normal), _)| **normal == n).map(|((p, _), uv)| (*p, *uv)).collect()
    };
    for (p, uv) in front_of(&Cuboid::default().into(), Vec3::Z) {
        assert_eq!((p.x, p.y), (uv.x - 0.5, 0.5 - uv.y));
    }
}

#[test]
fn the_teapot_stands_as_documented() {
    let mesh = Mesh::from(Teapot::default());
    let bounds = mesh.bounds();
    assert_eq!(bounds.min, Vec3::new(-2.25, -1.18125, -1.5));
    assert_eq!((bounds.max.y, bounds.max.z), (1.18125, 1.5));
    // The lip of the spout, whose furthest point lies between control points.
    assert!((bounds.max.x - 2.57).abs() < 0.01, "{bounds:?}");
}

/// The vertices by position.
fn by_position(mesh: &Mesh) -> HashMap<[u32; 3], Vec<usize>> {
    let mut places: HashMap<_, Vec<usize>> = HashMap::new();
    for (i, p) in mesh.positions().iter().enumerate() {
        places.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_default().push(i);
    }
    places
}

#[test]
fn the_teapots_patches_join_smoothly() {
    let mesh = Mesh::from(Teapot::new(8));
    let mut shared = 0;
    for vertices in by_position(&mesh).values() {
        // The foot of the handle touches the body in one point without joining it.
        if mesh.positions()[vertices[0]].abs_diff_eq(Vec3::new(-1.5, -0.50625, 0.0), 1e-6) {
            continue;
        }
        for &i in &vertices[1..] {
            shared += 1;
            let (a, b) = (mesh.normals()[vertices[0]], mesh.normals()[i]);
            // Newell's figures are round to four decimals or fewer; so far are tangents on either side from parallel.
            assert!(a.distance(b) < 5e-3, "{}: {a} {b}", mesh.positions()[i]);
        }
    }
    // 32 patches have 128 edges, of which 16 are open and 8 shrunk to points; the others are shared two by two, and
    // each of the 52 has seven vertices between its ends.
    assert!(shared >= 52 * 7, "{shared}");
}

#[test]
fn the_teapot_is_open_where_newell_left_it() {
    // The loops of open edges by the heights and the radii or places that Newell gave them: the inside of the rim, the
    // edge of the lid, both ends of the spout, both ends of the handle. In his frame: z up, unscaled.
    let n = 4_u32;
    let mesh = Mesh::from(Teapot::new(n));
    let groups = by_position(&mesh);
    let group = |i: u32| groups[&(mesh.positions()[i as usize] + Vec3::ZERO).to_array().map(f32::to_bits)][0];
    let mut passes: HashMap<(usize, usize), usize> = HashMap::new();
    for [a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (group(from), group(to));
            *passes.entry((from.min(to), from.max(to))).or_default() += 1;
        }
    }
    let mut loops: HashMap<&str, u32> = HashMap::new();
    for (&(from, _), _) in passes.iter().filter(|&(_, &count)| count == 1) {
        let p = mesh.positions()[from].as_dvec3() / 0.75;
        let (x, z, radius) = (p.x, p.y + 1.575, p.x.hypot(p.z));
        let near = |a: f64, b: f64| (a - b).abs() < 0.01;
        let name = match () {
            () if near(z, 2.4) && near(radius, 1.4) => "rim",
            () if near(z, 2.4) && near(radius, 1.3) => "lid",
            () if near(x, 1.7) => "spout, foot",
            () if near(z, 2.4) && x > 2.7 => "spout, lip",
            () if x < -1.4 && z > 2.0 => "handle, top",
            () if x < -1.8 && z < 1.0 => "handle, foot",
            () => panic!("open edge at {p}"),
        };
        *loops.entry(name).or_default() += 1;
    }
    let expected = [
        ("rim", 4 * n),
        ("lid", 4 * n),
        ("spout, foot", 2 * n),
        ("spout, lip", 2 * n),
        ("handle, top", 2 * n),
        ("handle, foot", 2 * n),
    ];
    assert_eq!(loops, expected.into());
}

#[test]
fn the_teapots_facets_approach_its_normals() {
    // The mean angle between a triangle and its corners' normals falls in proportion to the edges.
    let mean = |n| {
        let mesh = Mesh::from(Teapot::new(n));
        let mut sum = 0.0;
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
            let face = face_normal(a, b, c).unwrap();
            sum += triangle.iter().map(|&i| mesh.normals()[i as usize].distance(face)).sum::<f32>();
        }
        sum / mesh.triangle_count() as f32
    };
    let means = [4, 8, 16, 32].map(mean);
    assert!(means.windows(2).all(|pair| pair[1] < pair[0] / 1.8), "{means:?}");
}

#[test]
fn fields_out_of_range_are_refused_by_name() {
    let sphere = UvSphere::default();
    let rows: Vec<(Result<(), SurfaceError>, &str)> = vec![
        (Plane { size: f32::NAN, divisions: 1 }.validate(), "Plane.size: NaN; a length from 1e-30 to 1e30 is expected"),
        (Plane { size: 1.0, divisions: 0 }.validate(), "Plane.divisions: 0; a number from 1 to 2048 is expected"),
        (Cuboid::new(1.0, 0.0, 1.0).validate(), "Cuboid.size.y: 0; a length from 1e-30 to 1e30 is expected"),
        (
            UvSphere { radius: -1.0, ..sphere }.validate(),
            "UvSphere.radius: -1; a length from 1e-30 to 1e30 is expected",
        ),
        (
            UvSphere { radius: f32::INFINITY, ..sphere }.validate(),
            "UvSphere.radius: inf; a length from 1e-30 to 1e30 is expected",
        ),
        (UvSphere { segments: 2, ..sphere }.validate(), "UvSphere.segments: 2; a number from 3 to 4096 is expected"),
        (
            UvSphere { rings: 4_000_000_000, ..sphere }.validate(),
            "UvSphere.rings: 4000000000; a number from 2 to 2048 is expected",
        ),
        (Teapot::new(0).validate(), "Teapot.divisions: 0; a number from 1 to 256 is expected"),
        (Teapot::new(u32::MAX).validate(), "Teapot.divisions: 4294967295; a number from 1 to 256 is expected"),
    ];
    for (found, expected) in rows {
        assert_eq!(found.unwrap_err().to_string(), expected);
    }
    for valid in [Plane::default().validate(), Cuboid::default().validate(), sphere.validate()] {
        assert_eq!(valid, Ok(()));
    }
    assert_eq!(Teapot::default().validate(), Ok(()));
}

#[test]
fn fields_out_of_range_make_the_nearest_surface() {
    let nan = f32::NAN;
    assert_eq!(Mesh::from(Plane { size: nan, divisions: 0 }), Plane { size: 1.0, divisions: 1 }.into());
    assert_eq!(Mesh::from(Cuboid::new(nan, -1.0, 2.0)), Cuboid::new(1.0, 1e-30, 2.0).into());
    let largest = Mesh::from(Cuboid::new(f32::INFINITY, 1.0, 1.0));
    assert_eq!(largest, Cuboid::new(1e30, 1.0, 1.0).into());
    assert_eq!(Mesh::from(UvSphere::new(0.0, 0, 0)), UvSphere::new(1e-30, 3, 2).into());
    assert_eq!(Mesh::from(Teapot::new(0)), Teapot::new(1).into());
    // The smallest and the largest keep their promises.
    for (name, mesh) in [
        ("smallest sphere", Mesh::from(UvSphere::new(1e-30, 8, 4))),
        ("largest sphere", UvSphere::new(1e30, 8, 4).into()),
        ("longest cuboid", Cuboid::new(1e30, 1e25, 1e25).into()),
    ] {
        check(name, &mesh);
    }
}

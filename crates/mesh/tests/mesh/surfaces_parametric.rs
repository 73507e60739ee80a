//! Parametric surfaces: partials, normals and gradients against each other, meshes against closed forms.

use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec3};
use halfway_mesh::{
    BezierPatch, Capsule, Cone, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet, Icosphere, Mesh,
    Paraboloid, Parameter, ParametricSurface, Plane, Quadric, SurfacePiece, Teapot, Tessellation, Torus, UvSphere,
    face_normal, tessellate,
};

use crate::surfaces_common::{cubic, scattered};

/// A surface with what is known of it: its name, its area and, where it is closed, its volume; V − E + F.
struct Row {
    name: &'static str,
    surface: Box<dyn ParametricSurface>,
    area: Option<f64>,
    volume: Option<f64>,
    euler: i64,
}

fn row(
    name: &'static str,
    surface: impl ParametricSurface + 'static,
    area: Option<f64>,
    volume: Option<f64>,
    euler: i64,
) -> Row {
    Row { name, surface: Box::new(surface), area, volume, euler }
}

/// π r ∕ (6 h²) ((r² + 4 h²)^(3/2) − r³).
fn paraboloid_area(r: f64, h: f64) -> f64 {
    PI * r / (6.0 * h * h) * ((r * r + 4.0 * h * h).powf(1.5) - r.powi(3))
}

/// 2π ∫ r √(1 + r'²) dy of r = w √(1 + y²/c²) over |y| ≤ h.
fn one_sheet_area(w: f64, radius: f64, h: f64) -> f64 {
    let c = h / ((radius / w).powi(2) - 1.0).sqrt();
    let k = (w * w + c * c).sqrt() / (c * c);
    TAU * w * (h * (1.0 + (k * h).powi(2)).sqrt() + (k * h).asinh() / k)
}

/// 2π ∫ r √(1 + r'²) dy of r = b √(y²/a² − 1) over a ≤ y ≤ a + h.
fn sheet_area(a: f64, radius: f64, h: f64) -> f64 {
    let b = radius / ((1.0 + h / a).powi(2) - 1.0).sqrt();
    let m = (a * a + b * b).sqrt() / (a * a);
    let primitive = |y: f64| 0.5 * y * ((m * y).powi(2) - 1.0).sqrt() - (m * y).acosh() / (2.0 * m);
    TAU * b * (primitive(a + h) - primitive(a))
}

fn bumps() -> HeightField {
    let height = |i: u16, j: u16| 0.3 * (f32::from(i) * 1.3).sin() + 0.2 * (f32::from(j) * 0.9 + 0.4).cos();
    let heights = (0..5).flat_map(|i| (0..7).map(move |j| height(i, j))).collect();
    HeightField::new(3.0, 2.0, 7, heights).unwrap()
}

/// Flat but for u (u − ½) (u − 1) (v − ⅓) (v − ⅔), which is 0 wherever a single cell is looked at.
fn sly() -> BezierPatch {
    let (in_u, in_v) = ([0.0, 0.5, -1.5, 1.0], [2.0 / 9.0, -1.0, 1.0, 0.0]);
    let mut coefficients: Vec<DVec3> = in_u.iter().flat_map(|a| in_v.map(|b| 4.0 * a * b * DVec3::Y)).collect();
    coefficients[4] += DVec3::Z;
    coefficients[1] -= DVec3::X;
    BezierPatch::from_polynomial(4, coefficients).unwrap()
}

fn rows() -> Vec<Row> {
    let (r, h) = (0.75_f64, 2.0_f64);
    let cylinder = |capped| Cylinder { radius: 0.75, height: 2.0, capped };
    let cone = |capped| Cone { radius: 0.75, height: 2.0, capped };
    let side = (r * r + h * h).sqrt();
    let (base, ring) = (PI * r * r, TAU * r);
    let sheet = |upper| HyperboloidSheet { gap: 0.5, radius: 1.0, height: 0.75, upper };
    let ellipsoid_volume = 4.0 / 3.0 * PI * 0.5 * 1.25 * 2.0;
    vec![
        row("plane", Plane { size: 1.5, divisions: 1 }, Some(2.25), None, 1),
        row("sphere", UvSphere::new(1.5, 3, 2), Some(9.0 * PI), Some(4.5 * PI), 2),
        row("ellipsoid", Ellipsoid { radii: Vec3::new(0.5, 1.25, 2.0) }, None, Some(ellipsoid_volume), 2),
        row("pipe", cylinder(false), Some(ring * h), None, 0),
        row("cylinder", cylinder(true), Some(ring * h + 2.0 * base), Some(base * h), 2),
        row("funnel", cone(false), Some(PI * r * side), None, 1),
        row("cone", cone(true), Some(PI * r * side + base), Some(base * h / 3.0), 2),
        row("torus", Torus { radius: 1.5, tube: 0.5 }, Some(PI * PI * 3.0), Some(PI * PI * 0.75), 0),
        row(
            "capsule",
            Capsule { radius: 0.75, length: 2.0 },
            Some(ring * (2.0 * r + h)),
            Some(base * (r / 0.75 + h)),
            2,
        ),
        row(
            "disc",
            Disc::new(DVec3::new(0.5, 1.0, -0.25), DVec3::new(1.0, 2.0, -2.0), 1.5).unwrap(),
            Some(2.25 * PI),
            None,
            1,
        ),
        row("paraboloid", Paraboloid { radius: 0.75, height: 2.0 }, Some(paraboloid_area(r, h)), None, 1),
        row(
            "hyperboloid",
            Hyperboloid { waist: 0.5, radius: 1.0, height: 2.0 },
            Some(one_sheet_area(0.5, 1.0, 1.0)),
            None,
            0,
        ),
        row("lower sheet", sheet(false), Some(sheet_area(0.25, 1.0, 0.75)), None, 1),
        row("upper sheet", sheet(true), Some(sheet_area(0.25, 1.0, 0.75)), None, 1),
        row("height field", bumps(), None, None, 1),
        row("cubic", cubic(), None, None, 1),
        row("sly", sly(), None, None, 1),
    ]
}

#[test]
fn normals_are_the_cross_products_of_the_partials() {
    for Row { name, surface, .. } in rows() {
        surface.validate().unwrap();
        for (u, v) in scattered() {
            let p = surface.at(u.into(), v.into());
            assert!((p.normal.length() - 1.0).abs() < 1e-14, "{name} at {u}, {v}");
            let cross = p.dv.cross(p.du).normalize();
            assert!(p.normal.distance(cross) < 1e-12, "{name} at {u}, {v}: {} {cross}", p.normal);
            assert_eq!(p.uv, DVec2::new(1.0 - v, u), "{name}");
        }
    }
}

#[test]
fn partials_are_the_limits_of_differences() {
    // The error of a central difference is a sixth of the third derivative times the square of the step, here a few
    // dozen times 1e-10, and the rounding of positions over the step.
    let step = 1e-5;
    for Row { name, surface, .. } in rows() {
        for (u, v) in scattered() {
            let (u, v) = (u.clamp(step, 1.0 - step), v.clamp(step, 1.0 - step));
            let at = |u: f64, v: f64| surface.at(u.into(), v.into()).position;
            let p = surface.at(u.into(), v.into());
            let du = (at(u + step, v) - at(u - step, v)) / (2.0 * step);
            let dv = (at(u, v + step) - at(u, v - step)) / (2.0 * step);
            let tolerance = 5e-8;
            assert!(p.du.distance(du) < tolerance, "{name} at {u}, {v}: {} {du}", p.du);
            assert!(p.dv.distance(dv) < tolerance, "{name} at {u}, {v}: {} {dv}", p.dv);
        }
    }
}

/// The quadric among the pieces that `p` lies on.
fn quadric_at(pieces: &[SurfacePiece], p: DVec3) -> Option<&Quadric> {
    let holds = |q: &&Quadric| (p.cmpge(q.min() - 1e-12) & p.cmple(q.max() + 1e-12)).all();
    let quadrics = pieces.iter().filter_map(|piece| if let SurfacePiece::Quadric(q) = piece { Some(q) } else { None });
    quadrics.filter(holds).min_by(|a, b| a.value(p).abs().total_cmp(&b.value(p).abs()))
}

#[test]
fn normals_are_the_gradients_where_a_surface_is_known_by_both() {
    let mut tested = 0;
    for Row { name, surface, .. } in rows() {
        let Some(pieces) = surface.pieces() else { continue };
        for (u, v) in scattered() {
            let p = surface.at(u.into(), v.into());
            let Some(quadric) = quadric_at(&pieces, p.position) else { continue };
            let gradient = quadric.gradient(p.position);
            // The distance from the quadric is f over its slope.
            assert!(quadric.value(p.position).abs() < 1e-14 * gradient.length(), "{name} at {u}, {v}");
            assert!(p.normal.distance(gradient.normalize()) < 1e-12, "{name} at {u}, {v}: {} {gradient}", p.normal);
            tested += 1;
        }
    }
    // Eleven of the surfaces are quadrics.
    assert_eq!(tested, 11 * 199);
    // The torus by its own: (√(x² + z²) − R)² + y² = r².
    let torus = Torus { radius: 1.5, tube: 0.5 };
    for (u, v) in scattered() {
        let p = torus.at(u.into(), v.into());
        let out = p.position.with_y(0.0);
        let gradient = p.position - 1.5 * out.normalize();
        assert!((gradient.length() - 0.5).abs() < 1e-14);
        assert!(p.normal.distance(gradient / 0.5) < 1e-12);
    }
}

#[test]
fn normals_at_poles_are_the_limits() {
    for Row { name, surface, .. } in rows() {
        for (u, inside) in [(0.0, 1e-7), (1.0, 1.0 - 1e-7)] {
            for j in 0..=8 {
                let v = Parameter::fraction(j, 8);
                let (at, near) = (surface.at(u.into(), v), surface.at(inside.into(), v));
                assert!(at.normal.distance(near.normal) < 1e-5, "{name} at {u}, {j}: {} {}", at.normal, near.normal);
            }
        }
    }
}

/// Vertices at equal positions as one.
fn groups(mesh: &Mesh) -> (Vec<usize>, usize) {
    let mut seen = HashMap::new();
    let groups = mesh.positions().iter().map(|p| {
        let next = seen.len();
        *seen.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
    });
    let groups = groups.collect();
    (groups, seen.len())
}

fn euler_characteristic(mesh: &Mesh) -> i64 {
    let (groups, vertices) = groups(mesh);
    let mut edges = HashSet::new();
    for [a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (groups[from as usize], groups[to as usize]);
            edges.insert((from.min(to), from.max(to)));
        }
    }
    vertices as i64 - edges.len() as i64 + mesh.triangle_count() as i64
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    mesh.triangles().map(|triangle| triangle.map(|i| mesh.positions()[i as usize].as_dvec3()))
}

fn area(mesh: &Mesh) -> f64 {
    corners(mesh).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

fn volume(mesh: &Mesh) -> f64 {
    corners(mesh).map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
}

fn by_count(surface: &dyn ParametricSurface, n: u32) -> Mesh {
    tessellate(&[surface], Tessellation::Count { rows: n, columns: 2 * n }).unwrap()
}

#[test]
fn meshes_are_closed_where_the_surface_is_and_wind_outward() {
    for Row { name, surface, volume: solid, euler, .. } in rows() {
        for n in [4, 8, 13] {
            let mesh = by_count(&*surface, n);
            assert_eq!(euler_characteristic(&mesh), euler, "{name}");
            let problems = mesh.report().problems;
            let found = (problems.degenerate_triangles, problems.crowded_edges, problems.misoriented_edges);
            assert_eq!(found, (0, 0, 0), "{name}: {problems}");
            assert_eq!(problems.duplicate_triangles, 0, "{name}: {problems}");
            let closed = solid.is_some() || name == "torus";
            assert_eq!(problems.open_edges == 0, closed, "{name}: {problems}");
            for triangle in mesh.triangles() {
                let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
                let face = face_normal(a, b, c).unwrap();
                assert!(triangle.iter().all(|&i| mesh.normals()[i as usize].dot(face) > 0.0), "{name}: {triangle:?}");
                // Right in the image and then up turns counter-clockwise as seen from the front.
                let [a, b, c] = triangle.map(|i| mesh.uvs().unwrap()[i as usize]);
                assert!((b - a).perp_dot(c - a) < 0.0, "{name}: {triangle:?}");
            }
        }
    }
}

#[test]
fn areas_and_volumes_converge_to_those_of_the_surfaces() {
    for Row { name, surface, area: exact_area, volume: exact_volume, .. } in rows() {
        let meshes = [12, 24, 48].map(|n| by_count(&*surface, n));
        for (what, exact, found) in
            [("area", exact_area, meshes.each_ref().map(area)), ("volume", exact_volume, meshes.each_ref().map(volume))]
        {
            let Some(exact) = exact else { continue };
            let errors = found.map(|found| (found / exact - 1.0).abs());
            // Of second order: each about a quarter of the last, down to the rounding of positions to f32.
            assert!(errors[2] < 4e-3, "{name}, {what}: {errors:?}");
            assert!(errors.windows(2).all(|pair| pair[1] < (pair[0] / 3.5).max(1e-6)), "{name}, {what}: {errors:?}");
        }
    }
}

/// The distance from a point to a triangle.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let n = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| n.cross(to - from).dot(p - from) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return (p - a).dot(n.normalize()).abs();
    }
    let to_edge = |from: DVec3, to: DVec3| {
        let t = ((p - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        p.distance(from + t * (to - from))
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

#[test]
fn the_chord_error_is_kept_and_used() {
    for Row { name, surface, .. } in rows() {
        for error in [3e-2, 8e-3] {
            let mesh = tessellate(&[&*surface], Tessellation::ChordError(error)).unwrap();
            let triangles: Vec<_> = corners(&mesh).collect();
            let from_mesh = |p: DVec3| triangles.iter().map(|&t| distance(p, t)).fold(f64::INFINITY, f64::min);
            let points = scattered().take(80).map(|(u, v)| surface.at(u.into(), v.into()).position);
            let worst = points.map(from_mesh).fold(0.0, f64::max);
            assert!(worst <= error, "{name}: {worst} of {error} with {} triangles", triangles.len());
            // Flat ones need no more than their border does.
            assert!(worst >= 0.2 * error || ["plane", "disc"].contains(&name), "{name}: {worst} of {error}");
            assert!(triangles.len() < 12_000, "{name}: {}", triangles.len());
        }
    }
    assert_eq!(Plane::default().mesh(Tessellation::ChordError(1e-9)).unwrap().triangle_count(), 2);
    // The border of a disc, r (1 − cos(π/n)) from its chords.
    let disc = Disc::new(DVec3::ZERO, DVec3::Y, 1.0).unwrap().mesh(Tessellation::ChordError(1e-3)).unwrap();
    let n = f64::from(disc.triangle_count() as u32);
    assert!(1.0 - (PI / n).cos() <= 1e-3 && 1.0 - (PI / (0.9 * n)).cos() > 0.95e-3, "{n}");
}

#[test]
fn teapots_and_icospheres_by_chord_error() {
    for error in [1e-2, 1e-3] {
        let sphere = Icosphere::for_chord_error(2.0, error);
        let deepest = |divisions| {
            let mesh = Mesh::from(Icosphere::new(2.0, divisions));
            corners(&mesh).map(|[a, b, c]| 2.0 - (b - a).cross(c - a).normalize().dot(a)).fold(0.0, f64::max)
        };
        // Positions in f32 are off by 1e-7.
        assert!(deepest(sphere.divisions) <= error + 2e-7, "{sphere:?}");
        assert!(deepest(sphere.divisions - 1) > error - 2e-7, "{sphere:?}");
    }
    let teapots = [1e-2, 2.5e-3].map(|error| Teapot::for_chord_error(error).divisions);
    // Half the edges for a quarter of the error.
    assert!(teapots[0] >= 4 && (1.7..2.3).contains(&(f64::from(teapots[1]) / f64::from(teapots[0]))), "{teapots:?}");
    assert_eq!(Icosphere::for_chord_error(1.0, f64::NAN).divisions, Icosphere::MAX_DIVISIONS);
}

#[test]
fn the_icosphere_is_closed_and_even() {
    for divisions in [1, 2, 3, 8, 20] {
        let mesh = Mesh::from(Icosphere::new(1.5, divisions));
        let n = divisions as usize;
        assert_eq!((mesh.positions().len(), mesh.triangle_count()), (10 * n * n + 2, 20 * n * n));
        assert_eq!(euler_characteristic(&mesh), 2);
        assert!(mesh.report().problems.is_none(), "{}", mesh.report().problems);
        for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
            // Both rounded to f32.
            assert!(p.distance(1.5 * n) < 3e-7);
        }
        let areas: Vec<f64> = corners(&mesh).map(|[a, b, c]| (b - a).cross(c - a).length()).collect();
        let (least, most) = areas.iter().fold((f64::MAX, 0.0_f64), |(l, m), &a| (l.min(a), m.max(a)));
        // In the middle of a face the plane is nearer to the sphere than at a corner: by 1 / 0.795 … cubed at most.
        assert!(most / least < 2.0, "{divisions}: {least} … {most}");
        assert!(volume(&mesh) > 0.0);
    }
    let errors = [4, 8, 16].map(|n| 1.0 - volume(&Mesh::from(Icosphere::new(1.0, n))) / (4.0 / 3.0 * PI));
    assert!(errors[2] > 0.0 && errors.windows(2).all(|pair| pair[1] < pair[0] / 3.5), "{errors:?}");
}

#[test]
fn caps_close_at_bit_equal_rims() {
    let mesh = by_count(&Cylinder { radius: 0.7, height: 1.3, capped: true }, 7);
    // 14 columns: two rims of as many points, their rows in between, and two middles.
    assert_eq!(groups(&mesh).1, 14 * 8 + 2);
    assert_eq!(mesh.report().problems.open_edges, 0);
    // Both sheets of a hyperboloid as one mesh.
    let sheet = |upper| HyperboloidSheet { gap: 1.0, radius: 1.0, height: 1.0, upper };
    let both = tessellate(&[&sheet(false), &sheet(true)], Tessellation::Count { rows: 4, columns: 12 }).unwrap();
    assert_eq!(both.surface().unwrap().pieces().len(), 2);
    assert_eq!((both.bounds().min.y, both.bounds().max.y), (-1.5, 1.5));
}

#[test]
fn a_mesh_knows_its_surface() {
    for Row { name, surface, .. } in rows() {
        let mesh = by_count(&*surface, 4);
        assert_eq!(mesh.surface().is_none(), ["plane", "torus"].contains(&name), "{name}");
        let (weighted, _) = mesh.clone().with_normals(halfway_mesh::Normals::Face);
        assert_eq!(weighted.surface(), mesh.surface(), "{name}");
    }
}

#[test]
fn extreme_sizes_and_ratios_keep_the_invariants() {
    // Where there is room in the range of lengths, one is as much longer as it may be.
    for (scale, factor) in [(1e-30_f32, 1.0), (1e-15, 1e5), (1.0, 1e5), (1e15, 1e5), (5e29, 1.0)] {
        let long = scale * factor;
        let heights = [0.0, 0.1, 0.05, 0.02].map(|y| y * scale).to_vec();
        let surfaces: [&dyn ParametricSurface; 10] = [
            &Ellipsoid { radii: Vec3::new(scale, long, scale) },
            &Cylinder { radius: long, height: scale, capped: true },
            &Cone { radius: scale, height: long, capped: true },
            &Torus { radius: (0.5 * long).max(2.0 * scale), tube: scale },
            &Capsule { radius: scale, length: long },
            &Disc::new(DVec3::ZERO, DVec3::Y, f64::from(long)).unwrap(),
            &Paraboloid { radius: long, height: scale },
            &Hyperboloid { waist: scale, radius: 2.0 * scale, height: long },
            &HyperboloidSheet { gap: scale, radius: scale, height: long, upper: true },
            &HeightField::new(scale, long, 2, heights).unwrap(),
        ];
        for (i, surface) in surfaces.iter().enumerate() {
            surface.validate().unwrap_or_else(|error| panic!("{scale}: {error}"));
            let mesh = by_count(*surface, 6);
            assert_eq!(mesh.report().problems.degenerate_triangles, 0, "{i} at {scale}");
            assert!(mesh.positions().iter().all(|p| p.is_finite()), "{i} at {scale}");
            assert!(mesh.normals().iter().all(|n| (n.length() - 1.0).abs() < 2e-7), "{i} at {scale}");
            assert!(mesh.bounds().radius() >= scale * 0.5 && mesh.triangle_count() > 60, "{i} at {scale}");
        }
    }
}

#[test]
fn invalid_fields_are_refused_by_name() {
    let count = |rows, columns| Tessellation::Count { rows, columns };
    let torus = Torus { radius: 1.0, tube: 0.25 };
    let nan = f64::NAN;
    let points = |n: usize| vec![DVec3::ZERO; n];
    let rows = [
        (Torus { tube: -1.0, ..torus }.validate(), "Torus.tube: -1; a length from 1e-30 to 1e30 is expected"),
        (Torus { tube: 1.0, ..torus }.validate(), "Torus.tube: 1; less than the radius, 1, is expected"),
        (
            Cone { radius: 1.0, height: 1e6, capped: true }.validate(),
            "Cone.height: 1000000; at most 100000 times the shortest length, 1, is expected",
        ),
        (
            Hyperboloid { waist: 2.0, radius: 1.0, height: 1.0 }.validate(),
            "Hyperboloid.radius: 1; more than the waist, 2, is expected",
        ),
        (
            Ellipsoid { radii: Vec3::new(1.0, f32::NAN, 1.0) }.validate(),
            "Ellipsoid.radii.y: NaN; a length from 1e-30 to 1e30 is expected",
        ),
        (Icosphere::new(1.0, 0).validate(), "Icosphere.divisions: 0; a number from 1 to 512 is expected"),
        (torus.mesh(count(2, 8)).map(drop), "Tessellation.rows: 2; a number from 3 to 2048 is expected"),
        (torus.mesh(count(8, 5000)).map(drop), "Tessellation.columns: 5000; a number from 3 to 4096 is expected"),
        (
            torus.mesh(Tessellation::ChordError(nan)).map(drop),
            "Tessellation.chord error: NaN; a positive length is expected",
        ),
        (BezierPatch::new(1, points(4)).map(drop), "BezierPatch.columns: 1; a number from 2 to 33 is expected"),
        (BezierPatch::new(4, points(7)).map(drop), "BezierPatch.points: 7; 2 to 33 full rows of 4 points are expected"),
        (
            BezierPatch::new(2, vec![DVec3::splat(nan); 4]).map(drop),
            "BezierPatch.points: NaN; coordinates from -1e30 to 1e30 are expected",
        ),
        (
            tessellate(&[&torus as &dyn ParametricSurface; 100], count(2048, 4096)).map(drop),
            "Tessellation.cells: 838860800; at most 715827882 of all surfaces are expected",
        ),
        (
            BezierPatch::new(2, points(4)).unwrap().mesh(count(2, 2)).map(drop),
            "Tessellation.triangles: 0; a surface with an area is expected",
        ),
        (
            HeightField::new(1.0, 1.0, 3, vec![0.0; 7]).map(drop),
            "HeightField.heights: 7; 2 to 2049 full rows of 3 heights are expected",
        ),
        (
            HeightField::new(1.0, 1.0, 2, vec![0.0, 0.0, f32::INFINITY, 0.0]).map(drop),
            "HeightField.heights: inf; heights from -1e29 to 1e29 are expected",
        ),
        (Disc::new(DVec3::ZERO, DVec3::ZERO, 1.0).map(drop), "Disc.normal: 0; a direction is expected"),
        (
            Quadric::new(glam::DMat4::IDENTITY, DVec3::ONE, DVec3::ZERO).map(drop),
            "Quadric.min: 1; at most the max is expected",
        ),
    ];
    for (found, expected) in rows {
        assert_eq!(found.unwrap_err().to_string(), expected);
    }
}

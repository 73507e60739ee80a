//! Rays against closed forms, against the patches themselves, and against meshes.

use bevy_math::{DVec3, Vec3};
use fastrand::Rng;
use halfway_mesh::{
    BezierPatch, Capsule, Cone, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet, Mesh,
    Paraboloid, Parameter, ParametricSurface, Surface, SurfacePiece, Teapot, Tessellation, UvSphere, tessellate,
};

use super::{SurfaceHit, Traced};

/// In the cube from −1 to 1.
fn vector(random: &mut Rng) -> DVec3 {
    let mut next = || 2.0 * random.f64() - 1.0;
    DVec3::new(next(), next(), next())
}

fn direction(random: &mut Rng) -> DVec3 {
    loop {
        let v = vector(random);
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

fn all_hits(traced: &Traced, origin: DVec3, direction: DVec3) -> Vec<SurfaceHit> {
    let mut hits = Vec::new();
    for piece in 0..traced.pieces() {
        traced.meet(piece, origin, direction, &mut hits);
    }
    traced.settle(direction, &mut hits);
    hits
}

fn traced(mesh: &Mesh) -> Traced {
    Traced::new(mesh.surface().expect("known by formula"))
}

fn sphere(radius: f32) -> Traced {
    traced(&UvSphere::new(radius, 8, 4).into())
}

fn solid(surface: &dyn ParametricSurface) -> Traced {
    traced(&tessellate(&[surface], Tessellation::Count { rows: 3, columns: 3 }).unwrap())
}

#[test]
fn a_sphere_is_hit_as_its_closed_form_says() {
    let mut random = Rng::with_seed(1);
    let mut met = 0;
    for radius in [1e-30_f32, 1e-3, 1.0, 7.5, 1e30] {
        let sphere = sphere(radius);
        let r = f64::from(radius);
        for _ in 0..2000 {
            let origin = 3.0 * r * vector(&mut random);
            let aimed = 1.1 * r * vector(&mut random) - origin;
            let direction = aimed / r * (0.1 + random.f64());
            let d = direction.normalize();
            // The chord lies around the point next to the centre.
            let along = -origin.dot(d);
            let nearest = (origin + along * d).length();
            let half = (r * r - nearest * nearest).max(0.0).sqrt();
            let mut expected = vec![];
            if nearest < r {
                expected.extend([along - half, along + half].into_iter().filter(|t| *t > 0.0));
            }
            let hits = all_hits(&sphere, origin, direction);
            assert_eq!(hits.len(), expected.len());
            met += hits.len();
            for (hit, t) in hits.iter().zip(expected) {
                // The formula above loses digits where it grazes; the points below do not.
                let tolerance = 1e-13 * r * r / half;
                assert!((hit.t * direction.length() - t).abs() <= tolerance.max(1e-13 * r), "{hit:?} {t}");
                assert!((hit.position.length() / r - 1.0).abs() < 1e-14, "{hit:?}");
                assert!(hit.normal.distance(hit.position / r) < 1e-14, "{hit:?}");
            }
        }
    }
    assert!(met > 5000, "{met}");
}

#[test]
fn a_distant_sphere_is_hit_as_a_near_one() {
    // Origins that are exactly 2²³ directions away from the target, since none of their digits is lost.
    let mut random = Rng::with_seed(2);
    let sphere = sphere(1.0);
    for _ in 0..500 {
        let rounded = |v: DVec3, to: f64| (v / to).round() * to;
        let (target, d) =
            (rounded(0.5 * vector(&mut random), 2.0_f64.powi(-20)), rounded(direction(&mut random), 1.0 / 1024.0));
        let far = f64::from(1 << 23);
        let hits = all_hits(&sphere, target - far * d, d);
        // From close by: (target + t d)² = 1.
        let (a, b, c) = (d.length_squared(), target.dot(d), target.length_squared() - 1.0);
        let root = (b * b - a * c).sqrt();
        assert_eq!(hits.len(), 2);
        for (hit, t) in hits.iter().zip([(-b - root) / a, (-b + root) / a]) {
            assert!(hit.position.distance(target + t * d) < 1e-14, "{hit:?}");
            // One rounding of a number of this size.
            assert!((hit.t - far - t).abs() <= far * f64::EPSILON);
        }
    }
}

#[test]
fn grazing_rays_hit_a_sphere_twice_or_never() {
    let sphere = sphere(1.0);
    for below in [1e-3, 1e-6, 1e-9, 1e-12] {
        let hits = all_hits(&sphere, DVec3::new(-4.0, 1.0 - below, 0.0), DVec3::X);
        let half = (2.0 * below - below * below).sqrt();
        let [first, second] = hits[..] else { panic!("{hits:?}") };
        // The height is rounded to 2⁻⁵³, which moves the ends of the chord by that over their slope.
        let tolerance = f64::EPSILON / half;
        assert!((first.position.x + half).abs() < tolerance && (second.position.x - half).abs() < tolerance);
        assert!(first.normal.x < 0.0 && second.normal.x > 0.0);
        assert_eq!(all_hits(&sphere, DVec3::new(-4.0, 1.0 + below, 0.0), DVec3::X), []);
    }
    assert_eq!(all_hits(&sphere, DVec3::new(4.0, 0.0, 0.0), DVec3::X), [], "behind the ray");
}

/// Checks that fronts and backs alternate on every ray from outside.
fn check_closed(name: &str, solid: &Traced, target: DVec3, direction: DVec3) -> usize {
    let hits = all_hits(solid, target - 10.0 * direction, direction);
    assert!(hits.len().is_multiple_of(2), "{name}: {hits:?}");
    for (i, hit) in hits.iter().enumerate() {
        assert!((hit.normal.dot(direction) < 0.0) == i.is_multiple_of(2), "{name}: {hits:?}");
        assert!((hit.normal.length() - 1.0).abs() < 1e-14, "{name}: {hits:?}");
    }
    hits.len()
}

#[test]
fn solids_are_closed() {
    let mut random = Rng::with_seed(3);
    // Each reaches from y = −1 to 1, or beyond, with the radius 1 at y = −1.
    let cylinder = solid(&Cylinder { radius: 1.0, height: 2.0, capped: true });
    let cone = solid(&Cone { radius: 1.0, height: 2.0, capped: true });
    let capsule = solid(&Capsule { radius: 1.0, length: 2.0 });
    for (name, solid) in [("cylinder", &cylinder), ("cone", &cone), ("capsule", &capsule)] {
        let mut met = 0;
        for _ in 0..3000 {
            met += check_closed(name, solid, 1.5 * vector(&mut random), direction(&mut random));
        }
        assert!(met > 1000, "{name}: {met}");
        for direction in [DVec3::X, DVec3::Y, DVec3::Z] {
            check_closed(name, solid, -0.5 * DVec3::Y, direction);
        }
        // Inward through points of the rims, on which two pieces meet.
        for i in 0..64 {
            let (sin, cos) = (f64::from(i) / 64.0 * std::f64::consts::TAU).sin_cos();
            for y in if name == "cone" { &[-1.0][..] } else { &[1.0, -1.0] } {
                let rim = DVec3::new(cos, *y, sin);
                let met = check_closed(name, solid, rim, (-0.5 * DVec3::Y - rim).normalize());
                assert!(met > 0, "{name}: {rim}");
            }
        }
    }
    let down = all_hits(&cone, 2.0 * DVec3::Y, DVec3::NEG_Y);
    let [tip, base] = down[..] else { panic!("{down:?}") };
    assert_eq!((tip.position, tip.normal), (DVec3::Y, DVec3::Y));
    assert_eq!((base.position, base.normal), (DVec3::NEG_Y, DVec3::NEG_Y));
}

#[test]
fn rays_find_the_points_of_every_surface() {
    let heights = (0..20).map(|i| (f64::from(i) * 1.3).sin() as f32).collect();
    let sheet = HyperboloidSheet { gap: 0.5, radius: 1.0, height: 0.75, upper: true };
    let surfaces: [(&str, &dyn ParametricSurface); 9] = [
        ("ellipsoid", &Ellipsoid { radii: Vec3::new(0.5, 1.25, 2.0) }),
        ("cylinder", &Cylinder { radius: 0.75, height: 2.0, capped: false }),
        ("cone", &Cone { radius: 0.75, height: 2.0, capped: false }),
        ("capsule", &Capsule { radius: 0.75, length: 2.0 }),
        ("disc", &Disc::new(DVec3::new(0.5, 1.0, -0.25), DVec3::new(1.0, 2.0, -2.0), 1.5).unwrap()),
        ("paraboloid", &Paraboloid { radius: 0.75, height: 2.0 }),
        ("hyperboloid", &Hyperboloid { waist: 0.5, radius: 1.0, height: 2.0 }),
        ("sheet", &sheet),
        ("height field", &HeightField::new(3.0, 2.0, 5, heights).unwrap()),
    ];
    let mut random = Rng::with_seed(6);
    for (name, surface) in surfaces {
        let traced = Boxed::new(Traced::new(&Surface::new(surface.pieces().unwrap())));
        for _ in 0..300 {
            let (u, v) = (random.f64(), random.f64());
            let p = surface.at(u.into(), v.into());
            let direction = direction(&mut random);
            let slope = direction.dot(p.normal).abs();
            if slope < 0.01 {
                continue;
            }
            let hits = traced.hits_at(p.position, direction);
            let near: Vec<_> = hits.iter().filter(|hit| hit.position.distance(p.position) < 1e-13 / slope).collect();
            let [hit] = near[..] else { panic!("{name} at {u}, {v}: {hits:?}") };
            assert!(hit.normal.distance(p.normal) < 1e-11 / slope, "{name} at {u}, {v}: {hit:?} {}", p.normal);
        }
    }
}

fn patches(surface: &Surface) -> impl Iterator<Item = &BezierPatch> {
    surface.pieces().iter().filter_map(|piece| match piece {
        SurfacePiece::Patch(patch) => Some(patch),
        _ => None,
    })
}

/// A surface with the boxes around its pieces, so that thousands of rays do not test every piece.
struct Boxed {
    traced: Traced,
    boxes: Vec<(DVec3, DVec3)>,
}

impl Boxed {
    fn new(traced: Traced) -> Self {
        let around = |points: &[DVec3]| {
            let min = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            (min, points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max))
        };
        let boxes = (0..traced.pieces()).map(|piece| around(traced.hull(piece))).collect();
        Self { traced, boxes }
    }

    /// The hits near `target`, of a ray that begins half a unit before it.
    fn hits_at(&self, target: DVec3, direction: DVec3) -> Vec<SurfaceHit> {
        const NEAR: f64 = 1e-6;
        let mut hits = Vec::new();
        for (piece, (min, max)) in self.boxes.iter().enumerate() {
            if (target.cmpge(*min - NEAR) & target.cmple(*max + NEAR)).all() {
                self.traced.meet(piece, target - 0.5 * direction, direction, &mut hits);
            }
        }
        self.traced.settle(direction, &mut hits);
        hits.retain(|hit| hit.position.distance(target) < NEAR);
        hits
    }
}

#[test]
fn the_teapots_pieces_contain_it() {
    let teapot = traced(&Teapot::new(1).into());
    assert!((1000..8000).contains(&teapot.pieces()), "{}", teapot.pieces());
    for piece in 0..teapot.pieces() {
        let hull = teapot.hull(piece);
        let middle = hull.iter().sum::<DVec3>() / hull.len() as f64;
        let reach = hull.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
        assert!(reach < 0.3, "{piece}: {reach}");
    }
}

#[test]
fn rays_find_the_points_of_the_teapots_patches() {
    let mesh = Mesh::from(Teapot::new(1));
    let teapot = Boxed::new(traced(&mesh));
    let mut random = Rng::with_seed(4);
    for (number, patch) in patches(mesh.surface().unwrap()).enumerate() {
        for i in 0..240 {
            // Inside, on the edges of pieces, on the edges of patches and at their points.
            let mut pick = |on_edge: bool| if on_edge { (16.0 * random.f64()).round() / 16.0 } else { random.f64() };
            let (u, v) = (pick(i % 2 == 0), pick(i % 3 == 0));
            let (u, v): (Parameter, Parameter) = (u.into(), v.into());
            let (p, n) = (patch.position(u, v), patch.normal(u, v).unwrap());
            let direction = loop {
                let direction = direction(&mut random);
                if direction.dot(n).abs() > 0.1 {
                    break direction;
                }
            };
            let hits = teapot.hits_at(p, direction);
            let near: Vec<_> = hits.iter().filter(|hit| hit.position.distance(p) < 1e-10).collect();
            // Two at most: where handle and spout pass through the body.
            assert!((1..=2).contains(&near.len()), "patch {number} at {u:?} {v:?}: {hits:?}");
            // Newell's tangents on either side of an edge are as far from parallel.
            assert!(
                near.iter().any(|hit| hit.normal.distance(n) < 5e-3),
                "patch {number} at {u:?} {v:?}: {near:?} {n}"
            );
        }
    }
}

#[test]
fn the_vertices_of_a_teapot_lie_on_its_surface() {
    let mesh = Mesh::from(Teapot::new(12));
    let teapot = Boxed::new(traced(&mesh));
    let vertices = mesh.positions().iter().zip(mesh.normals()).zip(mesh.uvs().unwrap());
    // Rounding moves those on edges off the surface, where it is open.
    let inside = vertices.filter(|(_, uv)| uv.min_element() > 0.0 && uv.max_element() < 1.0);
    for ((p, n), _) in inside.step_by(2) {
        let (p, n) = (p.as_dvec3(), n.as_dvec3());
        for direction in [n, -n] {
            // Vertex and normal are rounded to f32, and at the lip of the spout the surface bends on a hundredth.
            let hits = teapot.hits_at(p, direction);
            assert!(hits.iter().any(|hit| hit.position.distance(p) < 5e-7), "{p}: {hits:?}");
            assert!(hits.iter().any(|hit| hit.normal.distance(n) < 2e-5), "{p}: {hits:?} {n}");
        }
    }
}

#[test]
fn rays_hit_the_teapot_where_they_hit_a_fine_mesh() {
    let mesh = Mesh::from(Teapot::new(24));
    let teapot = traced(&mesh);
    let mut random = Rng::with_seed(5);
    let (mut by_mesh, mut by_surface) = (0, 0);
    for _ in 0..120 {
        let (origin, direction) = (4.0 * direction(&mut random), direction(&mut random));
        let target = 1.2 * vector(&mut random);
        let direction = if random.f64() < 0.5 { (target - origin).normalize() } else { direction };
        let hits = all_hits(&teapot, origin, direction);
        let facets: Vec<(f64, f64)> = mesh
            .triangles()
            .filter_map(|triangle| {
                meet_triangle(triangle.map(|i| mesh.positions()[i as usize].as_dvec3()), origin, direction)
            })
            .collect();
        // Facets of 1/24 of a patch lie within a thousandth of the surface; along a ray that meets it at a slope that
        // is so much more. Rays that graze either may miss the other.
        let agree = |t: f64, other: f64, slope: f64| (t - other).abs() < 4e-3 / slope;
        for hit in &hits {
            let slope = hit.normal.dot(direction).abs();
            let found = facets.iter().any(|&(t, _)| agree(hit.t, t, slope));
            assert!(found || slope < 0.25, "{origin} {direction}: {hit:?} {facets:?}");
            by_surface += usize::from(found);
        }
        for &(t, slope) in &facets {
            let found = hits.iter().any(|hit| agree(hit.t, t, slope));
            assert!(found || slope < 0.25, "{origin} {direction}: {t} {hits:?}");
            by_mesh += usize::from(found);
        }
    }
    assert!(by_mesh > 100 && by_surface > 100, "{by_mesh} {by_surface}");
}

/// t and the cosine to the normal where the ray meets the triangle (T. Möller and B. Trumbore, "Fast, Minimum Storage
/// Ray/Triangle Intersection", 1997).
fn meet_triangle([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (e1, e2, from_a) = (b - a, c - a, origin - a);
    let cross = direction.cross(e2);
    let det = e1.dot(cross);
    let u = from_a.dot(cross) / det;
    let q = from_a.cross(e1);
    let (v, t) = (direction.dot(q) / det, e2.dot(q) / det);
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0;
    inside.then(|| (t, e1.cross(e2).normalize().dot(direction).abs()))
}

#[test]
fn rays_through_degenerate_rows_are_not_lost() {
    // The top of the knob, and the middle of the bottom; exactly and a hair beside.
    let teapot = traced(&Teapot::new(1).into());
    for beside in [0.0, 1e-13, 1e-11, 1e-9, 1e-6] {
        for (sin, cos) in [(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), (-0.28, 0.96)] {
            let origin = DVec3::new(beside * cos, 4.0, beside * sin);
            let hits = all_hits(&teapot, origin, DVec3::NEG_Y);
            let (first, last) = (hits[0], hits[hits.len() - 1]);
            assert!((first.position.y - 1.18125).abs() < 1e-9 && first.normal.distance(DVec3::Y) < 1e-4, "{hits:?}");
            assert!((last.position.y + 1.18125).abs() < 1e-9 && last.normal.distance(DVec3::NEG_Y) < 1e-4, "{hits:?}");
            // Knob or lid twice, bottom once.
            assert!((2..=4).contains(&hits.len()), "{hits:?}");
        }
    }
}

#[test]
fn rays_find_points_of_patches_of_any_degree() {
    // Random control points make folds, cusps and sheets that pass through each other.
    let mut random = Rng::with_seed(7);
    for (rows, columns) in [(2, 2), (3, 3), (4, 4), (5, 7), (8, 3)] {
        for _ in 0..6 {
            let points = (0..rows * columns).map(|_| vector(&mut random)).collect();
            let patch = BezierPatch::new(columns, points).unwrap();
            let traced = Boxed::new(Traced::new(&Surface::new([SurfacePiece::Patch(patch.clone())])));
            for i in 0..120 {
                let mut pick =
                    |on_edge: bool| if on_edge { (16.0 * random.f64()).round() / 16.0 } else { random.f64() };
                let (u, v) = (pick(i % 2 == 0), pick(i % 3 == 0));
                let p = patch.position(u.into(), v.into());
                let direction = direction(&mut random);
                let slope = patch.normal(u.into(), v.into()).unwrap().dot(direction).abs();
                if slope > 1e-3 {
                    let hits = traced.hits_at(p, direction);
                    let near = hits.iter().filter(|hit| hit.position.distance(p) < 1e-14 / slope).count();
                    assert_eq!(near, 1, "{rows} × {columns} at {u}, {v}: {hits:?}");
                }
            }
        }
    }
}

#[test]
fn a_flat_patch_seen_edge_on_is_invisible() {
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let square = [corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 0.0), corner(1.0, 1.0)];
    let patch = BezierPatch::new(2, square.to_vec()).unwrap();
    let traced = Traced::new(&Surface::new([SurfacePiece::Patch(patch)]));
    assert_eq!(all_hits(&traced, DVec3::new(-1.0, 0.0, 0.3), DVec3::new(2.0, 0.0, 0.1)), []);
    let hits = all_hits(&traced, DVec3::new(0.25, 3.0, 0.5), DVec3::new(0.0, -2.0, 0.0));
    let [hit] = hits[..] else { panic!("{hits:?}") };
    assert_eq!((hit.t, hit.position, hit.normal), (1.5, DVec3::new(0.25, 0.0, 0.5), DVec3::Y));
}

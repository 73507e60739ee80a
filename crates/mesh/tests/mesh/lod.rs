//! Levels of detail of any mesh: without cracks, and with about the errors that they state.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use glam::{Vec2, Vec3};
use halfway_mesh::{Cuboid, LodGroup, LodHierarchy, Mesh, Plane, Subdivision, Teapot, UvSphere};
use proptest::prelude::*;

fn levels(mesh: &Mesh) -> LodHierarchy {
    mesh.lod_hierarchy(&AtomicBool::new(false)).expect("nothing stops it")
}

/// A repeatable random number from 0 to 1 (PCG).
fn random(seed: u32) -> f32 {
    let state = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    ((word >> 22) ^ word) as f32 / u32::MAX as f32
}

/// The mesh with its vertices moved by up to `by` along each axis; those at one position move together.
fn shaken(mesh: &Mesh, by: f32) -> Mesh {
    let key =
        |p: &Vec3| p.to_array().iter().fold(7, |key: u32, x| (x + 0.0).to_bits().wrapping_add(key.wrapping_mul(31)));
    let shake = |p: &Vec3| *p + by * (2.0 * Vec3::from_array([0, 1, 2].map(|axis| random(key(p) ^ axis))) - 1.0);
    let positions = mesh.positions().iter().map(shake).collect();
    Mesh::new(positions, mesh.indices().to_vec()).unwrap()
}

fn grid(divisions: u32) -> Mesh {
    Plane { divisions, size: divisions as f32 }.into()
}

fn pieces(count: u32) -> Mesh {
    let ball = Mesh::from(UvSphere::new(1.0, 12, 8));
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for piece in 0..count {
        let first = positions.len() as u32;
        let place = 3.0 * Vec3::new((piece % 8) as f32, (piece / 8 % 8) as f32, (piece / 64) as f32);
        positions.extend(ball.positions().iter().map(|p| *p + place));
        indices.extend(ball.indices().iter().map(|i| first + i));
    }
    Mesh::new(positions, indices).unwrap()
}

/// The mesh with three vertices of its own for each triangle, and their normals.
fn unindexed(mesh: &Mesh) -> Mesh {
    let pick = |all: &[Vec3]| mesh.indices().iter().map(|&i| all[i as usize]).collect();
    let indices = (0..mesh.indices().len() as u32).collect();
    Mesh::from_parts(pick(mesh.positions()), Some(pick(mesh.normals())), None, indices).unwrap()
}

/// Meshes of one cluster and of many, with all attributes.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let sphere = Mesh::from(UvSphere::new(1.0, 96, 48));
    let without = |left_out: &dyn Fn(usize) -> bool| {
        let kept = sphere.triangles().enumerate().filter(|(number, _)| !left_out(*number));
        let indices = kept.flat_map(|(_, triangle)| triangle).collect();
        Mesh::from_parts(sphere.positions().to_vec(), Some(sphere.normals().to_vec()), None, indices).unwrap()
    };
    let stretched = grid(70).positions().iter().map(|p| *p * Vec3::new(1000.0, 1.0, 1.0)).collect();
    let doubled = [grid(50).indices(), grid(50).indices()].concat();
    let fan = [Vec3::ZERO].into_iter().chain((0..900).map(|i| Vec3::new((i / 30) as f32, (i % 30) as f32, 1.0)));
    vec![
        ("small sphere", UvSphere::new(1.0, 32, 16).into()),
        ("sphere with a seam", sphere.clone()),
        ("odd number", without(&|number| number == 4711)),
        ("holes", without(&|number| number % 97 == 0)),
        ("noisy sphere", shaken(&sphere, 0.01)),
        ("noisy grid", shaken(&grid(65), 0.2)),
        ("box with creases", Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 5).unwrap()),
        ("teapot", Teapot::new(16).into()),
        ("pieces", pieces(100)),
        ("slivers", Mesh::new(stretched, grid(70).indices().to_vec()).unwrap()),
        ("doubled", Mesh::new(grid(50).positions().to_vec(), doubled).unwrap()),
        ("unindexed", unindexed(&sphere)),
        ("one point in all", Mesh::new(fan.collect(), (1..900).flat_map(|i| [0, i, i + 1]).collect()).unwrap()),
    ]
}

/// The triangles to draw if groups are accepted by some criterion.
fn drawn(levels: &LodHierarchy, will_do: impl FnMut(&LodGroup) -> bool) -> Vec<[u32; 3]> {
    levels.cut(will_do).into_iter().flat_map(|cluster| levels.triangles_of(cluster)).copied().collect()
}

/// How often each edge is passed one way more than the other, by positions; balanced edges are left out.
fn boundary(mesh: &Mesh, triangles: &[[u32; 3]]) -> BTreeMap<[[u32; 3]; 2], i32> {
    let place = |i: u32| mesh.positions()[i as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut edges = BTreeMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.map(place);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_insert(0) += i32::from(from < to) - i32::from(from > to);
        }
    }
    edges.retain(|_, passes| *passes != 0);
    edges
}

/// The first fault in the levels of a mesh, in any of some cuts.
fn fault(mesh: &Mesh, levels: &LodHierarchy) -> Option<String> {
    let (mut clusters, mut triangles) = (0, 0);
    for (number, group) in (0..).zip(&levels.groups) {
        if group.clusters.start != clusters {
            return Some(format!("group {number} begins at {}, not {clusters}", group.clusters.start));
        }
        clusters = group.clusters.end;
        for cluster in &levels.clusters[group.clusters.start as usize..group.clusters.end as usize] {
            if cluster.triangles.start != triangles {
                return Some(format!("a cluster of group {number} is out of order"));
            }
            triangles = cluster.triangles.end;
            if let Some(source) = cluster.source {
                let finer = &levels.groups[source as usize];
                let errors = |group: &LodGroup| [group.position_error, group.shading_error, group.map_error];
                if source >= number || errors(finer).iter().zip(errors(group)).any(|(finer, own)| *finer > own) {
                    return Some(format!("group {number} is no coarser than its source {source}"));
                }
            }
            for vertex in levels.triangles[cluster.triangles.start as usize..triangles as usize].as_flattened() {
                let p = mesh.positions()[*vertex as usize];
                if p.as_dvec3().distance(group.center.as_dvec3()) > f64::from(group.radius) {
                    return Some(format!("vertex {vertex} is outside of the sphere of group {number}"));
                }
            }
        }
    }
    let sorted = |mut triangles: Vec<[u32; 3]>| {
        triangles.sort_unstable();
        triangles
    };
    if sorted(drawn(levels, |_| false)) != sorted(mesh.triangles().collect()) {
        return Some("the finest clusters are not the mesh".into());
    }
    let border = boundary(mesh, mesh.indices().as_chunks::<3>().0);
    // By error, and by chance.
    let mut errors: Vec<f32> = levels.groups.iter().map(|group| group.position_error).collect();
    errors.sort_by(f32::total_cmp);
    let mut before = mesh.triangle_count();
    for &error in errors.iter().step_by((errors.len() / 8).max(1)) {
        let triangles = drawn(levels, |group| group.position_error <= error);
        if triangles.len() > before {
            return Some(format!("{} triangles within {error}, {before} with less error", triangles.len()));
        }
        before = triangles.len();
        if boundary(mesh, &triangles) != border {
            return Some(format!("another border within {error}"));
        }
    }
    for seed in 0..4 {
        let mut number = seed;
        let triangles = drawn(levels, |_| {
            number += 4;
            random(number) < 0.8
        });
        if boundary(mesh, &triangles) != border {
            return Some(format!("another border by chance, {seed}"));
        }
    }
    None
}

#[test]
fn levels_of_every_mesh_have_no_cracks() {
    for (name, mesh) in meshes() {
        let levels = levels(&mesh);
        assert_eq!(fault(&mesh, &levels), None, "{name}");
        let coarsest = drawn(&levels, |_| true).len();
        println!("{name}: {coarsest} of {} triangles", mesh.triangle_count());
        // All edges of the doubled grid have four triangles, and all but one vertex of the fan are on its border.
        let stays = ["doubled", "one point in all"].contains(&name);
        assert!(stays || coarsest < mesh.triangle_count() / 4, "{name}: {coarsest} triangles");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Triangles between any vertices, some at one place: mostly no surface.
    #[test]
    fn levels_of_random_triangles_have_no_cracks(
        corners in prop::collection::vec((0_u32..60, 0_u32..60, 0_u32..60), 1..400),
        places in prop::collection::vec((0_u8..6, 0_u8..6, 0_u8..3), 60),
    ) {
        let positions = places.iter().map(|&(x, y, z)| Vec3::new(f32::from(x), f32::from(y), f32::from(z))).collect();
        let mesh = Mesh::new(positions, corners.iter().flat_map(|&(a, b, c)| [a, b, c]).collect()).unwrap();
        prop_assert_eq!(fault(&mesh, &levels(&mesh)), None);
    }

    /// A surface with holes, seams and noise, of many clusters.
    #[test]
    fn levels_of_random_surfaces_have_no_cracks(
        left_out in prop::collection::vec(0_usize..9000, 0..40),
        seams in prop::collection::vec(0_u32..2300, 0..200),
        noise in 0.0_f32..0.03,
    ) {
        let sphere = shaken(&UvSphere::new(1.0, 70, 33).into(), noise);
        let kept = sphere.triangles().enumerate().filter(|(number, _)| !left_out.contains(number));
        let mut indices: Vec<u32> = kept.flat_map(|(_, triangle)| triangle).collect();
        let (mut positions, mut normals) = (sphere.positions().to_vec(), sphere.normals().to_vec());
        // Every second corner at such a vertex has one of its own, with another normal.
        for vertex in seams {
            let own = positions.len() as u32;
            positions.push(positions[vertex as usize]);
            normals.push((normals[vertex as usize] + Vec3::X).normalize());
            indices.iter_mut().filter(|index| **index == vertex).step_by(2).for_each(|index| *index = own);
        }
        let mesh = Mesh::from_parts(positions, Some(normals), None, indices).unwrap();
        prop_assert_eq!(fault(&mesh, &levels(&mesh)), None);
    }
}

/// A name, and the change to a hierarchy.
type Fault<'a> = (&'a str, &'a dyn Fn(&mut LodHierarchy));

#[test]
fn planted_faults_are_found() {
    let mesh = shaken(&UvSphere::new(1.0, 96, 48).into(), 0.01);
    let sound = levels(&mesh);
    assert_eq!(fault(&mesh, &sound), None);
    let coarse = (0..).zip(&sound.clusters).find(|(_, cluster)| cluster.source.is_some_and(|source| source > 3));
    let (number, cluster) = coarse.map(|(number, cluster): (usize, _)| (number, cluster.clone())).unwrap();
    let triangle = cluster.triangles.start as usize;
    let source = cluster.source.unwrap() as usize;
    let faults: [Fault; 7] = [
        ("a triangle turned over", &|levels| levels.triangles[triangle].swap(0, 1)),
        ("a triangle elsewhere", &|levels| levels.triangles[triangle] = levels.triangles[0]),
        ("a fine triangle twice", &|levels| levels.triangles[1] = levels.triangles[0]),
        ("another source", &|levels| levels.clusters[number].source = Some(source as u32 - 1)),
        ("no source", &|levels| levels.clusters[number].source = None),
        ("no error", &|levels| levels.groups.iter_mut().skip(source + 1).for_each(|group| group.position_error = 0.0)),
        ("a small sphere", &|levels| levels.groups[source].radius *= 0.9),
    ];
    for (name, plant) in faults {
        let mut levels = sound.clone();
        plant(&mut levels);
        assert!(fault(&mesh, &levels).is_some(), "{name} is not found");
    }
}

#[test]
fn position_errors_match_the_distance_of_the_surfaces() {
    for (name, mesh) in meshes() {
        if ["pieces", "slivers", "doubled", "one point in all"].contains(&name) {
            continue;
        }
        let levels = levels(&mesh);
        let radius = mesh.bounds().radius();
        for error in [0.03, 0.01, 0.003].map(|part| part * radius) {
            let indices = drawn(&levels, |group| group.position_error <= error).into_flattened();
            if indices.len() == mesh.indices().len() {
                continue;
            }
            let said = levels.groups.iter().map(|group| group.position_error).filter(|own| *own <= error);
            let said = f64::from(said.fold(0.0, f32::max));
            let coarse = Mesh::from_parts(mesh.positions().to_vec(), None, None, indices).unwrap();
            let tolerance = 0.05 * said;
            let found = coarse.distance_to(&mesh, tolerance).least.max(mesh.distance_to(&coarse, tolerance).least);
            println!("{name}: {found:.2e} apart, {said:.2e} said, {} triangles", coarse.triangle_count());
            // Quadrics are a mean over the planes around a vertex, not over the surface, and add up. A flat side is
            // off by rounding only.
            assert!(found <= 2.0 * said, "{name}: {found} apart, {said} said");
            assert!(found >= 0.1 * said || said < 1e-5, "{name}: {found} apart, {said} said");
        }
    }
}

#[test]
fn shading_errors_tell_rough_from_smooth() {
    let smooth = Mesh::from(UvSphere::new(1.0, 192, 96));
    let count = |mesh: &Mesh, error: f32| drawn(&levels(mesh), |group| group.shading_error <= error).len();
    // About the length of an edge.
    let [smooth_left, rough_left] = [smooth.clone(), shaken(&smooth, 0.01)].map(|mesh| count(&mesh, 0.04));
    let all = smooth.triangle_count();
    assert!(2 * smooth_left < rough_left, "{smooth_left} and {rough_left} of {all}");
    assert_eq!(count(&shaken(&smooth, 0.01), 0.005), all, "no level of a rough mesh is as fine as that");
}

/// Both differ about as much from vertex to vertex; of hills collapses lose less.
#[test]
fn shading_errors_tell_noise_from_hills() {
    let smooth = Mesh::from(UvSphere::new(1.0, 192, 96));
    let wave = |p: Vec3| 0.02 * (15.0 * p).to_array().into_iter().map(f32::sin).product::<f32>();
    let positions = smooth.positions().iter().map(|p| *p * (1.0 + wave(*p))).collect();
    let hills = Mesh::new(positions, smooth.indices().to_vec()).unwrap();
    let count = |mesh: &Mesh| drawn(&levels(mesh), |group| group.shading_error <= 0.03).len();
    let [hilly_left, noisy_left] = [hills, shaken(&smooth, 0.01)].map(|mesh| count(&mesh));
    assert!(4 * hilly_left < 3 * noisy_left, "{hilly_left} and {noisy_left} of {}", smooth.triangle_count());
}

#[test]
fn map_errors_are_how_far_coordinates_slide() {
    let plane = grid(70);
    for wave in [0.0, 2.0] {
        let slide = |p: Vec3| Vec2::new(p.x + wave * (0.2 * p.z).sin() * (0.2 * p.x).sin(), p.z);
        let uvs = plane.positions().iter().map(|p| slide(*p)).collect();
        let (positions, normals) = (plane.positions().to_vec(), plane.normals().to_vec());
        let mesh = Mesh::from_parts(positions, Some(normals), Some(uvs), plane.indices().to_vec()).unwrap();
        let levels = levels(&mesh);
        for most in [0.02, 0.1, 0.5] {
            let triangles = drawn(&levels, |group| group.error(true, true) <= most);
            let mut found = 0.0_f32;
            for [a, b, c] in triangles.iter().map(|triangle| triangle.map(|i| mesh.positions()[i as usize])) {
                let at = |weights: [f32; 3]| weights[0] * slide(a) + weights[1] * slide(b) + weights[2] * slide(c);
                for weights in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
                    let p = weights[0] * a + weights[1] * b + weights[2] * c;
                    found = found.max(at(weights).distance(slide(p)));
                }
            }
            println!("a wave of {wave}: {found} where {most} is allowed, {} triangles", triangles.len());
            assert!(found <= 2.0 * most, "{found} where {most} is allowed");
            assert!(found >= 0.1 * most || wave == 0.0, "{found} where {most} is allowed");
            assert!(wave > 0.0 || triangles.len() < 1500, "even coordinates do not slide: {}", triangles.len());
        }
    }
}

#[test]
fn creases_and_planes_stay_as_they_are() {
    let mesh = Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 5).unwrap();
    // Rounding only.
    let flat = drawn(&levels(&mesh), |group| group.position_error.max(group.shading_error) <= 1e-5);
    assert!(flat.len() < mesh.triangle_count() / 8, "{} of {}", flat.len(), mesh.triangle_count());
    for triangle in flat {
        let [a, b, c] = triangle.map(|i| mesh.normals()[i as usize]);
        assert!(a == b && b == c, "a triangle goes around an edge");
    }
}

#[test]
fn meshes_that_cannot_be_simplified_are_unchanged() {
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
        let levels = levels(&mesh);
        assert_eq!(levels.groups.len(), 1, "{name}");
        assert_eq!(drawn(&levels, |_| true).len(), mesh.triangle_count(), "{name}");
    }
}

#[test]
fn scale_does_not_matter_to_levels() {
    let sphere = shaken(&UvSphere::new(1.0, 96, 48).into(), 0.01);
    let reference = levels(&sphere);
    for exponent in [-60, 60] {
        // A power of two, so that all is rounded alike.
        let scale = 2_f32.powi(exponent);
        let positions = sphere.positions().iter().map(|p| *p * scale).collect();
        let normals = Some(sphere.normals().to_vec());
        let scaled = levels(&Mesh::from_parts(positions, normals, None, sphere.indices().to_vec()).unwrap());
        assert_eq!(scaled.triangles, reference.triangles, "2^{exponent}");
        let [own, other] = [&scaled, &reference].map(|levels| levels.groups[0].position_error);
        assert!((own / scale / other - 1.0).abs() < 1e-3, "2^{exponent}: {own} and {other}");
    }
}

#[test]
fn levels_do_not_depend_on_the_number_of_threads() {
    let [one, four] = [1, 4].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap());
    // One of many groups, and one of many pieces.
    for mesh in [shaken(&grid(150), 0.2), pieces(400)] {
        let [alone, shared] = [&one, &four].map(|threads| threads.install(|| levels(&mesh)));
        assert!(alone.groups.len() > 50, "{} groups", alone.groups.len());
        assert!(alone == shared);
    }
}

#[test]
fn making_levels_can_be_stopped() {
    assert_eq!(grid(65).lod_hierarchy(&AtomicBool::new(true)), None);
}

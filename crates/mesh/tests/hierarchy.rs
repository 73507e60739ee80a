//! Hierarchies of patches: of any mesh, without cracks, and no further off than is said.

use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::AtomicBool;

use bevy_math::{DVec3, Vec3};
use halfway_mesh::{Cuboid, HierarchyPatch, Mesh, PatchGroup, PatchHierarchy, Plane, Subdivision, UvSphere};

fn hierarchy(mesh: &Mesh) -> PatchHierarchy {
    mesh.patch_hierarchy(&AtomicBool::new(false)).expect("nothing stops it")
}

/// A number from 0 to 1 that repeats (PCG).
fn random(seed: u32) -> f32 {
    let state = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    ((word >> 22) ^ word) as f32 / u32::MAX as f32
}

/// The mesh with its vertices moved by up to so much along each axis; what is at one place stays there.
fn shaken(mesh: &Mesh, by: f32) -> Mesh {
    let key = |p: &Vec3| p.to_array().iter().fold(7, |key, x| (x + 0.0).to_bits().wrapping_add(31 * key));
    let shake = |p: &Vec3| *p + by * (2.0 * Vec3::from_array([0, 1, 2].map(|axis| random(key(p) ^ axis))) - 1.0);
    let positions = mesh.positions().iter().map(shake).collect();
    Mesh::new(positions, mesh.indices().to_vec()).unwrap()
}

/// A grid whose vertices are up to this much higher or lower, and so as steep as they are far apart and more.
fn wild(divisions: u32, height: f32) -> Mesh {
    let grid = grid(divisions);
    let shake = |(at, p): (u32, &Vec3)| *p + Vec3::Y * height * (2.0 * random(at) - 1.0);
    Mesh::new((0..).zip(grid.positions()).map(shake).collect(), grid.indices().to_vec()).unwrap()
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

/// Meshes small and large, of one patch and of many, with all that meshes have.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let sphere = Mesh::from(UvSphere::new(1.0, 96, 48));
    let without = |left_out: &dyn Fn(usize) -> bool| {
        let kept = sphere.triangles().enumerate().filter(|(number, _)| !left_out(*number));
        let indices = kept.flat_map(|(_, triangle)| triangle).collect();
        Mesh::from_parts(sphere.positions().to_vec(), Some(sphere.normals().to_vec()), None, indices).unwrap()
    };
    let slivers: Vec<Vec3> = grid(70).positions().iter().map(|p| *p * Vec3::new(1000.0, 1.0, 1.0)).collect();
    let doubled = [grid(50).indices(), grid(50).indices()].concat();
    vec![
        ("small sphere", UvSphere::new(1.0, 32, 16).into()),
        ("sphere with a seam", sphere.clone()),
        ("odd number", without(&|number| number == 4711)),
        ("holes", without(&|number| number % 97 == 0)),
        ("noisy sphere", shaken(&sphere, 0.01)),
        ("noisy grid", shaken(&grid(65), 0.2)),
        ("wild grid", wild(65, 1.5)),
        ("box with creases", Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 5).unwrap()),
        ("pieces", pieces(100)),
        ("slivers", Mesh::new(slivers, grid(70).indices().to_vec()).unwrap()),
        ("doubled", Mesh::new(grid(50).positions().to_vec(), doubled).unwrap()),
        ("one vertex each", {
            let (mut positions, mut indices) = (Vec::new(), Vec::new());
            for triangle in sphere.triangles() {
                indices.extend([0, 1, 2].map(|corner| positions.len() as u32 + corner));
                positions.extend(triangle.map(|i| sphere.positions()[i as usize]));
            }
            Mesh::new(positions, indices).unwrap()
        }),
    ]
}

/// The triangles that are drawn where those groups will do that are no further off than this.
fn within(hierarchy: &PatchHierarchy, error: f32) -> Vec<[u32; 3]> {
    let will_do = |group: u32| hierarchy.groups[group as usize].error <= error;
    let mut triangles = Vec::new();
    for (number, group) in (0..).zip(&hierarchy.groups) {
        let patches = &hierarchy.patches[group.joins.start as usize..group.joins.end as usize];
        for patch in patches.iter().filter(|patch| !will_do(number) && patch.part_of.is_none_or(will_do)) {
            triangles.extend(&hierarchy.triangles[patch.triangles.start as usize..patch.triangles.end as usize]);
        }
    }
    triangles
}

/// The thresholds between which cuts differ, and some of them.
fn thresholds(hierarchy: &PatchHierarchy) -> Vec<f32> {
    let mut errors: Vec<f32> = hierarchy.groups.iter().map(|group| group.error).filter(|e| e.is_finite()).collect();
    errors.sort_by(f32::total_cmp);
    errors.into_iter().step_by((hierarchy.groups.len() / 12).max(1)).collect()
}

/// How often each edge is passed one way more than the other, by places; what cancels is left out.
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

#[test]
fn every_mesh_has_levels_without_cracks() {
    for (name, mesh) in meshes() {
        let hierarchy = hierarchy(&mesh);
        let finest: Vec<[u32; 3]> = within(&hierarchy, -1.0);
        let sorted = |mut triangles: Vec<[u32; 3]>| {
            triangles.sort_unstable();
            triangles
        };
        assert_eq!(sorted(finest.clone()), sorted(mesh.triangles().collect()), "{name}: the finest are the mesh's");
        assert_eq!(hierarchy.finest_count(), mesh.triangle_count(), "{name}");
        let border = boundary(&mesh, &finest);
        let mut before = finest.len();
        for error in thresholds(&hierarchy) {
            let triangles = within(&hierarchy, error);
            assert_eq!(triangles.len(), hierarchy.triangles_within(error));
            assert!(triangles.len() <= before, "{name}: {} triangles after {before}", triangles.len());
            before = triangles.len();
            // What is not closed is closed by the same border: no crack, and nothing twice.
            assert!(boundary(&mesh, &triangles) == border, "{name} within {error}: another border");
        }
        println!("{name}: {} of {} triangles", before, finest.len());
        // Half of the doubled grid's vertices have neighbours that no surface has, and a faceted mesh is all creases.
        let coarse = ["doubled", "one vertex each"].contains(&name) || before < finest.len() * 6 / 10;
        assert!(coarse, "{name}: {before} of {} triangles", finest.len());
    }
}

#[test]
fn groups_follow_those_that_they_join_and_are_no_better() {
    for (name, mesh) in meshes() {
        let PatchHierarchy { triangles, patches, groups } = hierarchy(&mesh);
        let (mut patch_end, mut triangle_end) = (0, 0);
        for (number, group) in (0..).zip(&groups) {
            assert_eq!(group.joins.start, patch_end, "{name}");
            patch_end = group.joins.end;
            for patch in &patches[group.joins.start as usize..group.joins.end as usize] {
                assert_eq!(patch.triangles.start, triangle_end, "{name}");
                triangle_end = patch.triangles.end;
                let Some(finer) = patch.part_of else { continue };
                assert!(finer < number, "{name}");
                let figures =
                    |g: &PatchGroup| [g.error, g.normal_error, g.normal_spread, g.longest_edge, g.corner_reach];
                let pairs = figures(&groups[finer as usize]).into_iter().zip(figures(group));
                assert!(pairs.clone().all(|(finer, own)| finer <= own), "{name}: {:?}", pairs.collect::<Vec<_>>());
                assert!(groups[finer as usize].roughness >= group.roughness, "{name}: rougher than what it joins");
                // Jung's theorem, and a little for rounding up.
                let most = 1.001 * group.longest_edge / 3f32.sqrt();
                assert!(group.error.is_infinite() || group.corner_reach <= most, "{name}: {group:?}");
            }
        }
        assert_eq!((patch_end as usize, triangle_end as usize), (patches.len(), triangles.len()), "{name}");
        assert!(groups.last().is_some_and(|last| last.error.is_infinite()), "{name}");
    }
}

#[test]
fn no_point_is_further_off_than_is_said() {
    for (name, mesh) in [("noisy grid", shaken(&grid(65), 0.2)), ("wild grid", wild(65, 1.5))]
        .into_iter()
        .chain(meshes().into_iter().filter(|(name, _)| ["small sphere", "noisy sphere", "holes"].contains(name)))
    {
        let hierarchy = hierarchy(&mesh);
        let mut largest = 0.0_f64;
        for error in thresholds(&hierarchy) {
            let indices = within(&hierarchy, error).into_flattened();
            let coarse = Mesh::from_parts(mesh.positions().to_vec(), None, None, indices).unwrap();
            // A distance that some point has; known far better than it is compared.
            let tolerance = 0.02 * f64::from(error);
            let found = coarse.distance_to(&mesh, tolerance).least.max(mesh.distance_to(&coarse, tolerance).least);
            largest = largest.max(found / f64::from(error));
            assert!(found <= f64::from(error), "{name}: {found} where {error} is said");
        }
        println!("{name}: up to {largest:.2} of what is said");
        assert!(largest > 0.1, "{name}: the bound says nothing: {largest}");
    }
}

/// Of groups that join patches of the mesh itself, since errors of others are added up.
#[test]
fn no_point_of_a_first_join_is_further_off_than_is_said() {
    let sphere = shaken(&UvSphere::new(1.0, 128, 64).into(), 0.02);
    // On the creased one a group is farthest off where it is not covered once.
    let creased = shaken(&grid(129), 0.4);
    for (name, mesh) in [("wild grid", wild(65, 1.5)), ("noisy sphere", sphere), ("creased grid", creased)] {
        let hierarchy = hierarchy(&mesh);
        let part = |patches: &mut dyn Iterator<Item = &HierarchyPatch>| {
            let range = |patch: &HierarchyPatch| patch.triangles.start as usize..patch.triangles.end as usize;
            let corners = patches.flat_map(|patch| &hierarchy.triangles[range(patch)]).flatten();
            let positions: Vec<Vec3> = corners.map(|&vertex| mesh.positions()[vertex as usize]).collect();
            let indices = (0..positions.len() as u32).collect();
            Mesh::new(positions, indices).unwrap()
        };
        let (mut groups, mut largest) = (0, 0.0_f64);
        for (number, group) in (0..).zip(&hierarchy.groups).filter(|(_, group)| group.error.is_finite()) {
            let joined = &hierarchy.patches[group.joins.start as usize..group.joins.end as usize];
            if joined.iter().any(|patch| patch.part_of.is_some()) {
                continue;
            }
            let fine = part(&mut joined.iter());
            let coarse = part(&mut hierarchy.patches.iter().filter(|patch| patch.part_of == Some(number)));
            let tolerance = 0.02 * f64::from(group.error);
            let found = coarse.distance_to(&fine, tolerance).least.max(fine.distance_to(&coarse, tolerance).least);
            assert!(found <= f64::from(group.error), "{name}, {number}: {found} where {} is said", group.error);
            (groups, largest) = (groups + 1, largest.max(found / f64::from(group.error)));
        }
        println!("{name}: {groups} groups, up to {largest:.2} of what is said");
        assert!(groups > 5 && largest > 0.5, "{name}: {groups} groups, {largest}");
    }
}

/// The points of a triangle at this many steps along its edges.
fn samples(steps: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..=steps).flat_map(move |i| {
        (0..=steps - i).map(move |j| [i, j, steps - i - j].map(|weight| f64::from(weight) / f64::from(steps)))
    })
}

fn sum(of: [Vec3; 3], weights: [f64; 3]) -> DVec3 {
    of.into_iter().zip(weights).map(|(v, weight)| v.as_dvec3() * weight).sum()
}

#[test]
fn normals_turn_no_further_than_is_said() {
    for (name, mesh) in [("noisy grid", shaken(&grid(46), 0.15)), ("sphere", UvSphere::new(1.0, 66, 34).into())] {
        let hierarchy = hierarchy(&mesh);
        let at = |triangle: [u32; 3]| triangle.map(|i| mesh.positions()[i as usize]);
        let normals = |triangle: [u32; 3]| triangle.map(|i| mesh.normals()[i as usize]);
        let mut parts: HashMap<u32, Vec<[u32; 3]>> = HashMap::new();
        for patch in &hierarchy.patches {
            let triangles = &hierarchy.triangles[patch.triangles.start as usize..patch.triangles.end as usize];
            if let Some(group) = patch.part_of {
                parts.entry(group).or_default().extend(triangles);
            }
        }
        let (mut looked, mut largest) = (0, 0.0_f64);
        for (&number, triangles) in &parts {
            let PatchGroup { error, normal_error, .. } = hierarchy.groups[number as usize];
            if normal_error > 1.0 {
                continue;
            }
            for &triangle in triangles.iter().step_by(17) {
                for weights in samples(4) {
                    let (p, n) = (sum(at(triangle), weights), sum(normals(triangle), weights).normalize());
                    let reach = f64::from(error) * (1.0 + 1e-6);
                    let near = mesh.triangles().filter(|&fine| {
                        let corners = at(fine).map(Vec3::as_dvec3);
                        let low = corners[0].min(corners[1]).min(corners[2]) - reach;
                        let high = corners[0].max(corners[1]).max(corners[2]) + reach;
                        p.cmpge(low).all() && p.cmple(high).all()
                    });
                    let mut least = f64::INFINITY;
                    for fine in near {
                        for weights in samples(64) {
                            if sum(at(fine), weights).distance(p) <= reach {
                                least = least.min(sum(normals(fine), weights).normalize().angle_between(n));
                            }
                        }
                    }
                    // Between the samples of the mesh its normals turn by up to a 64th of an edge's.
                    let slack = 0.03;
                    looked += 1;
                    if least.is_finite() {
                        largest = largest.max(least);
                        assert!(
                            least <= f64::from(normal_error) + slack,
                            "{name}: {least} where {normal_error} is said"
                        );
                    }
                }
            }
        }
        println!("{name}: {looked} points, turned by up to {largest}");
        assert!(looked > 300 && largest > 0.0, "{name}: {looked} points");
    }
}

/// Parts stay at least their error away from what is not connected with them: those move by no more than that too.
#[test]
fn what_is_not_connected_has_room_for_the_error() {
    let ball = Mesh::from(UvSphere::new(1.0, 96, 48));
    let count = ball.positions().len() as u32;
    let mut groups_with_room = Vec::new();
    // Shells around each other; then one that cuts another's side, and one far off.
    for (size, aside) in [(1.001, 0.0), (1.02, 0.0), (1.1, 0.0), (1.5, 0.0), (0.5, 1.2), (1.0, 30.0)] {
        let other = |p: &Vec3| *p * size + Vec3::X * aside;
        let positions = ball.positions().iter().copied().chain(ball.positions().iter().map(other)).collect();
        let indices = ball.indices().iter().copied().chain(ball.indices().iter().map(|i| i + count)).collect();
        let both = Mesh::new(positions, indices).unwrap();
        let is_other = |triangle: &[u32; 3]| triangle[0] >= count;
        let hierarchy = hierarchy(&both);
        for (number, group) in (0..).zip(&hierarchy.groups).take(hierarchy.groups.len() - 1) {
            let parts = hierarchy.patches.iter().filter(|patch| patch.part_of == Some(number));
            for patch in parts {
                let triangles = &hierarchy.triangles[patch.triangles.start as usize..patch.triangles.end as usize];
                for own in triangles {
                    let corners = own.map(|i| both.positions()[i as usize]);
                    for weights in samples(3) {
                        let p = sum(corners, weights);
                        // How far a point is from a sphere is known, and its mesh lies within it by no more than
                        // 2 · 10⁻³ of its radius.
                        let (center, radius) = if is_other(own) {
                            (DVec3::ZERO, 1.0)
                        } else {
                            (DVec3::X * f64::from(aside), f64::from(size))
                        };
                        let distance = (p.distance(center) - radius).abs() + 0.002 * radius;
                        assert!(distance >= f64::from(group.error), "{size}, {aside}: {distance} < {}", group.error);
                    }
                }
            }
        }
        groups_with_room.push(hierarchy.groups.len() - 1);
    }
    let [close, some, more, wide, cut, apart] = groups_with_room[..] else { unreachable!("as many as there are rows") };
    assert!(close == 0 && some <= more && more <= wide && wide <= apart, "{groups_with_room:?}");
    assert!(cut > 0 && cut < apart, "only where one cuts the other nothing is joined: {groups_with_room:?}");
}

/// The same of a sheet that is wound twice around a cylinder, which is connected; each of its points has a layer over
/// it or under it.
#[test]
fn a_rolled_sheet_has_room_for_the_error() {
    const AROUND: u32 = 150;
    let mut groups_with_room = Vec::new();
    for apart in [0.0005, 0.05, 0.2, 0.5] {
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        for along in 0..=2 * AROUND {
            let turns = along as f32 / (AROUND as f32 + 0.4);
            let (sin, cos) = (std::f32::consts::TAU * turns).sin_cos();
            for across in 0..=40_u32 {
                let bump = 0.004 * (0.7 * across as f32).sin();
                let radius = 1.0 + apart * turns + bump;
                positions.push(Vec3::new(radius * sin, 0.04 * across as f32, radius * cos));
                if along < 2 * AROUND && across < 40 {
                    let [a, b] = [41 * along + across, 41 * (along + 1) + across];
                    indices.extend([a, b, b + 1, a, b + 1, a + 1]);
                }
            }
        }
        let hierarchy = hierarchy(&Mesh::new(positions, indices).unwrap());
        let groups = &hierarchy.groups[..hierarchy.groups.len() - 1];
        let largest = groups.iter().map(|group| group.error).fold(0.0, f32::max);
        assert!(2.0 * largest <= apart, "{apart} apart, off by {largest}");
        groups_with_room.push(groups.len());
    }
    let [close, some, more, wide] = groups_with_room[..] else { unreachable!("as many as there are rows") };
    assert!(close == 0 && some <= more && more <= wide && wide > 10, "{groups_with_room:?}");
}

/// Rows of a grid with noise make upright triangles where vertices of one row are joined. Were they made, more than
/// half of the grids with more noise would be left within twice its height, and more than a fifth if distances were
/// measured along triangles' own normals. Those of the vertices do not count for it.
#[test]
fn noise_goes_within_its_own_height() {
    for noise in [0.05, 0.12, 0.2] {
        let mesh = wild(180, noise);
        let leaning = vec![Vec3::new(0.9, 0.1, 0.0).normalize(); mesh.positions().len()];
        let leaning = Mesh::from_parts(mesh.positions().to_vec(), Some(leaning), None, mesh.indices().to_vec());
        for (name, mesh) in [("its own", mesh), ("leaning", leaning.expect("a normal for each vertex"))] {
            let hierarchy = hierarchy(&mesh);
            let left = hierarchy.triangles_within(2.0 * noise) as f32 / hierarchy.finest_count() as f32;
            println!("noise of {noise}, {name} normals: {left} of the triangles");
            assert!(left < 0.15, "noise of {noise}, {name} normals: {left} of the triangles");
        }
    }
}

#[test]
fn creases_and_planes_stay_as_they_are() {
    let mesh = Mesh::from(Cuboid::default()).subdivided(Subdivision::Midpoint, 5).unwrap();
    let hierarchy = hierarchy(&mesh);
    // Rounding only.
    let flat = within(&hierarchy, 1e-6);
    assert!(flat.len() < mesh.triangle_count() / 3, "{} of {}", flat.len(), mesh.triangle_count());
    for triangle in flat {
        let [a, b, c] = triangle.map(|i| mesh.normals()[i as usize]);
        assert!(a == b && b == c, "a triangle goes around an edge");
    }
}

#[test]
fn what_cannot_be_coarser_is_left_as_it_is() {
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
        let hierarchy = hierarchy(&mesh);
        assert_eq!(hierarchy.groups.len(), 1, "{name}");
        assert_eq!(within(&hierarchy, f32::MAX).len(), mesh.triangle_count(), "{name}");
    }
}

#[test]
fn the_same_mesh_has_the_same_hierarchy_on_any_number_of_threads() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let several = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("some threads");
    // One of many groups, and one of many pieces.
    for mesh in [shaken(&grid(150), 0.2), pieces(400)] {
        let [alone, shared] = [&one, &several].map(|threads| threads.install(|| hierarchy(&mesh)));
        assert!(alone.groups.len() > 50, "{} groups", alone.groups.len());
        assert!(alone == shared && alone == hierarchy(&mesh));
    }
}

#[test]
fn making_one_stops_when_it_is_told_to() {
    assert_eq!(grid(65).patch_hierarchy(&AtomicBool::new(true)), None);
}

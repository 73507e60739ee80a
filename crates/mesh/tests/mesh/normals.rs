//! Normals: of faces, of vertices by every weighting, at any scale, and where they fail.

use glam::Vec3;
use halfway_mesh::{Mesh, NormalReport, NormalWeighting, Normals, UvSphere, face_normal};

const WEIGHTINGS: [NormalWeighting; 4] =
    [NormalWeighting::Uniform, NormalWeighting::Area, NormalWeighting::Angle, NormalWeighting::Max];

/// Normals are computed in f64 and rounded to f32 at the end: half a step of numbers up to 1, in each coordinate.
const ROUNDING: f32 = 1e-7;

/// From the smallest to the largest models that the project speaks of.
fn scales() -> impl Iterator<Item = f32> {
    (-18..=18).step_by(3).map(|exponent| 10_f32.powi(exponent))
}

/// The cube of edge 2 about the origin; its corners are the bits of their number. Bit i of `diagonals` says how side i
/// is cut in two.
fn cube(diagonals: u32) -> (Vec<Vec3>, Vec<u32>) {
    let corners = (0..8_u32).map(|i| {
        let side = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        Vec3::new(side(1), side(2), side(4))
    });
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = sides
        .iter()
        .enumerate()
        .flat_map(|(i, &[a, b, c, d])| if diagonals >> i & 1 == 0 { [a, b, c, a, c, d] } else { [b, c, d, b, d, a] });
    (corners.collect(), indices.collect())
}

fn weighted(positions: Vec<Vec3>, indices: Vec<u32>, weighting: NormalWeighting) -> (Vec<Vec3>, NormalReport) {
    let (mesh, report) = Mesh::new(positions, indices).unwrap().with_normals(Normals::Weighted(weighting));
    (mesh.normals().to_vec(), report)
}

#[test]
fn face_normals_at_any_scale() {
    let rows = [
        ("right angle", [Vec3::ZERO, Vec3::X, Vec3::Y], Vec3::Z),
        ("turned round", [Vec3::ZERO, Vec3::Y, Vec3::X], Vec3::NEG_Z),
        ("equilateral", [Vec3::X, Vec3::Y, Vec3::Z], Vec3::ONE.normalize()),
        ("thin", [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 0.0, -1e-6)], Vec3::Y),
    ];
    for (name, corners, expected) in rows {
        for scale in scales().chain([1e-38, 1e38]) {
            let [a, b, c] = corners.map(|p| p * scale);
            let n = face_normal(a, b, c).unwrap();
            assert!(n.distance(expected) < 3.0 * ROUNDING, "{name} at {scale:e}: {n}");
        }
    }
}

#[test]
fn degenerate_triangles_have_no_normal() {
    let rows = [
        ("one point", [Vec3::ONE, Vec3::ONE, Vec3::ONE]),
        ("two corners equal", [Vec3::ZERO, Vec3::X, Vec3::X]),
        ("first and last equal", [Vec3::Y, Vec3::X, Vec3::Y]),
        ("on a line", [Vec3::ZERO, Vec3::X, Vec3::X * 3.0]),
        ("on a slanted line", [Vec3::ZERO, Vec3::ONE, Vec3::ONE * 3.0]),
        ("sliver", [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-8, 0.0)]),
        ("NaN", [Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0)]),
        ("infinite", [Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::INFINITY, 0.0)]),
    ];
    for (name, [a, b, c]) in rows {
        for scale in scales() {
            assert_eq!(face_normal(a * scale, b * scale, c * scale), None, "{name} at {scale:e}");
        }
    }
}

#[test]
fn a_triangle_far_from_the_origin_keeps_its_normal() {
    // A unit triangle at ten million units, where positions are whole numbers.
    let far = Vec3::splat(1e7);
    assert_eq!(face_normal(far, far + Vec3::X, far + Vec3::Y), Some(Vec3::Z));
}

#[test]
fn angle_weights_ignore_the_diagonals_of_a_cube() {
    let mut worst_uniform = 0.0_f32;
    for diagonals in 0..64 {
        let (positions, indices) = cube(diagonals);
        let error = |weighting| {
            let (normals, report) = weighted(positions.clone(), indices.clone(), weighting);
            assert!(report.is_clean());
            let errors = normals.iter().zip(&positions).map(|(n, p)| n.distance(p.normalize()));
            errors.fold(0.0_f32, f32::max)
        };
        // The corners' normals are their directions.
        let angle = error(NormalWeighting::Angle);
        assert!(angle < 3.0 * ROUNDING, "cut {diagonals:06b}: {angle}");
        worst_uniform = worst_uniform.max(error(NormalWeighting::Uniform));
    }
    // The plain mean does see it: 2, 1, 1 triangles of the three sides give (2, 1, 1)/√6, 0.34 from (1, 1, 1)/√3.
    assert!(worst_uniform > 0.3, "{worst_uniform}");
}

#[test]
fn weights_match_their_formulas() {
    // Two faces at a right angle share the edge from the origin to +X. At the origin face 0 (normal +Z) has the legs
    // X and a·Y, face 1 (normal −Y) the legs b·Z and X, where the second is cut back to the angle 45°.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y * 3.0, Vec3::new(2.0, 0.0, 2.0)];
    let indices = vec![0, 1, 2, 0, 3, 1];
    let (right, half) = (std::f32::consts::FRAC_PI_2, std::f32::consts::FRAC_PI_4);
    // Weights of face 0 and face 1: areas ½·1·3 and ½·1·2; sin α / (|e₁||e₂|): 1/3 and (1/√2)/(1·2√2).
    let rows = [
        (NormalWeighting::Uniform, 1.0, 1.0),
        (NormalWeighting::Area, 1.5, 1.0),
        (NormalWeighting::Angle, right, half),
        (NormalWeighting::Max, 1.0 / 3.0, 0.25),
    ];
    for (weighting, w0, w1) in rows {
        let (normals, _) = weighted(positions.clone(), indices.clone(), weighting);
        let face1 = face_normal(positions[0], positions[3], positions[1]).unwrap();
        let expected = (Vec3::Z * w0 + face1 * w1).normalize();
        assert!(normals[0].distance(expected) < 3.0 * ROUNDING, "{weighting:?}: {} {expected}", normals[0]);
    }
}

#[test]
fn max_weights_are_exact_on_a_sphere() {
    // A fan of uneven triangles around the pole; all corners on the sphere.
    let ring = [(0.3_f32, 0.0_f32), (0.9, 0.7), (0.2, 1.9), (1.2, 3.0), (0.5, 4.1), (0.7, 5.5)];
    let mut positions = vec![Vec3::Y];
    positions.extend(ring.map(|(theta, phi)| Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())));
    let indices: Vec<u32> = (0..6).flat_map(|i| [0, 1 + (i + 1) % 6, 1 + i]).collect();
    for weighting in WEIGHTINGS {
        let (normals, _) = weighted(positions.clone(), indices.clone(), weighting);
        let error = normals[0].distance(Vec3::Y);
        if weighting == NormalWeighting::Max {
            // The corners are on the sphere to 1e-7, over edges of 0.2 and more.
            assert!(error < 1e-6, "{error}");
        } else {
            assert!(error > 1e-2, "{weighting:?}: {error}");
        }
    }
}

#[test]
fn vertex_normals_at_any_scale() {
    for weighting in WEIGHTINGS {
        let (positions, indices) = cube(0b01_0011);
        let (expected, _) = weighted(positions.clone(), indices.clone(), weighting);
        for scale in scales().chain([1e-37, 1e37]) {
            let scaled = positions.iter().map(|p| *p * scale).collect();
            let (normals, report) = weighted(scaled, indices.clone(), weighting);
            assert!(report.is_clean());
            for (n, e) in normals.iter().zip(&expected) {
                assert!(n.distance(*e) < 3.0 * ROUNDING, "{weighting:?} at {scale:e}: {n} {e}");
            }
        }
    }
}

#[test]
fn normals_converge_to_the_sphere() {
    // The largest error over a sphere, cut ever finer. Halving the edges brings a second-order estimate to a quarter;
    // a third is asked for, since the poles are cut differently.
    let error = |weighting, segments: u32| {
        let sphere = Mesh::from(UvSphere::new(1.0, segments, segments / 2));
        let analytic = sphere.normals().to_vec();
        let (mesh, report) = sphere.with_normals(Normals::Weighted(weighting));
        assert!(report.is_clean());
        let errors = mesh.normals().iter().zip(&analytic).map(|(n, a)| n.distance(*a));
        errors.fold(0.0_f32, f32::max)
    };
    for weighting in [NormalWeighting::Angle, NormalWeighting::Max] {
        let errors = [16, 32, 64].map(|segments| error(weighting, segments));
        if weighting == NormalWeighting::Max {
            // Exact but for the rounding of positions, which grows as edges shrink.
            assert!(errors.iter().all(|e| *e < 1e-5), "{weighting:?}: {errors:?}");
        } else {
            assert!(errors[1] < errors[0] / 3.0 && errors[2] < errors[1] / 3.0, "{weighting:?}: {errors:?}");
        }
    }
}

#[test]
fn vertices_at_one_position_share_their_mean() {
    // A roof whose ridge is split, one of its ends written with −0.
    let positions = vec![
        Vec3::new(-1.0, -1.0, 0.0),
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(0.0, 0.0, -2.0),
        Vec3::new(1.0, -1.0, 0.0),
        Vec3::new(-0.0, 0.0, -0.0),
        Vec3::new(0.0, -0.0, -2.0),
    ];
    let (normals, _) = weighted(positions, vec![0, 1, 2, 3, 5, 4], NormalWeighting::Area);
    for ridge in [1, 2, 4, 5] {
        assert!(normals[ridge].distance(Vec3::Y) < 3.0 * ROUNDING, "{ridge}: {}", normals[ridge]);
    }
}

#[test]
fn degenerate_triangles_add_nothing() {
    let mut positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    positions.extend([Vec3::X * 0.5, Vec3::new(0.5, 1e-9, 0.3e-9), Vec3::Z]);
    let indices = vec![0, 1, 2, 0, 1, 3, 0, 1, 4, 1, 1, 0, 3, 3, 3];
    for weighting in WEIGHTINGS {
        let (normals, report) = weighted(positions.clone(), indices.clone(), weighting);
        assert_eq!(normals[..3], [Vec3::Z; 3]);
        // Vertices 3 and 4 have degenerate triangles alone, vertex 5 none.
        assert_eq!(normals[3..], [Vec3::Y; 3]);
        let expected = NormalReport { degenerate_triangles: 4, without_face: 3, ..NormalReport::default() };
        assert_eq!(report, expected);
    }
}

#[test]
fn cancelled_means_take_the_largest_face() {
    // A small and a large triangle, the large one seen from behind, meet in vertex 0 with equal angles; a second pair
    // of equal triangles lies apart: there the first wins.
    let positions =
        vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 3.0, Vec3::Y * 3.0, Vec3::Z, Vec3::Z + Vec3::X, Vec3::Z + Vec3::Y];
    let indices = vec![0, 1, 2, 0, 4, 3, 5, 6, 7, 5, 7, 6];
    for weighting in [NormalWeighting::Uniform, NormalWeighting::Angle] {
        let (normals, report) = weighted(positions.clone(), indices.clone(), weighting);
        assert_eq!(normals[0], Vec3::NEG_Z, "{weighting:?}");
        assert_eq!(normals[5..], [Vec3::Z; 3], "{weighting:?}");
        assert_eq!(report, NormalReport { cancelled: 4, ..NormalReport::default() });
    }
}

#[test]
fn means_that_rounding_alone_decides_count_as_cancelled() {
    // A sheet folded onto itself but for a hundred-millionth; its mean is (0, 1e-8, 0) and means nothing.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, 1.0, 1e-8)];
    let (normals, report) = weighted(positions, vec![0, 1, 2, 0, 3, 1], NormalWeighting::Angle);
    assert_eq!(normals[..2], [Vec3::Z; 2]);
    assert_eq!(report, NormalReport { cancelled: 2, ..NormalReport::default() });
}

#[test]
fn flat_meshes_have_corners_of_their_own() {
    let (mut positions, mut indices) = cube(0);
    positions.push(Vec3::X * 5.0);
    indices.extend([0, 0, 8]);
    let uvs = Some(positions.iter().map(|p| p.truncate()).collect());
    let mesh = Mesh::from_parts(positions.clone(), None, uvs, indices.clone()).unwrap();
    let (flat, report) = mesh.with_normals(Normals::Face);
    assert_eq!(report, NormalReport { degenerate_triangles: 1, ..NormalReport::default() });
    assert_eq!((flat.positions().len(), flat.triangle_count()), (39, 13));
    for (corner, &index) in indices.iter().enumerate() {
        assert_eq!(flat.positions()[corner], positions[index as usize]);
        assert_eq!(flat.uvs().unwrap()[corner], positions[index as usize].truncate());
    }
    for triangle in flat.triangles().take(12) {
        let [a, b, c] = triangle.map(|i| flat.positions()[i as usize]);
        assert_eq!(triangle.map(|i| flat.normals()[i as usize]), [face_normal(a, b, c).unwrap(); 3]);
    }
    assert_eq!(flat.normals()[36..], [Vec3::Y; 3]);
}

#[test]
fn given_normals_are_kept_at_unit_length() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    let given = vec![Vec3::X * 1e-44, Vec3::splat(3e38), Vec3::new(0.0, 3.0, -4.0), Vec3::ZERO];
    let (mesh, report) = Mesh::from_parts_reported(positions, Some(given), None, vec![0, 1, 2, 1, 3, 2]).unwrap();
    let expected = [Vec3::X, Vec3::ONE.normalize(), Vec3::new(0.0, 0.6, -0.8), Vec3::Z];
    for (n, e) in mesh.normals().iter().zip(expected) {
        assert!(n.distance(e) < 3.0 * ROUNDING, "{n} {e}");
    }
    assert_eq!(report, NormalReport { replaced: 1, ..NormalReport::default() });
    let (kept, report) = mesh.clone().with_normals(Normals::Keep);
    assert_eq!(kept, mesh);
    assert!(report.is_clean());
}

#[test]
fn the_number_of_threads_does_not_matter() {
    // More triangles than one thread takes at a time.
    let mesh = Mesh::from(UvSphere::new(1.0, 200, 100));
    for policy in WEIGHTINGS.map(Normals::Weighted).into_iter().chain([Normals::Face]) {
        let [one, five] = [1, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| mesh.clone().with_normals(policy))
        });
        assert_eq!(one, five, "{policy:?}");
    }
}

#[test]
fn normals_that_a_mesh_has_are_those_that_are_computed() {
    // A fold whose normals cancel, a triangle without area, and a vertex of none.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, 2.0 * Vec3::X, Vec3::ONE];
    let indices = vec![0, 1, 2, 0, 2, 1, 0, 1, 4];
    let (mesh, report) = Mesh::from_parts_reported(positions.clone(), None, None, indices.clone()).unwrap();
    let given = vec![Vec3::Z; positions.len()];
    let other = Mesh::from_parts(positions, Some(given), None, indices).unwrap();
    let policy = Normals::Weighted(NormalWeighting::default());
    let (known, known_report) = mesh.clone().with_normals(policy);
    let (computed, computed_report) = other.clone().with_normals(policy);
    assert!(!report.is_clean());
    assert_eq!((known.normals(), known_report), (computed.normals(), computed_report));
    assert_eq!(known_report, report);
    assert!(known.has_given_normals() && !mesh.has_given_normals());
    // Moved vertices keep their normals until others are asked for.
    let moved: Vec<Vec3> = mesh.positions().iter().map(|p| Vec3::new(p.z, p.x + p.z, p.y)).collect();
    let [mut mesh, mut other] = [mesh, other];
    mesh.set_positions(moved.clone()).unwrap();
    other.set_positions(moved).unwrap();
    assert_eq!(mesh.with_normals(policy), other.with_normals(policy));
}

//! Normals that suit a mesh without any: creases in made parts, none in scans.

use std::fmt::Write as _;

use glam::Vec3;
use halfway_mesh::{Cuboid, Format, Icosphere, Mesh, NormalWeighting, Normals, Plane, Subdivision, Teapot, load_bytes};

const SMOOTH: Normals = Normals::Weighted(NormalWeighting::Max);

/// The same triangles as a file without normals gives them.
fn bare(mesh: impl Into<Mesh>) -> Mesh {
    let mesh = mesh.into();
    Mesh::new(mesh.positions().to_vec(), mesh.indices().to_vec()).unwrap()
}

fn is_creased(mesh: &Mesh) -> bool {
    match mesh.suited_normals() {
        Normals::Creased { angle, .. } => {
            assert!((30.0..65.0).contains(&angle.to_degrees()), "{angle}");
            true
        }
        other => {
            assert_eq!(other, SMOOTH);
            false
        }
    }
}

/// A ball whose vertices are moved in and out by a part of the radius, as a scanner's noise does.
fn noisy_ball(share: f32) -> Mesh {
    let ball = Mesh::from(Icosphere { radius: 1.0, divisions: 20 });
    let mut seed = 1_u32;
    let mut noise = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
    };
    let moved = ball.positions().iter().map(|&p| p * (1.0 + share * noise())).collect::<Vec<Vec3>>();
    Mesh::new(moved, ball.indices().to_vec()).unwrap()
}

#[test]
fn the_shape_decides_about_creases() {
    let pyramid =
        b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 4 3 2\nf 4 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    let pyramid = load_bytes(Format::Smf, pyramid).unwrap().parts.remove(0).mesh;
    for (name, mesh, creased) in [
        ("cube", bare(Cuboid::default()), true),
        ("pyramid", pyramid, true),
        ("ball", bare(Icosphere { radius: 1.0, divisions: 12 }), false),
        ("teapot", bare(Teapot::new(8)), false),
        ("plane", bare(Plane { size: 1.0, divisions: 8 }), false),
        ("scan", noisy_ball(0.003), false),
        ("rough scan", noisy_ball(0.01), false),
    ] {
        assert_eq!(is_creased(&mesh), creased, "{name}");
    }
}

#[test]
fn only_normals_that_nobody_gave_are_replaced() {
    let cube = Mesh::from(Cuboid::default()).with_normals(SMOOTH).0;
    assert!(cube.has_given_normals());
    assert_eq!(cube.clone().with_normals(Normals::Auto).0, cube);
    let without = bare(Cuboid::default());
    assert!(!without.has_given_normals());
    let (made, report) = without.with_normals(Normals::Auto);
    assert!(report.is_clean() && made.has_given_normals());
    assert!(made.normals().iter().all(|n| n.abs().max_element() > 0.999), "each side is flat");
}

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

#[test]
fn files_say_whether_they_have_normals() {
    let faces = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";
    for (between, given) in [("", false), ("s 1\n", true), ("g other\n", false)] {
        let text = format!("{CUBE}{}{between}{}", &faces[..20], &faces[20..]);
        let model = load_bytes(Format::Obj, text.as_bytes()).unwrap();
        assert!(model.parts.iter().all(|part| part.mesh.has_given_normals() == given), "{between:?}");
    }
    let text = format!("{CUBE}vn 0 0 1\nf 5//1 6//1 7//1\n");
    assert!(load_bytes(Format::Obj, text.as_bytes()).unwrap().parts[0].mesh.has_given_normals());
}

#[test]
fn borders_of_parts_are_no_creases() {
    // A cylinder of sixteen sides, cut into two materials.
    let (mut vertices, mut faces) = (String::new(), [String::new(), String::new()]);
    for i in 0..16_u32 {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / 16.0).sin_cos();
        writeln!(vertices, "v {cos} {sin} 0\nv {cos} {sin} 1").unwrap();
        let [a, b] = [2 * i + 1, 2 * ((i + 1) % 16) + 1];
        writeln!(faces[usize::from(i >= 8)], "f {a} {b} {} {}", b + 1, a + 1).unwrap();
    }
    let ring = |from: u32| (0..16).map(|i| (2 * i + 1 + from).to_string()).collect::<Vec<_>>();
    let (floor, lid) = (ring(0).into_iter().rev().collect::<Vec<_>>(), ring(1));
    let caps = format!("f {}\nf {}\n", floor.join(" "), lid.join(" "));
    let text = format!("{vertices}g a\n{}g b\n{}{caps}", faces[0], faces[1]);
    let mut model = load_bytes(Format::Obj, text.as_bytes()).unwrap();
    assert_eq!(model.parts.len(), 2);
    model.make_auto_normals();
    for part in &model.parts {
        let mesh = &part.mesh;
        for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
            let outward = Vec3::new(p.x, p.y, 0.0);
            let is_side = n.z.abs() < 1e-3 && n.dot(outward) > 0.999;
            assert!(is_side || n.z.abs() > 0.999, "{p} {n}: round at the sides, flat at the ends");
        }
    }
}

#[test]
fn open_meshes_have_a_border() {
    assert!(bare(Plane::default()).is_open());
    assert!(!bare(Icosphere::default()).is_open());
    // The sides of the box share no vertices, but positions.
    assert!(!Mesh::from(Cuboid::default()).is_open());
    // So large that the edges at some of the points are looked at first. A second face in the place of one of the
    // tetrahedron's gives three triangles to each of its sides: no border either.
    let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let (closed, second) = (vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3], vec![0, 1, 2]);
    for (indices, is_open) in
        [(closed.clone(), false), ([closed.clone(), second].concat(), false), (closed[..9].to_vec(), true)]
    {
        let mesh = Mesh::new(points.clone(), indices).unwrap().subdivided(Subdivision::Midpoint, 7).unwrap();
        assert!(mesh.triangle_count() > 30_000);
        assert_eq!(bare(mesh).is_open(), is_open);
    }
}

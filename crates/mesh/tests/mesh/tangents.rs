//! Tangents.
#![expect(clippy::float_cmp, reason = "w is 1 or −1")]

use glam::{Vec2, Vec3, Vec4};
use halfway_mesh::{Mesh, MeshError, Normals, UvSphere};

/// A unit square in the plane z = 0 seen from +Z, its texture upright, scaled.
fn square(scale: f32) -> Mesh {
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let positions = corners.iter().map(|c| (*c * scale).extend(0.0)).collect();
    let uvs = corners.iter().map(|c| Vec2::new(c.x, 1.0 - c.y)).collect();
    Mesh::from_parts(positions, None, Some(uvs), vec![0, 1, 2, 0, 2, 3]).unwrap()
}

#[test]
fn an_upright_picture_has_tangent_right_and_bitangent_up() {
    for scale in [1e-18, 1e-6, 1.0, 1e6, 1e18] {
        let mesh = square(scale).with_tangents().unwrap();
        assert_eq!(mesh.positions().len(), 4);
        for (n, t) in mesh.normals().iter().zip(mesh.tangents().unwrap()) {
            assert!(t.distance(Vec4::new(1.0, 0.0, 0.0, 1.0)) < 1e-6, "{scale:e}: {t}");
            assert!((n.cross(t.truncate()) * t.w).distance(Vec3::Y) < 1e-6);
        }
    }
}

#[test]
fn a_mirrored_picture_splits_its_seam() {
    // Two squares side by side, the second with the picture mirrored; they share the edge x = 1.
    let positions =
        [0.0, 1.0, 2.0].into_iter().flat_map(|x| [Vec3::new(x, 0.0, 0.0), Vec3::new(x, 1.0, 0.0)]).collect();
    let uvs = [0.0, 1.0, 0.0].into_iter().flat_map(|u| [Vec2::new(u, 1.0), Vec2::new(u, 0.0)]).collect();
    let indices = vec![0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3];
    let mesh = Mesh::from_parts(positions, None, Some(uvs), indices).unwrap().with_tangents().unwrap();
    assert_eq!((mesh.positions().len(), mesh.triangle_count()), (8, 4));
    for (i, triangle) in mesh.triangles().enumerate() {
        let expected = if i < 2 { Vec4::new(1.0, 0.0, 0.0, 1.0) } else { Vec4::new(-1.0, 0.0, 0.0, -1.0) };
        assert!(triangle.iter().all(|&v| mesh.tangents().unwrap()[v as usize].distance(expected) < 1e-6));
    }
}

#[test]
fn a_sphere_has_tangents_along_its_parallels() {
    let mesh = Mesh::from(UvSphere::new(3.0, 48, 24)).with_tangents().unwrap();
    for ((p, n), t) in mesh.positions().iter().zip(mesh.normals()).zip(mesh.tangents().unwrap()) {
        let t3 = t.truncate();
        assert!(t.is_finite() && (t3.length() - 1.0).abs() < 1e-6 && t3.dot(*n).abs() < 1e-6);
        if p.y.abs() < 2.5 {
            // u falls from +X toward +Z; the mean over flat triangles of 7.5° is off by less than that. Nearer to the
            // poles their texture is sheared.
            let along = Vec3::new(p.z, 0.0, -p.x).normalize();
            assert!(t3.dot(along) > 7.5_f32.to_radians().cos() && t.w > 0.0, "{p} {t}");
        }
    }
}

#[test]
fn without_texture_coordinates_or_with_useless_ones() {
    let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2]).unwrap();
    assert_eq!(mesh.with_tangents().unwrap_err(), MeshError::NoUvs);
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO];
    let mesh = Mesh::from_parts(positions, None, Some(vec![Vec2::ONE; 4]), vec![0, 1, 2, 0, 0, 0, 3, 3, 1]).unwrap();
    let mesh = mesh.with_tangents().unwrap();
    for (n, t) in mesh.normals().iter().zip(mesh.tangents().unwrap()) {
        let t3 = t.truncate();
        assert!((t3.length() - 1.0).abs() < 1e-6 && t3.dot(*n).abs() < 1e-6 && t.w.abs() == 1.0, "{n} {t}");
    }
}

#[test]
fn new_normals_drop_the_tangents() {
    let mesh = square(1.0).with_tangents().unwrap();
    assert!(mesh.clone().with_normals(Normals::Keep).0.tangents().is_some());
    assert!(mesh.with_normals(Normals::Face).0.tangents().is_none());
}

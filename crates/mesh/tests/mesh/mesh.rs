//! The mesh: invalid input, attributes, problems.

use bevy_app::App;
use bevy_transform::components::Transform;
use glam::{Vec2, Vec3};
use halfway_asset::Assets;
use halfway_mesh::{Cuboid, Mesh, Mesh3d, MeshError, MeshPlugin, NormalWeighting, Normals, Plane, Problems, UvSphere};

fn triangle() -> Vec<Vec3> {
    vec![Vec3::ZERO, Vec3::X, Vec3::Y]
}

/// A row of the table of what is refused: normals, uvs, positions and indices of one triangle with a fault, and the
/// error.
type Refused = (&'static str, Vec<Vec3>, Option<Vec<Vec3>>, Option<Vec<Vec2>>, Vec<u32>, MeshError);

fn refused() -> Vec<Refused> {
    let all = || vec![0, 1, 2];
    let not_finite = |attribute, vertex, value| MeshError::NotFinite { attribute, vertex, value };
    let inf = f32::INFINITY;
    vec![
        ("nothing", vec![], None, None, vec![], MeshError::NoTriangles),
        ("no triangles", triangle(), None, None, vec![], MeshError::NoTriangles),
        ("two indices", triangle(), None, None, vec![0, 1], MeshError::PartialTriangle { count: 2 }),
        ("four indices", triangle(), None, None, vec![0, 1, 2, 0], MeshError::PartialTriangle { count: 4 }),
        (
            "index out of range",
            triangle(),
            None,
            None,
            vec![0, 1, 2, 0, 3, 1],
            MeshError::IndexOutOfRange { triangle: 1, corner: 1, index: 3, vertices: 3 },
        ),
        (
            "no vertices",
            vec![],
            None,
            None,
            all(),
            MeshError::IndexOutOfRange { triangle: 0, corner: 0, index: 0, vertices: 0 },
        ),
        (
            "infinite position",
            vec![Vec3::ZERO, Vec3::new(1.0, inf, 0.0), Vec3::Y],
            None,
            None,
            all(),
            not_finite("position", 1, [1.0, inf, 0.0]),
        ),
        (
            "infinite normal",
            triangle(),
            Some(vec![Vec3::Z, Vec3::Z, Vec3::new(0.0, 0.0, -inf)]),
            None,
            all(),
            not_finite("normal", 2, [0.0, 0.0, -inf]),
        ),
        (
            "infinite uv",
            triangle(),
            None,
            Some(vec![Vec2::ZERO, Vec2::new(inf, 0.5), Vec2::ONE]),
            all(),
            not_finite("uv", 1, [inf, 0.5, 0.0]),
        ),
        (
            "two normals",
            triangle(),
            Some(vec![Vec3::Z; 2]),
            None,
            all(),
            MeshError::CountMismatch { attribute: "normal", found: 2, expected: 3 },
        ),
        (
            "four uvs",
            triangle(),
            None,
            Some(vec![Vec2::ZERO; 4]),
            all(),
            MeshError::CountMismatch { attribute: "uv", found: 4, expected: 3 },
        ),
    ]
}

#[test]
fn bad_meshes_are_refused_by_element() {
    for (name, positions, normals, uvs, indices, expected) in refused() {
        let found = Mesh::from_parts(positions, normals, uvs, indices).unwrap_err();
        assert_eq!(found, expected, "{name}");
    }
    // NaN is unequal to itself, so by its message.
    let found = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0)], vec![0, 1, 2]).unwrap_err();
    assert_eq!(found.to_string(), "vertex 2: position [0.0, NaN, 0.0]; finite numbers are expected");
}

#[test]
fn a_mesh_keeps_what_it_is_given() {
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
    let mesh = Mesh::from_parts(triangle(), None, Some(uvs.clone()), vec![0, 1, 2, 0, 2, 1]).unwrap();
    assert_eq!(mesh.positions(), triangle());
    assert_eq!(mesh.uvs(), Some(&uvs[..]));
    assert_eq!(mesh.triangle_count(), 2);
    assert_eq!(mesh.triangles().len(), 2);
    assert_eq!(mesh.triangles().collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 1]]);
    assert_eq!((mesh.bounds().min, mesh.bounds().max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
}

#[test]
fn clones_share_their_data() {
    let mesh = Mesh::from(Cuboid::default());
    let clone = mesh.clone();
    assert_eq!(mesh.positions().as_ptr(), clone.positions().as_ptr());
    // A clone that changes its normals leaves the other alone.
    let before = mesh.normals().to_vec();
    let (changed, _) = clone.with_normals(Normals::Weighted(NormalWeighting::Angle));
    assert_ne!(changed.normals(), before);
    assert_eq!(mesh.normals(), before);
}

#[test]
fn problems_are_counted() {
    let square = vec![Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y];
    let with = |extra: &[Vec3]| [&square[..], extra].concat();
    let rows: [(&str, Vec<Vec3>, Vec<u32>, Problems); 7] = [
        ("square", square.clone(), vec![0, 1, 2, 0, 2, 3], Problems { open_edges: 4, ..Problems::default() }),
        (
            "unused vertex",
            with(&[Vec3::Z]),
            vec![0, 1, 2, 0, 2, 3],
            Problems { open_edges: 4, unused_vertices: 1, ..Problems::default() },
        ),
        (
            "degenerate triangle",
            square.clone(),
            vec![0, 1, 2, 0, 2, 3, 1, 1, 2],
            Problems { open_edges: 3, crowded_edges: 1, degenerate_triangles: 1, ..Problems::default() },
        ),
        (
            "one flipped",
            square.clone(),
            vec![0, 1, 2, 0, 3, 2],
            // The two lie in one plane and cancel out where both meet.
            Problems { open_edges: 4, misoriented_edges: 1, cancelled_normals: 2, ..Problems::default() },
        ),
        (
            "triangle twice",
            square.clone(),
            vec![0, 1, 2, 0, 2, 3, 2, 0, 1],
            Problems {
                open_edges: 2,
                crowded_edges: 1,
                misoriented_edges: 2,
                duplicate_triangles: 1,
                ..Problems::default()
            },
        ),
        (
            "duplicate vertex",
            with(&[Vec3::ZERO]),
            vec![0, 1, 2, 4, 2, 3],
            Problems { open_edges: 4, duplicate_vertices: 1, ..Problems::default() },
        ),
        (
            "folded",
            square,
            vec![0, 1, 2, 2, 1, 0],
            Problems { duplicate_triangles: 1, cancelled_normals: 3, unused_vertices: 1, ..Problems::default() },
        ),
    ];
    for (name, positions, indices, expected) in rows {
        let mesh = Mesh::new(positions, indices).unwrap();
        assert_eq!(mesh.report().problems, expected, "{name}");
    }
    assert!(Mesh::from(Cuboid::default()).report().problems.is_none());
    assert_eq!(Problems::default().to_string(), "none");
    let some = Problems { degenerate_triangles: 1, open_edges: 12, ..Problems::default() };
    assert_eq!(some.to_string(), "1 degenerate triangle, 12 open edges");
}

#[test]
fn the_plugin_stands_alone() {
    let mut app = App::new();
    app.add_plugins(MeshPlugin);
    let handle = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let entity = app.world_mut().spawn(Mesh3d(handle.clone())).id();
    app.update();
    assert_eq!(app.world().get::<Mesh3d>(entity), Some(&Mesh3d(handle.clone())));
    assert!(app.world().get::<Transform>(entity).is_some());
    let meshes = app.world().resource::<Assets<Mesh>>();
    assert_eq!(meshes.get(&handle).map(Mesh::triangle_count), Some(12));
}

#[test]
fn adding_the_mesh_plugin_again_keeps_meshes() {
    let triangles = |app: &App, handle| app.world().resource::<Assets<Mesh>>().get(handle).map(Mesh::triangle_count);
    let mut app = App::new();
    // Somebody had meshes before any plugin.
    app.init_resource::<Assets<Mesh>>();
    let early = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    app.add_plugins(MeshPlugin);
    let second = app.world_mut().resource_mut::<Assets<Mesh>>().add(UvSphere::new(1.0, 4, 2));
    assert_ne!(early, second);
    app.add_plugins(MeshPlugin);
    app.update();
    app.add_plugins((MeshPlugin, MeshPlugin));
    app.update();
    assert_eq!((triangles(&app, &early), triangles(&app, &second)), (Some(12), Some(8)));

    let id = early.id();
    // Without a handle it is removed.
    drop(early);
    app.update();
    app.update();
    assert!(app.world().resource::<Assets<Mesh>>().get(id).is_none());
}

#[test]
fn moved_vertices_keep_what_is_theirs() {
    let plane = Mesh::from(Plane { size: 2.0, divisions: 3 });
    let mut mesh = plane.clone();
    let moved: Vec<Vec3> = plane.positions().iter().map(|p| *p + Vec3::Y * p.x).collect();
    mesh.set_positions(moved.clone()).unwrap();
    assert_eq!((mesh.positions(), mesh.normals()), (moved.as_slice(), plane.normals()));
    assert_eq!((mesh.uvs(), mesh.indices()), (plane.uvs(), plane.indices()));
    assert_eq!((mesh.bounds().min.y, mesh.bounds().max.y), (-1.0, 1.0));
    assert!(plane.bounds().max.y.abs() < f32::EPSILON, "a clone is not changed");
    assert!(mesh.surface().is_none());
    mesh.set_normals(vec![Vec3::X * 3.0; moved.len()]).unwrap();
    assert!(mesh.normals().iter().all(|n| *n == Vec3::X));

    let before = mesh.clone();
    let error = mesh.set_positions(vec![Vec3::ZERO]).unwrap_err().to_string();
    assert!(error.contains(&format!("1 positions for {} vertices", moved.len())), "{error}");
    assert!(mesh.set_positions(vec![Vec3::NAN; moved.len()]).is_err());
    assert!(mesh.set_normals(vec![Vec3::NAN; moved.len()]).is_err());
    assert_eq!(mesh, before);
}

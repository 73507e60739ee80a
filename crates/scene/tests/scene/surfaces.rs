//! Surfaces by their names, displacement and creases: the meshes are those that code makes.

use std::path::Path;

use bevy_math::{DVec3, Vec3};
use halfway_asset::Assets;
use halfway_mesh::{
    BezierPatch, Capsule, Cone, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet, Icosphere, Mesh,
    Mesh3d, NormalWeighting, Normals, Paraboloid, ParametricSurface, Plane, Tessellation, Torus,
};

use crate::spawned::app;
use halfway_scene::{SceneFile, spawn};

/// The mesh of an object with these keys, and the warnings.
fn made(object: &str, dir: &Path) -> (Mesh, Vec<String>) {
    let scene = SceneFile::from_json(&format!("{{\"objects\": [{{{object}}}]}}"), "test").unwrap();
    let again = SceneFile::from_json(&scene.to_json().unwrap(), "again").unwrap();
    assert_eq!(again, scene);
    let mut app = app();
    let spawned = spawn(&scene, dir, app.world_mut()).unwrap();
    let Mesh3d(handle) = app.world().get::<Mesh3d>(spawned.objects[0]).unwrap().clone();
    let mesh = app.world().resource::<Assets<Mesh>>().get(&handle).unwrap().clone();
    (mesh, spawned.warnings)
}

fn cut(rows: u32, columns: u32) -> Tessellation {
    Tessellation::Count { rows, columns }
}

#[test]
fn every_surface_is_the_one_of_its_name() {
    let fine = Tessellation::ChordError(f64::from(0.01_f32));
    let sheet = HyperboloidSheet { gap: 1.0, radius: 1.0, height: 1.0, upper: false };
    let points = [[1.0, -1.0], [1.0, -1.0]].concat().into_iter().zip([-1.0, -1.0, 1.0, 1.0]);
    let patch = BezierPatch::new(2, points.map(|(x, z)| DVec3::new(x, 0.0, z)).collect()).unwrap();
    let hill = HeightField::new(2.0, 4.0, 2, vec![0.0, 0.5, 1.0, 1.5]).unwrap();
    let waves = HeightField::new(2.0, 2.0, 2, vec![0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]).unwrap();
    let all: [(&str, Mesh); 15] = [
        (r#"{"icosphere": {"divisions": 3}}"#, Icosphere::new(1.0, 3).into()),
        (
            r#"{"ellipsoid": {"radii": [1, 2, 3], "chord_error": 0.01}}"#,
            Ellipsoid { radii: Vec3::new(1.0, 2.0, 3.0) }.mesh(fine).unwrap(),
        ),
        (r#"{"cylinder": {}}"#, Cylinder { radius: 1.0, height: 2.0, capped: true }.mesh(cut(1, 32)).unwrap()),
        (
            r#"{"cone": {"capped": false, "rows": 2, "columns": 9}}"#,
            Cone { radius: 1.0, height: 2.0, capped: false }.mesh(cut(2, 9)).unwrap(),
        ),
        (r#"{"torus": {}}"#, Torus { radius: 1.0, tube: 0.25 }.mesh(cut(16, 48)).unwrap()),
        (r#"{"capsule": {"chord_error": 0.01}}"#, Capsule { radius: 0.5, length: 1.0 }.mesh(fine).unwrap()),
        (
            r#"{"disc": {"center": [0, 1, 0], "normal": [0, 0, 2]}}"#,
            Disc::new(DVec3::Y, DVec3::Z, 1.0).unwrap().mesh(cut(1, 48)).unwrap(),
        ),
        (r#"{"paraboloid": {}}"#, Paraboloid { radius: 1.0, height: 1.0 }.mesh(cut(16, 32)).unwrap()),
        (r#"{"hyperboloid": {}}"#, Hyperboloid { waist: 0.5, radius: 1.0, height: 2.0 }.mesh(cut(16, 32)).unwrap()),
        (r#"{"hyperboloid_sheet": {"upper": false}}"#, sheet.mesh(cut(16, 32)).unwrap()),
        (r#"{"bezier": {}}"#, patch.mesh(cut(16, 16)).unwrap()),
        (r#"{"polynomial": {}}"#, patch.mesh(cut(16, 16)).unwrap()),
        (
            r#"{"height_field": {"size": [2, 4], "amount": 0.5, "heights": [[0, 1], [2, 3]], "rows": 3, "columns": 5}}"#,
            hill.mesh(cut(3, 5)).unwrap(),
        ),
        (
            r#"{"height_field": {"size": [2, 4], "amount": 1.5, "path": "hill.png", "rows": 3, "columns": 5}}"#,
            hill.mesh(cut(3, 5)).unwrap(),
        ),
        // As fine as its samples, whatever is asked for.
        (
            r#"{"height_field": {"heights": [[0, 1], [1, 0], [0, 0], [1, 1]], "rows": 1, "columns": 1}}"#,
            waves.mesh(cut(3, 1)).unwrap(),
        ),
    ];
    let dir = std::env::temp_dir().join(format!("halfway-scene-surfaces-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    // 0, 1/3, 2/3 and 1.
    let hill = image::GrayImage::from_raw(2, 2, vec![0, 85, 170, 255]).unwrap();
    hill.save(dir.join("hill.png")).unwrap();
    for (surface, expected) in all {
        let (mesh, warnings) = made(&format!("\"mesh\": {surface}"), &dir);
        assert_eq!(mesh.indices(), expected.indices(), "{surface}");
        assert_eq!(mesh.positions().len(), expected.positions().len(), "{surface}");
        for (found, expected) in mesh.positions().iter().zip(expected.positions()) {
            assert!((found - expected).length() < 1e-6, "{surface}: {found} for {expected}");
        }
        assert_eq!(warnings, [""; 0], "{surface}");
        // The oracle can draw the surface itself where code's can.
        assert_eq!(mesh.surface().is_some(), expected.surface().is_some(), "{surface}");
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn a_height_field_without_its_file_is_refused() {
    let scene = r#"{"objects": [{"mesh": {"height_field": {"path": "nowhere.png"}}}]}"#;
    let scene = SceneFile::from_json(scene, "test").unwrap();
    let error = spawn(&scene, Path::new("dir"), app().world_mut()).unwrap_err().to_string();
    let place = Path::new("dir").join("nowhere.png");
    assert!(error.starts_with("scene: `objects[0].mesh.height_field`: "), "{error}");
    assert!(error.contains(&place.display().to_string()), "{error}");
}

#[test]
fn images_displace_vertices_and_creases_split_them() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-displaced-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let ramp = image::GrayImage::from_raw(2, 1, vec![0, 255]).unwrap();
    ramp.save(dir.join("ramp.png")).unwrap();
    let plane = Mesh::from(Plane { size: 2.0, divisions: 8 });
    let relief = r#""displacement": {"path": "ramp.png", "amount": 0.5, "wrap_u": "clamp"}"#;
    let (mesh, warnings) = made(&format!(r#""mesh": {{"plane": {{"divisions": 8}}}}, {relief}"#), &dir);
    assert_eq!(warnings, [""; 0]);
    for (moved, (p, uv)) in mesh.positions().iter().zip(plane.positions().iter().zip(plane.uvs().unwrap())) {
        // Between the middles of the two texels the number rises by its share of the way.
        let height = 0.5 * ((uv.x - 0.25) / 0.5).clamp(0.0, 1.0);
        assert!((*moved - (*p + Vec3::Y * height)).length() < 1e-6, "{moved} at {uv}");
    }
    let (sphere, warnings) = made(&format!(r#""mesh": {{"icosphere": {{}}}}, {relief}"#), &dir);
    assert_eq!(sphere.positions(), Mesh::from(Icosphere::default()).positions());
    assert_eq!(warnings, ["objects[0]: has no texture coordinates, and is not displaced"]);
    let (_, warnings) = made(r#""mesh": {"box": {}}, "displacement": {"path": "nowhere.png"}"#, &dir);
    assert!(
        warnings[0].starts_with("objects[0].displacement: ") && warnings[0].contains("nowhere.png"),
        "{warnings:?}"
    );
    for (given, angle, weighting) in [
        (r#"{"creased": {}}"#, 30_f32, NormalWeighting::Max),
        (r#"{"creased": {"angle_deg": 47.3, "weighting": "area"}}"#, 47.3, NormalWeighting::Area),
    ] {
        let (cylinder, _) = made(&format!(r#""mesh": {{"icosphere": {{"divisions": 1}}}}, "normals": {given}"#), &dir);
        let normals = Normals::Creased { angle: angle.to_radians(), weighting };
        let (expected, _) = Mesh::from(Icosphere::new(1.0, 1)).with_normals(normals);
        assert_eq!(cylinder.normals(), expected.normals(), "{given}");
    }
    std::fs::remove_dir_all(&dir).unwrap();
}

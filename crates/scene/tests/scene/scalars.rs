//! Numbers on meshes, by properties of files and written out; legends.

use std::path::Path;

use bevy_app::App;
use halfway_asset::Assets;
use halfway_lighting::{Legend, Material, Shading};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_scene::{SceneFile, Spawned, spawn};
use halfway_texture::{MapKind, Maps, TexturePlugin};

const SQUARE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float heat\nproperty uchar material_id\nelement face 1\nproperty float load\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 10 1\n1 0 0 20 1\n1 1 0 30 1\n0 1 0 nan 2\n7 4 0 1 2 3\n";

/// Spawns a scene of objects beside `square.ply`.
fn spawned(name: &str, objects: &str, more: &str) -> Result<(App, Spawned), String> {
    let folder = std::env::temp_dir().join(format!("halfway_scalars_{name}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("square.ply"), SQUARE).unwrap();
    let scene = SceneFile::from_json(&format!(r#"{{"objects": [{objects}]{more}}}"#), "test");
    let spawned = scene.and_then(|scene| {
        let mut app = super::spawned::app();
        app.add_plugins(TexturePlugin);
        spawn(&scene, &folder, app.world_mut()).map(|spawned| (app, spawned))
    });
    std::fs::remove_dir_all(Path::new(&folder)).unwrap();
    spawned.map_err(|error| error.to_string())
}

fn coordinates(app: &App, spawned: &Spawned) -> Vec<f32> {
    let mesh = app.world().get::<Mesh3d>(spawned.objects[0]).unwrap();
    let mesh = app.world().resource::<Assets<Mesh>>().get(&mesh.0).unwrap();
    // The middles of 1000 texels.
    mesh.uvs().unwrap().iter().map(|uv| if uv.y > 0.5 { f32::NAN } else { (uv.x * 1000.0 - 0.5) / 999.0 }).collect()
}

fn near(found: &[f32], expected: &[f32]) -> bool {
    found.len() == expected.len()
        && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4 || a.is_nan() && b.is_nan())
}

#[test]
fn a_property_becomes_coordinates_of_its_map() {
    let object = r#"{"mesh": {"path": "square.ply"}, "scalars": {"property": "heat"}}"#;
    let (app, of_heat) = spawned("heat", object, "").unwrap();
    let found = coordinates(&app, &of_heat);
    assert!(near(&found, &[0.0, 0.5, 1.0, f32::NAN]), "{found:?}");
    let maps = app.world().get::<Maps>(of_heat.objects[0]).unwrap();
    assert!(maps.get(MapKind::Color).is_some());
    let material = app.world().get::<Material>(of_heat.objects[0]).unwrap();
    assert_eq!((material.diffuse.red, material.specular.red), (1.0, 0.0));
    assert!(of_heat.warnings.iter().all(|warning| !warning.contains("skipped")), "{:?}", of_heat.warnings);
    // Each corner of both triangles of the face, which normals of faces do not change.
    for normals in ["keep", "face", "auto"] {
        let object = format!(
            r#"{{"mesh": {{"path": "square.ply"}}, "normals": "{normals}",
                "scalars": {{"property": "load", "range": [0, 10]}}, "shading": "unlit"}}"#
        );
        let (app, of_load) = spawned("load", &object, "").unwrap();
        assert!(near(&coordinates(&app, &of_load), &[0.7; 6]), "{normals}");
        assert_eq!(app.world().get::<Shading>(of_load.objects[0]), Some(&Shading::Unlit));
    }
}

#[test]
fn numbers_are_written_out() {
    let inline = r#""mesh": {"plane": {"divisions": 1}}"#;
    let object = format!(r#"{{{inline}, "scalars": {{"at_vertices": [0, 1, 2, 4]}}}}"#);
    let (app, vertices) = spawned("vertices", &object, "").unwrap();
    let found = coordinates(&app, &vertices);
    assert!(near(&found, &[0.0, 0.25, 0.5, 1.0]), "{found:?}");
    let object = format!(r#"{{{inline}, "scalars": {{"on_faces": [0, 1]}}}}"#);
    let (app, faces) = spawned("faces", &object, "").unwrap();
    assert!(near(&coordinates(&app, &faces), &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
}

#[test]
fn what_cannot_be_shown_is_said() {
    let square = r#""mesh": {"path": "square.ply"}"#;
    for (object, expected) in [
        (
            format!(r#"{{{square}, "scalars": {{"property": "cold"}}}}"#),
            r#"`objects[0].scalars`: the mesh has no property "cold"; it has "heat", "material_id", "load""#,
        ),
        (r#"{"mesh": {"box": {}}, "scalars": {"property": "heat"}}"#.to_owned(), "it has none"),
        (format!(r#"{{{square}, "scalars": {{"on_faces": [1]}}}}"#), "1 numbers for 2 faces; expected one each"),
        (format!(r#"{{{square}, "scalars": {{}}}}"#), "expected one of the keys property, at_vertices and on_faces"),
        (
            format!(r#"{{{square}, "scalars": {{"property": "heat", "range": [2, 2]}}}}"#),
            "`objects[0].scalars.range`: is [2, 2]; expected the lower number first",
        ),
        (
            format!(r#"{{{square}, "scalars": {{"property": "heat"}}, "maps": {{}}}}"#),
            "`objects[0].scalars`: cannot stand beside `maps`",
        ),
    ] {
        let error = spawned("errors", &object, "").map(|_| ()).unwrap_err();
        assert!(error.contains(expected), "{object}: {error}");
    }
}

#[test]
fn a_camera_with_a_legend_brings_it() {
    let object = r#"{"mesh": {"path": "square.ply"}, "scalars": {"property": "heat", "map": "magma"}}"#;
    let camera = r#", "camera": {"legend": "heat"}"#;
    let (app, _) = spawned("legend", object, camera).unwrap();
    let legend = app.world().resource::<Legend>();
    assert_eq!((legend.title.as_str(), legend.range, legend.colors.len()), ("heat", [10.0, 30.0], 256));
    let (app, spawned) = spawned("no_legend", r#"{"mesh": {"box": {}}}"#, camera).unwrap();
    assert!(!app.world().contains_resource::<Legend>());
    assert!(spawned.warnings.iter().any(|warning| warning.starts_with("legend: there are no numbers")));
}

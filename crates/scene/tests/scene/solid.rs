//! Solids in scene files: read, written, spawned, and refused.

use bevy_app::App;
use halfway_mesh::MeshPlugin;
use halfway_scene::{SceneFile, spawn};
use halfway_texture::{SolidKind, SolidTexture};
use std::path::Path;

fn scene(solid: &str) -> String {
    format!(r#"{{"objects": [{{"mesh": {{"box": {{}}}}, "solid": {solid}}}]}}"#)
}

fn spawned(scene: &SceneFile, folder: &Path) -> Vec<SolidTexture> {
    let mut app = App::new();
    app.add_plugins(MeshPlugin);
    spawn(scene, folder, app.world_mut()).expect("a sound scene");
    let mut query = app.world_mut().query::<&SolidTexture>();
    query.iter(app.world()).copied().collect()
}

#[test]
fn a_solid_is_read_written_and_spawned() {
    let text = scene(
        r#"{"kind": "wood", "octaves": 3, "colors": [[0.5, 0.25, 0.125], [0.1, 0.05, 0]],
            "transform": {"scale": [4, 2, 4], "translation": [0.5, 0, -1]}}"#,
    );
    let read = SceneFile::from_json(&text, "solid").expect("a sound scene");
    let again = SceneFile::from_json(&read.to_json().expect("it can be written"), "again").expect("what was written");
    assert_eq!(again, read);
    let expected = SolidTexture {
        kind: SolidKind::Wood,
        octaves: 3,
        solid_from_object: [[4.0, 0.0, 0.0, 0.5], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 4.0, -1.0]],
        colors: [[0.5, 0.25, 0.125], [0.1, 0.05, 0.0]],
    };
    assert_eq!(spawned(&read, Path::new(".")), [expected]);
    let plain = SceneFile::from_json(&scene("{}"), "plain").expect("all may be left out");
    assert_eq!(spawned(&plain, Path::new(".")), [SolidTexture::default()]);
    assert_eq!(spawned(&SceneFile::from_json(&scene("null"), "none").expect("none"), Path::new(".")), []);
}

#[test]
fn invalid_solids_are_refused_by_key() {
    for (solid, says) in [
        (r#"{"kind": "granite"}"#, r#"expected "checker", "marble", "wood" or "noise""#),
        (r#"{"octaves": 0}"#, "`objects[0].solid.octaves`: is 0; expected 1 to 16"),
        (r#"{"octaves": 17}"#, "`objects[0].solid.octaves`: is 17; expected 1 to 16"),
        (
            r#"{"colors": [[0, 0, 0], [0, 1.5, 0]]}"#,
            "`objects[0].solid.colors[1][1]`: is 1.5; expected a number from 0 to 1",
        ),
        (r#"{"transform": {"rotation": [0, 0, 0, 2]}}"#, "objects[0].solid.transform.rotation"),
        (r#"{"colour": 1}"#, "objects[0].solid.colour"),
        ("[]", "an object such as"),
    ] {
        let error = SceneFile::from_json(&scene(solid), "bad").expect_err(solid).to_string();
        assert!(error.contains(says), "{solid}: {error}");
    }
}

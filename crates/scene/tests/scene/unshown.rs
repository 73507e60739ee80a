//! Parts of a model file that a scene does not show are reported.

use std::path::PathBuf;

use bevy_app::App;
use bevy_transform::TransformPlugin;
use halfway_mesh::MeshPlugin;
use halfway_scene::{SceneFile, spawn};

/// A triangle with an opacity (OBJ), and one with a camera (glTF).
fn write_models(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("halfway-scene-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let triangle = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n";
    std::fs::write(dir.join("glass.mtl"), "newmtl glass\nd 0.5\n").unwrap();
    std::fs::write(dir.join("glass.obj"), format!("mtllib glass.mtl\n{triangle}usemtl glass\nf 1 2 3\n")).unwrap();
    let gltf = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}, {"camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 0, 1], "max": [1, 1, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "points.bin"}]}"#;
    std::fs::write(dir.join("seen.gltf"), gltf).unwrap();
    let points: [f32; 9] = [0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0];
    std::fs::write(dir.join("points.bin"), points.map(f32::to_le_bytes).concat()).unwrap();
    dir
}

#[test]
fn opacities_and_cameras_that_are_not_shown_are_warned_of() {
    let dir = write_models("unshown");
    let warnings = |object: &str| {
        let scene = SceneFile::from_json(&format!("{{\"objects\": [{{{object}}}]}}"), "test").unwrap();
        let mut app = App::new();
        app.add_plugins((MeshPlugin, TransformPlugin));
        spawn(&scene, &dir, app.world_mut()).unwrap().warnings
    };
    let at = |file: &str, what: &str| format!("{}: {what}", dir.join(file).display());
    let glass = r#""mesh": {"path": "glass.obj"}"#;
    let opacity = "objects[0]: 1 parts have an opacity below 1, which is not shown without \"blend\": true";
    assert_eq!(warnings(glass), [opacity]);
    // A file that sets the blending or the material gets no warning.
    for decided in [r#""blend": true"#, r#""blend": false"#, r#""material": "jade""#] {
        assert_eq!(warnings(&format!("{glass}, {decided}")), [""; 0], "{decided}");
    }
    let camera = at("seen.gltf", "1 cameras are not used; a scene has its own");
    assert_eq!(warnings(r#""mesh": {"path": "seen.gltf"}"#), [camera]);
    std::fs::remove_dir_all(&dir).unwrap();
}

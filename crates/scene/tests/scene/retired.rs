//! Files of before: `"auto"` is read, and what becomes of it is said.

use std::path::Path;

use bevy_app::App;
use halfway_lighting::Shading;
use halfway_mesh::MeshPlugin;
use halfway_scene::{SceneFile, spawn};

#[test]
fn auto_is_phong_with_one_warning_a_file() {
    let said = |place: &str, more: &str| {
        vec![format!("old.json:{place}: \"auto\" is no longer a shading; it is drawn as \"phong\"{more}")]
    };
    let object = |keys: &str| format!(r#"{{"objects": [{{"mesh": {{"box": {{}}}}, {keys}}}]}}"#);
    let auto = object(r#""shading": {"auto": {"tolerance": 2}}"#);
    let two = r#"{"shading": {"auto": {}}, "objects": [{"mesh": {"box": {}}, "shading": "auto"},
        {"name": "auto", "mesh": {"box": {}}, "shading": "flat"}, {"mesh": {"box": {}}, "shading": "auto"}]}"#;
    for (text, warnings) in [
        (r#"{"shading": "auto"}"#, said("1:13: `shading`", "")),
        (&auto, said("1:47: `objects[0].shading`", ", and its own tolerance is ignored")),
        (two, said("1:13: `shading`", " (here and in 2 more places)")),
        (r#"{"shading": "phong"}"#, Vec::new()),
        (&object(r#""name": "auto", "shading": "phong""#), Vec::new()),
    ] {
        let scene = SceneFile::from_json(text, "old.json").unwrap();
        assert_eq!(scene.warnings, warnings, "{text}");
        assert_eq!(scene.shading, Shading::Phong, "{text}");
        assert_eq!(scene.tolerance, None, "{text}");
        let written = SceneFile::from_json(&scene.to_json().unwrap(), "new.json").unwrap();
        assert_eq!(written, SceneFile { warnings: Vec::new(), ..scene.clone() }, "{text}");
        let mut app = App::new();
        app.add_plugins(MeshPlugin);
        assert_eq!(spawn(&scene, Path::new("."), app.world_mut()).unwrap().warnings, warnings, "{text}");
    }
}

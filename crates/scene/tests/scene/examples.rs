//! The example scenes: each is read, written and read again, and spawned.

use std::path::{Path, PathBuf};

use halfway_texture::TexturePlugin;

use crate::spawned::app;
use halfway_scene::{SceneFile, json_schema, spawn};

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
        .collect();
    files.sort();
    assert!(files.len() >= 6, "{}: {} scenes", folder.display(), files.len());
    files
}

#[test]
fn every_example_is_the_same_after_writing() {
    for file in examples() {
        let scene = SceneFile::read(&file).unwrap();
        let written = scene.to_json().unwrap();
        let again = SceneFile::from_json(&written, "written").unwrap();
        assert_eq!(again, scene, "{}", file.display());
    }
}

#[test]
fn every_example_can_be_spawned() {
    for file in examples() {
        let scene = SceneFile::read(&file).unwrap();
        let mut app = app();
        app.add_plugins(TexturePlugin);
        let spawned = spawn(&scene, file.parent().unwrap(), app.world_mut()).unwrap();
        assert_eq!(spawned.objects.len(), scene.objects.len(), "{}", file.display());
        assert!(!spawned.lights.is_empty(), "{}", file.display());
        assert_eq!(spawned.warnings, Vec::<String>::new(), "{}", file.display());
    }
}

/// The documentation shows one whole scene; it is one of the examples, letter for letter.
#[test]
fn the_documented_scene_is_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let docs = std::fs::read_to_string(root.join("docs/scene-format.md")).unwrap();
    let example = std::fs::read_to_string(root.join("examples/scenes/moonlit_table.json")).unwrap();
    assert!(docs.contains(&format!("```json\n{example}```")), "docs/scene-format.md shows another moonlit_table.json");
}

/// Every key and every word of the format, taken from the schema, stands in the documentation.
#[test]
fn every_key_is_documented() {
    fn names(value: &serde_json::Value, found: &mut Vec<String>) {
        match value {
            serde_json::Value::Object(members) => {
                if let Some(keys) = members.get("properties").and_then(serde_json::Value::as_object) {
                    found.extend(keys.keys().cloned());
                }
                found.extend(members.get("const").and_then(serde_json::Value::as_str).map(str::to_owned));
                members.values().for_each(|member| names(member, found));
            }
            serde_json::Value::Array(items) => items.iter().for_each(|item| names(item, found)),
            _ => {}
        }
    }

    let docs =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-format.md")).unwrap();
    let mut found = Vec::new();
    names(&serde_json::from_str(&json_schema()).unwrap(), &mut found);
    found.extend(halfway_lighting::Material::PRESETS.iter().map(|(name, _)| (*name).to_owned()));
    assert!(found.len() > 90, "{found:?}");
    for name in found {
        assert!(
            docs.contains(&format!("`{name}`")) || docs.contains(&format!("\"{name}\"")),
            "docs/scene-format.md does not mention {name}"
        );
    }
}

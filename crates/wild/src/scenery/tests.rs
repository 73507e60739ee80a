use std::collections::BTreeMap;

use halfway::scene::SceneFile;

use super::*;

/// Reads the scenes, which shows that the format has them, and counts the values of words and the kinds of others.
fn census(scenes: u64) -> BTreeMap<String, usize> {
    fn count(key: &str, value: &Value, census: &mut BTreeMap<String, usize>) {
        match value {
            Value::Object(keys) => {
                keys.iter().for_each(|(inner, value)| count(&format!("{key}.{inner}"), value, census))
            }
            Value::Array(items) => {
                items.iter().filter(|item| item.is_object()).for_each(|item| count(key, item, census))
            }
            Value::String(word) if !key.ends_with("name") && !key.ends_with("object") => {
                *census.entry(format!("{key} {word}")).or_default() += 1;
            }
            _ => {}
        }
        *census.entry(key.to_owned()).or_default() += 1;
    }
    let mut census = BTreeMap::new();
    for number in 0..scenes {
        let scene = scene(1, number);
        if let Err(error) = SceneFile::from_json(&scene.to_string(), "scene") {
            panic!("{number}: {error}\n{scene}");
        }
        count("", &scene, &mut census);
    }
    census
}

#[test]
fn every_key_and_word_of_the_format_is_drawn() {
    let census = census(1000);
    let schema: Value = serde_json::from_str(&halfway::scene::json_schema()).unwrap();
    // Not drawn: the version, which is one; what becomes of intensities, which is one; files of models.
    let left_out = [".schema_version", ".intensity"];
    for key in schema["properties"].as_object().unwrap().keys() {
        let key = format!(".{key}");
        assert!(left_out.contains(&key.as_str()) || census.contains_key(&key), "{key}");
    }
    let keys = [
        "mesh.uv_sphere",
        "mesh.plane",
        "mesh.box",
        "mesh.teapot",
        "mesh.inline.normals",
        "mesh.inline.uvs",
        "normals face",
        "normals max",
        "transform.translation",
        "transform.rotation",
        "transform.scale",
        "transform.matrix",
        "material gold",
        "material.emission",
        "material.opacity",
        "back_material.diffuse",
        "faces front",
        "faces back",
        "faces both",
        "shading flat",
        "shading gouraud",
        "shading phong",
        "reflectance phong",
        "reflectance blinn_phong",
        "reflectance blinn_phong_matched",
        "blend",
    ];
    for key in keys {
        let count = census.get(&format!(".objects.{key}")).copied().unwrap_or(0);
        assert!(count >= 20, "{key}: {count}");
    }
    let keys = [
        "kind point",
        "kind spot",
        "kind directional",
        "kind homogeneous",
        "ambient",
        "diffuse",
        "specular",
        "attach camera",
        "attach.object",
        "position",
        "direction",
        "attenuation",
        "range",
        "attenuate_ambient",
        "cutoff_deg",
        "inner_deg",
        "exponent",
    ];
    for key in keys {
        let count = census.get(&format!(".lights.{key}")).copied().unwrap_or(0);
        assert!(count >= 20, "{key}: {count}");
    }
    for key in ["output raw", "samples", "viewer infinite", "camera.near", "camera.fov_y_deg"] {
        let count = census.get(&format!(".{key}")).copied().unwrap_or(0);
        assert!(count >= 20, "{key}: {count}");
    }
}

#[test]
fn the_same_numbers_draw_the_same_scene() {
    assert_eq!(scene(3, 7), scene(3, 7));
    assert_ne!(scene(3, 7), scene(3, 8));
    assert_ne!(scene(3, 7), scene(4, 7));
    // The sum of the bytes of 100 scenes, found once: another machine must find it too.
    let bytes: u64 = (0..100).flat_map(|number| scene(1, number).to_string().into_bytes()).map(u64::from).sum();
    assert_eq!(bytes, 0);
}

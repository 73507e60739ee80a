use std::collections::BTreeMap;

use halfway::scene::SceneFile;

use super::*;

/// How often each key, and each word as a value, is in the first scenes of a seed, all of which the format allows.
fn census(scenes: u64) -> BTreeMap<String, usize> {
    fn count(value: &Value, census: &mut BTreeMap<String, usize>) {
        match value {
            Value::Object(keys) => keys.iter().for_each(|(key, value)| {
                *census.entry(key.clone()).or_default() += 1;
                count(value, census);
            }),
            Value::Array(items) => items.iter().for_each(|item| count(item, census)),
            Value::String(word) => *census.entry(word.clone()).or_default() += 1,
            _ => {}
        }
    }
    let mut census = BTreeMap::new();
    for number in 0..scenes {
        let scene = scene(1, number);
        if let Err(error) = SceneFile::from_json(&scene.to_string(), "scene") {
            panic!("{number}: {error}\n{scene}");
        }
        count(&scene, &mut census);
    }
    census
}

/// The keys and the words of a schema.
fn vocabulary(schema: &Value, found: &mut Vec<String>) {
    match schema {
        Value::Object(members) => {
            if let Some(Value::Object(keys)) = members.get("properties") {
                found.extend(keys.keys().cloned());
            }
            let words = members
                .get("const")
                .into_iter()
                .chain(members.get("enum").and_then(Value::as_array).into_iter().flatten());
            found.extend(words.filter_map(Value::as_str).map(str::to_owned));
            members.values().for_each(|value| vocabulary(value, found));
        }
        Value::Array(items) => items.iter().for_each(|item| vocabulary(item, found)),
        _ => {}
    }
}

#[test]
fn every_key_and_word_of_the_format_is_drawn() {
    let census = census(600);
    let mut words = Vec::new();
    vocabulary(&serde_json::from_str(&halfway::scene::json_schema()).unwrap(), &mut words);
    assert!(words.len() > 80, "{words:?}");
    // There is one version, the judge sets the tolerance, and no model misses an image.
    let left_out = ["schema_version", "tolerance", "steps", "displacement", "mark_missing_images"];
    // Images on objects are normal maps alone, and meshes have at most one set of coordinates.
    let of_maps = ["color", "specular", "emission", "opacity", "shininess", "occlusion", "height", "mask"];
    let of_texels = ["uv_set", "first", "second", "channel", "red", "green", "blue", "alpha"];
    // A view becomes a camera of other numbers before anything is drawn.
    let of_views = ["view", "azimuth_deg", "elevation_deg", "left", "right", "top", "bottom", "iso", "fit", "zoom"];
    // Legends and backgrounds are laid over and behind the finished picture by the same code for all renderers; the judge
    // does not judge them.
    let of_backgrounds = ["legend", "background_below", "background_opacity"];
    let left_out = [&left_out[..], &of_maps, &of_texels, &of_views, &of_backgrounds].concat();
    for word in words.iter().filter(|word| !left_out.contains(&word.as_str())) {
        let times = census.get(word).copied().unwrap_or(0);
        assert!(times >= 20, "{word} is drawn {times} times");
    }
}

#[test]
fn the_same_numbers_draw_the_same_scene() {
    assert_eq!(scene(3, 7), scene(3, 7));
    assert_ne!(scene(3, 7), scene(3, 8));
    assert_ne!(scene(3, 7), scene(4, 7));
}

/// The sum of all bytes of 100 scenes, which has to be the same on every machine. A change of the generator changes it.
#[test]
fn scenes_are_the_same_on_every_machine() {
    let bytes: u64 = (0..100).flat_map(|number| scene(1, number).to_string().into_bytes()).map(u64::from).sum();
    assert_eq!(bytes, 36_244_844);
}

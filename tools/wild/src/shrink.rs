//! Reduces a scene that fails: delta debugging on its JSON.
//!
//! A step removes something, or shortens a number, and is kept if the scene still fails. Steps are tried in turn until
//! none is kept: parts of lists, then keys (the format's defaults hold), then the triangles of written-out meshes, then
//! numbers.

use std::ops::Range;

use serde_json::{Map, Value};

/// The smallest scene found for which `fails` holds, as it does for `scene`. `fails` is asked at most `trials` times.
pub fn shrink(scene: &Value, trials: usize, fails: impl FnMut(&Value) -> bool) -> Value {
    let mut search = Search { best: scene.clone(), trials, fails };
    loop {
        let before = cost(&search.best);
        search.shorten_lists();
        search.remove_keys();
        search.simplify_meshes();
        search.simplify_numbers();
        if search.trials == 0 || cost(&search.best) >= before {
            return search.best;
        }
    }
}

/// The scene as the text of a file: an object or a light a line, and every key of the scene.
pub fn written(scene: &Value) -> String {
    let Value::Object(keys) = scene else { return scene.to_string() };
    let line = |(key, value): (&String, &Value)| match value {
        Value::Array(items) if items.iter().any(Value::is_object) => {
            let items: Vec<String> = items.iter().map(|item| format!("    {item}")).collect();
            format!("  \"{key}\": [\n{}\n  ]", items.join(",\n"))
        }
        value => format!("  \"{key}\": {value}"),
    };
    format!("{{\n{}\n}}\n", keys.iter().map(line).collect::<Vec<_>>().join(",\n"))
}

struct Search<F> {
    best: Value,
    trials: usize,
    fails: F,
}

/// Shorter text is simpler; of equally long ones that with the smaller numbers.
fn cost(scene: &Value) -> (usize, f64) {
    fn sum(value: &Value) -> f64 {
        match value {
            Value::Number(number) => number.as_f64().unwrap_or(0.0).abs(),
            Value::Array(items) => items.iter().map(sum).sum(),
            Value::Object(keys) => keys.values().map(sum).sum(),
            _ => 0.0,
        }
    }
    (scene.to_string().len(), sum(scene))
}

impl<F: FnMut(&Value) -> bool> Search<F> {
    /// Takes `change`d as the best if it is simpler and fails too.
    fn attempt(&mut self, change: impl FnOnce(&mut Value)) -> bool {
        let mut changed = self.best.clone();
        change(&mut changed);
        if self.trials == 0 || cost(&changed) >= cost(&self.best) {
            return false;
        }
        self.trials -= 1;
        let stands = (self.fails)(&changed);
        if stands {
            self.best = changed;
        }
        stands
    }

    /// Removes all, halves, quarters … and at last single ones of the parts.
    fn drop_parts(&mut self, length: impl Fn(&Value) -> usize, drop: impl Fn(&mut Value, Range<usize>)) {
        let mut part = length(&self.best);
        while part > 0 {
            let mut start = 0;
            while start < length(&self.best) {
                let end = (start + part).min(length(&self.best));
                let stands = self.attempt(|scene| drop(scene, start..end));
                start += if stands { 0 } else { part };
            }
            part /= 2;
        }
    }

    /// Removes objects, lights and cameras.
    fn shorten_lists(&mut self) {
        for list in ["objects", "lights", "cameras"] {
            let drop = |scene: &mut Value, gone| {
                if let Some(items) = scene[list].as_array_mut() {
                    items.drain(gone);
                }
            };
            self.drop_parts(|scene| scene[list].as_array().map_or(0, Vec::len), drop);
        }
    }

    /// Removes keys everywhere. The camera, the lights and the size stay: their defaults are no simpler.
    fn remove_keys(&mut self) {
        let mut paths = paths(&self.best, &Value::is_object);
        // Outer keys first: removing one removes its inner keys.
        paths.sort_by_key(|path| path.matches('/').count());
        for path in paths {
            let Some(Value::Object(keys)) = self.best.pointer(&path) else { continue };
            let names: Vec<String> = keys.keys().cloned().collect();
            for name in names {
                if path.is_empty() && ["camera", "lights", "objects", "size"].contains(&name.as_str()) {
                    continue;
                }
                self.attempt(|scene| {
                    if let Some(Value::Object(keys)) = scene.pointer_mut(&path) {
                        keys.remove(&name);
                    }
                });
            }
        }
    }

    /// Replaces meshes by simpler ones, and removes triangles.
    fn simplify_meshes(&mut self) {
        for i in 0..self.best["objects"].as_array().map_or(0, Vec::len) {
            for simple in ["plane", "box", "uv_sphere"] {
                self.attempt(|scene| scene["objects"][i]["mesh"] = serde_json::json!({ simple: {} }));
            }
            self.attempt(|scene| {
                scene["objects"][i]["mesh"] = serde_json::json!({ "uv_sphere": { "segments": 3, "rings": 2 } });
            });
            let triangles = |best: &Value| {
                best["objects"][i]["mesh"].pointer("/inline/indices").and_then(Value::as_array).map_or(0, Vec::len) / 3
            };
            self.drop_parts(triangles, |scene, gone| drop_triangles(&mut scene["objects"][i]["mesh"], gone));
        }
    }

    /// Writes numbers shorter: 0, 1, fewer digits, half.
    fn simplify_numbers(&mut self) {
        for path in paths(&self.best, &Value::is_number) {
            let Some(now) = self.best.pointer(&path).and_then(Value::as_f64) else { continue };
            for simple in simpler(now) {
                if self.attempt(|scene| {
                    if let Some(value) = scene.pointer_mut(&path) {
                        *value = number(simple);
                    }
                }) {
                    break;
                }
            }
        }
    }
}

/// Numbers that are easier to read than `x`, the easiest first.
fn simpler(x: f64) -> Vec<f64> {
    let mut found = vec![0.0, 1.0, -1.0];
    for digits in 1..4 {
        // Through text, which rounds decimal digits exactly.
        found.extend(format!("{x:.*e}", digits - 1).parse::<f64>());
    }
    found.extend([(x / 2.0).round(), x.round(), x.round() - 1.0]);
    found.retain(|candidate| candidate.is_finite());
    found
}

/// Whole numbers without a fraction, as counts have to be written.
fn number(x: f64) -> Value {
    if x.fract() == 0.0 && x.abs() < 1e9 { Value::from(x as i64) } else { Value::from(x) }
}

/// JSON pointers to all values inside that are `wanted`. No key of a scene has a character that they escape.
fn paths(value: &Value, wanted: &dyn Fn(&Value) -> bool) -> Vec<String> {
    fn visit(value: &Value, wanted: &dyn Fn(&Value) -> bool, path: &str, found: &mut Vec<String>) {
        if wanted(value) {
            found.push(path.to_owned());
        }
        match value {
            Value::Array(items) => {
                items.iter().enumerate().for_each(|(i, item)| visit(item, wanted, &format!("{path}/{i}"), found));
            }
            Value::Object(keys) => {
                keys.iter().for_each(|(key, item)| visit(item, wanted, &format!("{path}/{key}"), found));
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    visit(value, wanted, "", &mut found);
    found
}

/// Removes triangles of an inline mesh, and the vertices that no other triangle uses.
fn drop_triangles(mesh: &mut Value, gone: Range<usize>) {
    let Some(Value::Object(inline)) = mesh.get_mut("inline") else { return };
    let Some(indices) = inline.get("indices").and_then(Value::as_array) else { return };
    let indices: Vec<usize> = indices.iter().map(|index| index.as_u64().unwrap_or(0) as usize).collect();
    let kept: Vec<usize> =
        indices.chunks(3).enumerate().filter(|(i, _)| !gone.contains(i)).flat_map(|(_, t)| t).copied().collect();
    let mut used = kept.clone();
    used.sort_unstable();
    used.dedup();
    let renamed = kept.iter().map(|vertex| Value::from(used.partition_point(|other| other < vertex)));
    inline.insert("indices".into(), renamed.collect());
    for (key, each) in [("positions", 3), ("normals", 3), ("uvs", 2), ("colors", 4)] {
        keep_vertices(inline, key, each, &used);
    }
}

fn keep_vertices(inline: &mut Map<String, Value>, key: &str, each: usize, used: &[usize]) {
    let Some(Value::Array(values)) = inline.get_mut(key) else { return };
    *values = used.iter().flat_map(|vertex| values.iter().skip(vertex * each).take(each)).cloned().collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Fails for two objects of which the first is red.
    fn two_matter(scene: &Value) -> bool {
        let objects = scene["objects"].as_array().unwrap();
        objects.iter().any(|object| object["color"][0].as_f64().is_some_and(|red| red > 0.5))
            && objects.iter().any(|object| object["name"] == "b")
    }

    #[test]
    fn reduction_keeps_only_relevant_parts() {
        let mut objects = vec![json!({"mesh": {"teapot": {"divisions": 5}}, "size": 3.25}); 20];
        objects[7]["color"] = json!([0.734_521, 0.25, 0.125]);
        objects[13]["name"] = json!("b");
        let scene =
            json!({"camera": {"near": 0.5}, "lights": [{"kind": "point"}, {}], "objects": objects, "samples": 4});
        let small = shrink(&scene, 1000, two_matter);
        let expected = json!({"camera": {}, "lights": [], "objects": [{"color": [1, 0, 0]}, {"name": "b"}]});
        assert_eq!(small, expected);
    }

    #[test]
    fn failures_are_tested_at_most_as_often_as_allowed() {
        let scene = json!({"objects": vec![json!({"a": 1.5}); 100]});
        let mut asked = 0;
        let small = shrink(&scene, 17, |_| {
            asked += 1;
            false
        });
        assert_eq!((asked, small), (17, scene));
    }

    #[test]
    fn triangles_go_with_their_vertices() {
        let mut mesh = json!({"inline": {
            "positions": [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4],
            "uvs": [0, 0, 1, 1, 2, 2, 3, 3, 4, 4],
            "indices": [0, 1, 2, 2, 3, 4, 0, 2, 1],
        }});
        drop_triangles(&mut mesh, 0..1);
        drop_triangles(&mut mesh, 1..2);
        let expected =
            json!({"positions": [2, 2, 2, 3, 3, 3, 4, 4, 4], "uvs": [2, 2, 3, 3, 4, 4], "indices": [0, 1, 2]});
        assert_eq!(mesh, json!({ "inline": expected }));
    }

    #[test]
    fn scenes_are_written_an_object_a_line() {
        let scene = json!({"size": [64, 64], "objects": [{"a": 1}, {"b": [2]}], "lights": []});
        let expected =
            "{\n  \"lights\": [],\n  \"objects\": [\n    {\"a\":1},\n    {\"b\":[2]}\n  ],\n  \"size\": [64,64]\n}\n";
        assert_eq!(written(&scene), expected);
        assert_eq!(serde_json::from_str::<Value>(expected).unwrap(), scene);
    }
}

//! Values of older scene files that the format no longer has.

use halfway_lighting::Range;
use serde::Deserialize;
use serde_json::Value;

use crate::check::{KeyProblem, Within, in_range};
use crate::json;
use crate::view::AUTO;

/// The shading of a scene or an object.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Shaded {
    shading: Value,
    objects: Vec<Self>,
}

/// The warning about `"auto"` in the text of a valid scene, at the place where it is used first.
pub(crate) fn warning(text: &str, origin: &str) -> Result<Option<String>, KeyProblem> {
    if !text.contains(AUTO) {
        return Ok(None);
    }
    let scene: Shaded = serde_json::from_str(text).unwrap_or_default();
    let objects = scene.objects.iter().enumerate();
    let of_objects = objects.map(|(i, object)| (format!("objects[{i}].shading"), &object.shading));
    let mut places = Vec::new();
    let mut ignored = "";
    for (key, shading) in [("shading".to_owned(), &scene.shading)].into_iter().chain(of_objects) {
        if let Some(tolerance) = shading.pointer("/auto/tolerance").and_then(Value::as_f64) {
            in_range("auto.tolerance", tolerance as f32, Range::NON_NEGATIVE).within(&key)?;
            ignored = ", and its own tolerance is ignored";
        }
        if *shading == AUTO || shading.get(AUTO).is_some() {
            places.push(key);
        }
    }
    let more = match places.len() {
        0 => return Ok(None),
        1 => String::new(),
        count => format!(" (here and in {} more places)", count - 1),
    };
    let message = format!("\"{AUTO}\" is no longer a shading; it is drawn as \"phong\"{ignored}{more}");
    Ok(Some(json::error_at(text, origin, KeyProblem::new(places.swap_remove(0), message)).to_string()))
}

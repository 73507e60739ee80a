//! The JSON schema of scene files, for editors and other tools.

use serde_json::{Map, Value};

use crate::file::SceneFile;
use crate::keys::Object;

/// The JSON schema (draft 2020-12) of scene files, as indented text.
///
/// It comes from the same tables as the parser, and is stored in `docs/scene.schema.json`. Rules that a schema cannot
/// express (an `attach` needs its object, a cutoff is at most 90 or 180) are checked when a file is read.
pub fn json_schema() -> String {
    let mut definitions = Map::new();
    let mut schema = SceneFile::definition(&mut definitions);
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "halfway scene".into();
    schema["$defs"] = definitions.into();
    tidy(&mut schema);
    // A value is always JSON.
    crate::json::pretty(&schema).unwrap_or_default()
}

/// Defaults are `f32`, of which 0.1 would show as 0.10000000149011612.
fn tidy(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(members) => members.values_mut().for_each(tidy),
        Value::Number(number) => {
            let shortest = number.as_f64().filter(|_| number.is_f64()).and_then(|wide| {
                let narrow = wide as f32;
                let short: f64 = narrow.to_string().parse().ok()?;
                #[allow(clippy::float_cmp, reason = "only numbers that came from an f32 are rewritten")]
                let exact = f64::from(narrow) == wide;
                exact.then_some(short)
            });
            if let Some(short) = shortest.map(whole_or_fraction) {
                *value = short;
            }
        }
        _ => {}
    }
}

/// 1 rather than 1.0, as the format's description writes it.
fn whole_or_fraction(x: f64) -> Value {
    if x.fract() == 0.0 && x.abs() < 1e9 { Value::from(x as i64) } else { Value::from(x) }
}

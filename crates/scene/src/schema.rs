//! The JSON schema of scene files, for editors and other tools.

use schemars::generate::SchemaSettings;
use serde_json::Value;

use crate::file::SceneFile;

/// The JSON schema (draft 2020-12) of scene files, as indented text.
///
/// It is made from the types that read the files, and stands in `docs/scene.schema.json`. What a schema cannot say (an
/// `attach` needs its object, a cutoff is at most 90 or 180) is checked when a file is read.
pub fn json_schema() -> String {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<SceneFile>().to_value();
    tidy(&mut schema);
    // A value is always JSON.
    crate::json::pretty(&schema).unwrap_or_default()
}

/// Defaults are `f32`, of which 0.1 would show as 0.10000000149011612; and descriptions have the line ends of the
/// source.
fn tidy(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(members) => members.values_mut().for_each(tidy),
        Value::String(text) => *text = text.replace('\n', " "),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The schema in `docs/` is the one of the types. To bring it up to date, run the test with the environment
    /// variable `HALFWAY_WRITE_SCHEMA=1`.
    #[test]
    fn the_written_schema_is_up_to_date() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene.schema.json");
        if std::env::var_os("HALFWAY_WRITE_SCHEMA").is_some() {
            std::fs::write(file, json_schema()).unwrap();
        }
        let written = std::fs::read_to_string(file).unwrap_or_default();
        assert!(
            written == json_schema(),
            "{file} is out of date; write it anew by\n    HALFWAY_WRITE_SCHEMA=1 cargo test -p halfway_scene schema"
        );
    }
}

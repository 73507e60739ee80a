//! Rubrics in files.

use std::fs;
use std::path::Path;

use halfway::reference::marking::Rubric;
use serde_json::{Map, Value};

use crate::failure::Failure;

/// The keys of a rubric.
const KEYS: [&str; 4] = ["points", "mistake", "unexplained", "mistakes"];

/// Reads a rubric. Keys that are left out have the values of the default.
pub(super) fn read(file: &Path) -> Result<Rubric, Failure> {
    let name = file.display();
    let text = fs::read_to_string(file).map_err(|error| format!("{name}: cannot be read: {error}"))?;
    parse(&text).map_err(|error| format!("{name}: {error}").into())
}

fn parse(text: &str) -> Result<Rubric, String> {
    let json: Value = serde_json::from_str(text).map_err(|error| format!("{error}; expected a rubric in JSON"))?;
    let Value::Object(entries) = &json else { return Err(format!("{json}; expected an object of JSON")) };
    if let Some(unknown) = entries.keys().find(|key| !KEYS.contains(&key.as_str())) {
        return Err(format!("unknown key {unknown:?}; expected {}", KEYS.join(", ")));
    }
    let number = |key: &str, otherwise: f64| match entries.get(key) {
        None => Ok(otherwise),
        Some(value) => value.as_f64().ok_or_else(|| format!("{key}: {value}; expected a number of points")),
    };
    let default = Rubric::default();
    let rubric = Rubric::new(
        number("points", default.points())?,
        number("mistake", default.mistake())?,
        number("unexplained", default.unexplained())?,
    );
    let own = match entries.get("mistakes") {
        None => &Map::new(),
        Some(Value::Object(own)) => own,
        Some(other) => return Err(format!("mistakes: {other}; expected an object of names and points")),
    };
    own.iter().try_fold(rubric.map_err(|error| error.to_string())?, |rubric, (name, lost)| {
        let lost = lost.as_f64().ok_or_else(|| format!("mistakes.{name}: {lost}; expected a number of points"))?;
        rubric.with_mistake(name, lost).map_err(|error| error.to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway::reference::mistakes::Mistake;

    #[test]
    fn what_is_left_out_is_as_by_default() {
        assert_eq!(parse("{}").expect("an empty rubric"), Rubric::default());
        let rubric = parse(r#"{"points": 10, "mistake": 2.5, "mistakes": {"mirrored": 0, "gamma-twice": 1}}"#);
        let rubric = rubric.expect("a rubric");
        let lost = [Mistake::Mirrored, Mistake::GammaTwice, Mistake::GammaMissing].map(|it| rubric.lost(it));
        assert_eq!((rubric.points(), rubric.unexplained(), lost), (10.0, 50.0, [0.0, 1.0, 2.5]));
    }

    #[test]
    fn errors_name_the_key_and_what_is_expected() {
        for (text, expected) in [
            ("{", "expected a rubric in JSON"),
            ("[]", "[]; expected an object of JSON"),
            (r#"{"point": 1}"#, "unknown key \"point\"; expected points, mistake, unexplained, mistakes"),
            (r#"{"points": "many"}"#, "points: \"many\"; expected a number of points"),
            (r#"{"points": -1}"#, "points: -1; expected a finite number of points, 0 or more"),
            (r#"{"mistakes": 3}"#, "mistakes: 3; expected an object of names and points"),
            (r#"{"mistakes": {"mirrored": null}}"#, "mistakes.mirrored: null; expected a number of points"),
            (r#"{"mistakes": {"mirrored": -2}}"#, "mirrored: -2; expected a finite number of points, 0 or more"),
            (r#"{"mistakes": {"typo": 1}}"#, "\"typo\" is not the name of a mistake; expected one of normals-not-"),
        ] {
            let error = parse(text).expect_err(text);
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}

//! Scene files that are refused, and the messages that say why.

use std::path::Path;

use crate::bad_entries::{LIGHTS, OBJECTS};
use crate::bad_keys::{NOT_JSON, NOT_THE_FORMAT};
use crate::bad_values::OUT_OF_RANGE;
use halfway_scene::{LightEntry, LightKind, SceneError, SceneFile};

/// A scene file, where its error is (line and column), and how the message goes on.
pub(super) type Bad = (&'static str, (usize, usize), &'static str);

/// The keys of an entry that is the only one of its list, and this list that of a file; the column of the error there,
/// and how the message goes on after the entry's path.
pub(super) type BadEntry = (&'static str, usize, &'static str);

#[test]
fn every_bad_file_is_refused_where_it_is_wrong() {
    let files = [NOT_JSON, NOT_THE_FORMAT, OUT_OF_RANGE].concat().into_iter();
    let files = files.map(|(text, place, message)| (text.to_owned(), place, message.to_owned()));
    let entries = |list: &'static str, entries: &'static [BadEntry]| {
        entries.iter().map(move |(keys, column, message)| {
            (format!("{{\"{list}\": [{{{keys}}}]}}"), (1, *column), format!("`{list}[0]{message}"))
        })
    };
    let mut wrong = Vec::new();
    for (text, (line, column), message) in files.chain(entries("lights", LIGHTS)).chain(entries("objects", OBJECTS)) {
        let expected = format!("dir/bad.json:{line}:{column}: {message}");
        match SceneFile::from_json(&text, "dir/bad.json") {
            Ok(_) => wrong.push(format!("{text}\n  accepted; expected: {expected}")),
            Err(error) if error.to_string().starts_with(&expected) => {}
            Err(error) => wrong.push(format!("{text}\n  {error}\n  expected: {expected}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn deep_nesting_is_refused_without_overflow() {
    let text = format!("{{\"objects\": {}", "[".repeat(1_000_000));
    let error = SceneFile::from_json(&text, "deep").unwrap_err();
    assert!(error.to_string().starts_with("deep:1:14: `objects[0]`: is a value of the wrong type: list"), "{error}");
}

#[test]
fn files_that_are_no_text() {
    let dir = std::env::temp_dir().join(format!("halfway-scene-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let latin1 = dir.join("latin1.json");
    std::fs::write(&latin1, b"{\"objects\": [{\"name\": \"K\xe4se\"}]}").unwrap();
    let marked = dir.join("marked.json");
    std::fs::write(&marked, "\u{feff}{\"samples\": 4}").unwrap();

    let read = |path: &Path| SceneFile::read(path).map_err(|error| error.to_string());
    let error = read(&latin1).unwrap_err();
    assert!(error.starts_with(&format!("{}: is not UTF-8 text (byte 24)", latin1.display())), "{error}");
    assert_eq!(read(&marked).unwrap().samples, 4);
    let missing = dir.join("missing.json");
    let error = read(&missing).unwrap_err();
    assert!(error.starts_with(&format!("{}: cannot be read: ", missing.display())), "{error}");
    let error = read(&dir).unwrap_err();
    assert!(error.starts_with(&format!("{}: cannot be read: ", dir.display())), "{error}");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn a_scene_made_in_code_is_checked_before_it_is_written() {
    let mut scene = SceneFile::default();
    let mut light = LightEntry::white(LightKind::Point);
    light.light.diffuse.green = f32::NAN;
    scene.lights = Some(vec![LightEntry::white(LightKind::Spot), light].into());
    let error = scene.to_json().unwrap_err();
    assert!(matches!(error, SceneError::Value { .. }));
    assert_eq!(error.key(), Some("lights[1].diffuse[1]"));
    assert_eq!(error.to_string(), "scene: `lights[1].diffuse[1]`: is NaN; expected a number from 0 to 1e12");
}

//! JSON text: the parser's errors in the words of the format, and the layout of written scenes.

use serde::Serialize;
use serde_path_to_error::{Path, Segment};

use crate::check::{KeyProblem, Limits};
use crate::entry::{Entry, Read};
use crate::error::SceneError;
use crate::light::LightEntry;
use crate::locate::{byte_of, key_before, line_and_column, value_at};
use crate::object::ObjectEntry;
use crate::view::CameraEntry;

/// Reads the one value of a text.
pub(crate) fn read<T: Entry>(text: &str, origin: &str) -> Result<T, SceneError> {
    let mut parser = serde_json::Deserializer::from_str(text);
    let result: Result<Read<T>, _> = serde_path_to_error::deserialize(&mut parser);
    let Read(value) = result.map_err(|error| located(error.inner(), &known(error.path()), text, origin))?;
    parser.end().map_err(|error| located(&error, "", text, origin))?;
    Ok(value)
}

macro_rules! from_json {
    ($($entry:ty),+) => {
        $(impl $entry {
            /// Reads the value from JSON, as it stands in a scene file. `origin` is the name that errors give the text.
            ///
            /// # Errors
            /// [`SceneError::Text`], as [`SceneFile::from_json`](crate::SceneFile::from_json).
            pub fn from_json(text: &str, origin: &str) -> Result<Self, SceneError> {
                let value: Self = read(text, origin)?;
                value.check(&Limits::Any).map_err(|problem| error_at(text, origin, problem))?;
                Ok(value)
            }
        })+
    };
}

from_json!(CameraEntry, LightEntry, ObjectEntry);

/// The error about a value that was read and is invalid, at the place where it begins.
pub(crate) fn error_at(text: &str, origin: &str, KeyProblem { key, message }: KeyProblem) -> SceneError {
    let (line, column) = line_and_column(text, value_at(text, &key));
    SceneError::Text { origin: origin.to_owned(), line, column, key, message }
}

/// The path in a file, without the `?` for a key that the text ends inside of.
fn known(path: &Path) -> String {
    let whole = path.to_string();
    match path.iter().next_back() {
        None => String::new(),
        Some(Segment::Unknown) => whole.trim_end_matches(['?', '.']).to_owned(),
        Some(_) => whole,
    }
}

/// An error of the parser about the value at `path`.
fn located(error: &serde_json::Error, path: &str, text: &str, origin: &str) -> SceneError {
    let suffix = format!(" at line {} column {}", error.line(), error.column());
    let full = error.to_string();
    let message = full.strip_suffix(&suffix).unwrap_or(&full);

    let stopped = byte_of(text, error.line(), error.column());
    let mut key = path.to_owned();
    // An object is refused as a whole for the key that its message begins with.
    let own = message.strip_prefix('`').and_then(|rest| rest.split_once("` "));
    let byte = if let Some((name, _)) = own {
        key = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        key_before(text, value_at(text, &key))
    } else if ["unknown key", "key given twice"].iter().any(|start| message.starts_with(start)) {
        // The parser stops right after a key that is not wanted.
        key_before(text, stopped)
    } else {
        let value = value_at(text, path);
        match text[value..].starts_with(['{', '[']) || path.is_empty() {
            // An error of JSON in an object or a list may be lines away from where that begins.
            true if error.is_eof() => stopped,
            true if error.is_syntax() => text.floor_char_boundary(stopped.saturating_sub(1)),
            _ => value,
        }
    };
    let (line, column) = line_and_column(text, byte);
    let message = in_words_of_the_format(own.map_or(message, |(_, rest)| rest));
    SceneError::Text { origin: origin.to_owned(), line, column, key, message }
}

/// The parser speaks of Rust's types; the reader of the error wrote JSON.
fn in_words_of_the_format(message: &str) -> String {
    let mut words = message.to_owned();
    for (rust, json) in [
        ("trailing characters", "more text after the end of the scene"),
        ("invalid type: null", "null is not allowed here"),
        ("invalid type: ", "is a value of the wrong type: "),
        ("invalid value: ", "is out of range: "),
        ("invalid length ", "is a list of length "),
        ("expected value", "not JSON: expected a value"),
        ("EOF while parsing", "the text ends inside"),
        ("key must be a string", "not JSON: expected a key in quotes"),
    ] {
        if let Some(rest) = words.strip_prefix(rust) {
            words = format!("{json}{rest}");
            break;
        }
    }
    for (rust, json) in [
        ("wrong type: map,", "wrong type: object,"),
        ("wrong type: sequence,", "wrong type: list,"),
        ("expected a sequence", "expected a list"),
        ("expected f32", "expected a number"),
        ("expected f64", "expected a number"),
        ("number out of range", "is too large; expected a number of at most 3.4e38"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected path string", "expected a path in quotes"),
    ] {
        words = words.replace(rust, json);
    }
    words
}

/// Indented JSON with lists of numbers on one line each, and a line end at the end.
pub(crate) fn pretty(value: &impl Serialize) -> serde_json::Result<String> {
    let mut text = lists_on_one_line(&serde_json::to_string_pretty(value)?);
    text.push('\n');
    Ok(text)
}

/// Joins the lines of every list that holds neither lists nor objects.
fn lists_on_one_line(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    // Brackets inside strings are passed over with their string.
    while let Some(at) = rest.find(['"', '[']) {
        let (before, here) = rest.split_at(at);
        out.push_str(before);
        let end = if here.starts_with('"') { string_end(here) } else { flat_list_end(here) };
        match end {
            Some(end) if here.starts_with('[') => {
                let items: Vec<&str> = here[1..end - 1].split(',').map(str::trim).collect();
                out.push('[');
                out.push_str(&items.join(", "));
                out.push(']');
                rest = &here[end..];
            }
            end => {
                let end = end.unwrap_or(1);
                out.push_str(&here[..end]);
                rest = &here[end..];
            }
        }
    }
    out.push_str(rest);
    out
}

/// The length of the string that `text` begins with.
fn string_end(text: &str) -> Option<usize> {
    let mut escaped = false;
    text.char_indices().skip(1).find_map(|(i, c)| {
        let end = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        end.then_some(i + 1)
    })
}

/// The length of the list that `text` begins with, if it holds numbers and words only.
fn flat_list_end(text: &str) -> Option<usize> {
    let end = 1 + text[1..].find(['[', ']', '{', '"'])?;
    text[end..].starts_with(']').then_some(end + 1)
}

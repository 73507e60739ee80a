//! JSON text: what the parser says about it, told in the words of the format; and how a scene is written.

use serde::Serialize;

use crate::error::SceneError;
use crate::locate::{byte_of, line_and_column, place_at, place_of};

/// An error of the parser, with the path of the key it is about.
pub(crate) fn located(error: &serde_json::Error, text: &str, origin: &str) -> SceneError {
    let suffix = format!(" at line {} column {}", error.line(), error.column());
    let full = error.to_string();
    let message = full.strip_suffix(&suffix).unwrap_or(&full);

    let stopped = byte_of(text, error.line(), error.column());
    let last_read = if error.is_eof() { stopped } else { text.floor_char_boundary(stopped.saturating_sub(1)) };
    let (place, last_key) = place_at(text, stopped);
    let (key, byte) = match last_key {
        // The parser stops right after a key that it does not want.
        Some(name) if is_about_a_key(message) => (name.key, name.name),
        // A light or a transform is refused as a whole, for the key that its message begins with.
        _ => match message.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
            Some((key, _)) => {
                let place = place_of(text, &format!("{}.{key}", place.key));
                (place.key, place.name)
            }
            // What is no JSON in an object or a list may be lines away from where that begins.
            None if (error.is_syntax() || error.is_eof()) && text[place.value..].starts_with(['{', '[']) => {
                (place.key, last_read)
            }
            None => (place.key, place.value),
        },
    };
    let (line, column) = line_and_column(text, byte);
    let message = in_words_of_the_format(message, &key);
    SceneError::Text { origin: origin.to_owned(), line, column, key, message }
}

fn is_about_a_key(message: &str) -> bool {
    ["unknown field", "duplicate field"].iter().any(|start| message.starts_with(start))
}

/// The parser speaks of Rust's types; the reader of the error wrote JSON.
fn in_words_of_the_format(message: &str, key: &str) -> String {
    match message {
        // The parser's word for an array that goes on where it should end.
        "trailing characters" if key.ends_with(']') => return "is one number too many".to_owned(),
        "trailing characters" => return "more text after the end of the scene".to_owned(),
        _ => {}
    }
    // The key is named already, in front of the message.
    let own = message.strip_prefix('`').and_then(|rest| rest.split_once("` "));
    let mut words = own.map_or(message, |(_, rest)| rest).to_owned();
    for (rust, json) in [
        ("unknown field", "unknown key"),
        ("missing field", "missing key"),
        ("duplicate field", "key given twice:"),
        ("unknown variant", "unknown value"),
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
        ("expected an array of length", "expected a list of length"),
        ("expected f32", "expected a number"),
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

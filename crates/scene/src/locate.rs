//! The place of a value in a JSON text.

use std::cell::Cell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// The byte at which the value at a path begins, or the innermost value around it that the text has. Behind that, the
/// text need not be JSON.
pub(crate) fn value_at(text: &str, path: &str) -> usize {
    let start = text.len() - text.trim_start().len();
    let steps = steps(path);
    let found = (1..=steps.len()).rev().find_map(|count| find(text, &steps[..count]));
    found.unwrap_or(start)
}

/// The first byte of the key whose value, or the text after it, begins at `byte`; `byte` itself if there is no key.
pub(crate) fn key_before(text: &str, byte: usize) -> usize {
    let before = text[..byte].trim_end();
    let before = before.strip_suffix(':').unwrap_or(before).trim_end();
    let Some(mut key) = before.strip_suffix('"') else { return byte };
    loop {
        let Some(quote) = key.rfind('"') else { return byte };
        key = &key[..quote];
        // A quote inside the key has an odd number of backslashes before it.
        if key.bytes().rev().take_while(|&byte| byte == b'\\').count().is_multiple_of(2) {
            return quote;
        }
    }
}

/// Line and column of a byte, both counted from 1, the column in characters.
pub(crate) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

/// The byte that a line and a column in bytes, both counted from 1, have been read up to.
pub(crate) fn byte_of(text: &str, line: usize, column: usize) -> usize {
    let line_start = match line {
        0 | 1 => 0,
        _ => text.match_indices('\n').nth(line - 2).map_or(text.len(), |(i, _)| i + 1),
    };
    text.floor_char_boundary(line_start + column)
}

/// A key, or `[`, a number and `]`.
fn steps(path: &str) -> Vec<&str> {
    let ends = path.match_indices(['.', '[']).map(|(end, _)| end).filter(|end| *end > 0).chain([path.len()]);
    let mut start = 0;
    ends.map(|end| path[std::mem::replace(&mut start, end)..end].trim_start_matches('.')).collect()
}

fn find(text: &str, steps: &[&str]) -> Option<usize> {
    let is_found = Cell::new(false);
    let error = Find { steps, is_found: &is_found }.deserialize(&mut serde_json::Deserializer::from_str(text)).err()?;
    is_found.get().then(|| byte_of(text, error.line(), error.column()))
}

/// Follows a path and raises an error where the value begins: the parser adds line and column to it.
#[derive(Clone, Copy)]
struct Find<'a> {
    steps: &'a [&'a str],
    is_found: &'a Cell<bool>,
}

impl<'de> DeserializeSeed<'de> for Find<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.steps.is_empty() {
            self.is_found.set(true);
            return Err(D::Error::custom("found"));
        }
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Find<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list or an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if self.steps.first() == Some(&key.as_str()) {
                map.next_value_seed(Self { steps: &self.steps[1..], ..self })?;
            } else {
                map.next_value::<IgnoredAny>()?;
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        let index = self.steps.first().and_then(|step| step.strip_prefix('[')?.strip_suffix(']')?.parse().ok());
        for _ in 0..index.unwrap_or(usize::MAX) {
            if seq.next_element::<IgnoredAny>()?.is_none() {
                return Ok(());
            }
        }
        seq.next_element_seed(Self { steps: &self.steps[1..], ..self }).map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"{"a": 1, "käse": [[1, 2], {"b\"": null , "c" : "x\"y"}], "d": {}}"#;

    #[test]
    fn paths_lead_to_values_and_keys() {
        for (path, value, key) in [
            ("a", "1", "\"a\""),
            ("käse", "[[", "\"käse\""),
            ("käse[0]", "[1,", "[1, 2], {"),
            ("käse[0][1]", "2]", "2]"),
            ("käse[1].c", "\"x\\\"", "\"c\" :"),
            ("d", "{}", "\"d\""),
            // The innermost value around a missing one.
            ("käse[0][7]", "[1,", "[1, 2], {"),
            ("d.e.f", "{}", "\"d\""),
            ("e", "{\"a\"", "{\"a\""),
            ("", "{\"a\"", "{\"a\""),
        ] {
            let byte = value_at(TEXT, path);
            assert!(TEXT[byte..].starts_with(value), "{path}: {}", &TEXT[byte..]);
            assert!(TEXT[key_before(TEXT, byte)..].starts_with(key), "{path}: {}", &TEXT[key_before(TEXT, byte)..]);
        }
        // Also of a key with a quote, and behind the key.
        assert!(TEXT[key_before(TEXT, TEXT.find("null").unwrap())..].starts_with("\"b\\\"\""));
        assert!(TEXT[key_before(TEXT, TEXT.find("null").unwrap() - 2)..].starts_with("\"b\\\"\""));
    }

    #[test]
    fn places_of_a_text_that_ends() {
        for text in ["", "\"", "\"\\", "{\"", "{\"a", "[", "[[[", "nul", "{\"a\":\"\\", "}", "[}", "ä"] {
            for byte in (0..=text.len()).filter(|&byte| text.is_char_boundary(byte)) {
                key_before(text, byte);
            }
            assert!(value_at(text, "a[0].b") <= text.len());
            line_and_column(text, 99);
            byte_of(text, 9, 9);
        }
        value_at(&"[".repeat(100_000), "[0][0]");
    }
}

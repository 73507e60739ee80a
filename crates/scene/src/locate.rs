//! Where in a JSON text a key stands, and which key stands at a place.
//!
//! The parser says where it stopped, but not inside which key; the checks after it know the key, but
//! not its place. Both are found by walking the text once more, which happens only when there is an
//! error to report.

/// A place in a JSON text.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct KeyPlace {
    /// The path of the value, such as `lights[2].attenuation`; empty for the outermost value.
    pub(crate) key: String,
    /// The byte where the value begins.
    pub(crate) value: usize,
    /// The byte where the value's key begins; where the value begins if it has none.
    pub(crate) name: usize,
}

/// The value that a parser was reading when it had consumed the first `consumed` bytes, and the last
/// key read inside that value, if it is an object.
pub(crate) fn place_at(text: &str, consumed: usize) -> (KeyPlace, Option<KeyPlace>) {
    let mut walk = Walk::new(text, consumed, |_| false);
    walk.value(0, 0);
    match walk.closed {
        Some((place, end)) if end == consumed => (place, None),
        _ => walk.open.pop().unwrap_or_default(),
    }
}

/// The place of the value at the path `key`, or of the innermost value around it that the text has.
pub(crate) fn place_of(text: &str, key: &str) -> KeyPlace {
    let mut best = KeyPlace::default();
    let mut walk = Walk::new(text, text.len(), |place: &KeyPlace| {
        if encloses(&place.key, key) {
            best = place.clone();
        }
        place.key == key
    });
    walk.value(0, 0);
    best
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

fn encloses(outer: &str, inner: &str) -> bool {
    inner
        .strip_prefix(outer)
        .is_some_and(|rest| outer.is_empty() || rest.is_empty() || rest.starts_with('.') || rest.starts_with('['))
}

/// No format here nests deeper than this; the parser itself stops at 128.
const MAX_DEPTH: usize = 160;

struct Walk<'t, F> {
    bytes: &'t [u8],
    /// How far the text has been read.
    at: usize,
    /// Nothing after this byte is read.
    end: usize,
    path: String,
    /// The values begun and not ended, each with the last key read in it.
    open: Vec<(KeyPlace, Option<KeyPlace>)>,
    /// The value ended last, and where.
    closed: Option<(KeyPlace, usize)>,
    /// Called at the start of every value; true ends the walk.
    found: F,
}

impl<'t, F: FnMut(&KeyPlace) -> bool> Walk<'t, F> {
    fn new(text: &'t str, end: usize, found: F) -> Self {
        let bytes = text.as_bytes();
        let end = end.min(bytes.len());
        Self { bytes, at: 0, end, path: String::new(), open: Vec::new(), closed: None, found }
    }

    /// Walks one value. `None` when the walk is over: found, at the end, or not JSON.
    fn value(&mut self, name: usize, depth: usize) -> Option<()> {
        self.skip_space();
        let name = if depth == 0 || self.path.ends_with(']') { self.at } else { name };
        let place = KeyPlace { key: self.path.clone(), value: self.at, name };
        let stop = (self.found)(&place);
        self.open.push((place, None));
        if stop || depth > MAX_DEPTH {
            return None;
        }
        match self.peek()? {
            b'{' => self.object(depth)?,
            b'[' => self.array(depth)?,
            b'"' => self.string()?,
            _ => self.word()?,
        }
        self.closed = self.open.pop().map(|(place, _)| (place, self.at));
        Some(())
    }

    fn object(&mut self, depth: usize) -> Option<()> {
        self.at += 1;
        loop {
            self.skip_space();
            match self.peek()? {
                b'}' => break,
                b',' => self.at += 1,
                b'"' => self.member(depth)?,
                _ => return None,
            }
        }
        self.at += 1;
        Some(())
    }

    fn member(&mut self, depth: usize) -> Option<()> {
        let name = self.at;
        self.string()?;
        let parent = self.path.len();
        if parent > 0 {
            self.path.push('.');
        }
        // A key with escapes stays as it is written: it is only compared with names that have none.
        self.path.push_str(&String::from_utf8_lossy(&self.bytes[name + 1..self.at - 1]));
        if let Some((_, last)) = self.open.last_mut() {
            *last = Some(KeyPlace { key: self.path.clone(), value: name, name });
        }
        self.skip_space();
        if self.peek()? != b':' {
            return None;
        }
        self.at += 1;
        self.value(name, depth + 1)?;
        self.path.truncate(parent);
        Some(())
    }

    fn array(&mut self, depth: usize) -> Option<()> {
        self.at += 1;
        let parent = self.path.len();
        for index in 0_usize.. {
            self.skip_space();
            if self.peek() == Some(b']') {
                break;
            }
            self.path.extend(["[", &index.to_string(), "]"]);
            self.value(self.at, depth + 1)?;
            self.path.truncate(parent);
            self.skip_space();
            match self.peek()? {
                b',' => self.at += 1,
                b']' => break,
                _ => return None,
            }
        }
        self.at += 1;
        Some(())
    }

    fn string(&mut self) -> Option<()> {
        self.at += 1;
        while self.peek()? != b'"' {
            self.at += if self.peek()? == b'\\' { 2 } else { 1 };
        }
        self.at += 1;
        Some(())
    }

    /// A number, `true`, `false` or `null`.
    fn word(&mut self) -> Option<()> {
        let start = self.at;
        while self.peek().is_some_and(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b)) {
            self.at += 1;
        }
        (self.at > start).then_some(())
    }

    fn skip_space(&mut self) {
        while self.peek().is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<u8> {
        if self.at < self.end { Some(self.bytes[self.at]) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "{\n  \"a\": [1, {\"b\": \"x\\\"]\"}],\n  \"ä\": {\"c\": null}\n}";

    #[test]
    fn a_path_is_found_where_it_stands() {
        for (key, line, column) in [
            ("", 1, 1),
            ("a", 2, 8),
            ("a[0]", 2, 9),
            ("a[1]", 2, 12),
            ("a[1].b", 2, 18),
            ("ä.c", 3, 14),
            // What the text lacks is reported at what holds it.
            ("a[1].nothing", 2, 12),
            ("a[7]", 2, 8),
            ("abc", 1, 1),
        ] {
            let place = place_of(TEXT, key);
            assert_eq!(line_and_column(TEXT, place.value), (line, column), "{key}");
        }
    }

    #[test]
    fn a_place_knows_its_path() {
        for (after, key, last) in [
            ("{\n  \"a\"", "", Some("a")),
            ("{\n  \"a\": [1", "a[0]", None),
            ("{\n  \"a\": [1,", "a[1]", None),
            ("{\n  \"a\": [1, {\"b\"", "a[1]", Some("a[1].b")),
            ("{\n  \"a\": [1, {\"b\": \"x", "a[1].b", None),
            ("{\n  \"a\": [1, {\"b\": \"x\\\"]\"}", "a[1]", None),
            ("{\n  \"a\": [1, {\"b\": \"x\\\"]\"}]", "a", None),
        ] {
            assert!(TEXT.starts_with(after));
            let (place, name) = place_at(TEXT, after.len());
            assert_eq!(place.key, key, "{after}");
            assert_eq!(name.map(|p| p.key).as_deref(), last, "{after}");
        }
    }

    #[test]
    fn nothing_is_read_out_of_bounds() {
        for text in ["", "\"", "\"\\", "{\"", "{\"a", "[", "[[[", "nul", "{\"a\":\"\\", "}", "[}"] {
            for consumed in 0..=text.len() + 2 {
                place_at(text, consumed);
            }
            place_of(text, "a[0].b");
            line_and_column(text, 99);
            byte_of(text, 9, 9);
        }
        let deep = "[".repeat(100_000);
        place_at(&deep, deep.len());
    }
}

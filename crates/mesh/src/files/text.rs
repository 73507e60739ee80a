//! What the line-based formats share: lines, numbers, and the counting of what is skipped.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use super::LoadError;

/// A statement: a line that is neither empty nor a comment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    pub(super) path: &'a Path,
    /// The number of its line, from 1.
    pub(super) line: usize,
    /// Its first word.
    pub(super) keyword: &'a str,
    /// What follows it, without white space at the ends.
    pub(super) rest: &'a str,
}

/// The statements of a text. Lines end with LF or CRLF; `#` at the beginning makes a comment, which may hold any
/// bytes; other lines are UTF-8. A byte order mark at the beginning is passed over.
pub(super) fn statements<'a>(path: &'a Path, text: &'a [u8]) -> impl Iterator<Item = Result<Statement<'a>, LoadError>> {
    let text = text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text);
    text.split(|&byte| byte == b'\n').enumerate().filter_map(move |(index, bytes)| {
        let bytes = bytes.trim_ascii();
        if bytes.is_empty() || bytes.starts_with(b"#") {
            return None;
        }
        let line = index + 1;
        let decoded = std::str::from_utf8(bytes).map_err(|error| LoadError::Line {
            path: path.to_owned(),
            line,
            found: format!("the byte 0x{:02X}", bytes[error.valid_up_to()]),
            expected: "UTF-8 text is".to_owned(),
        });
        Some(decoded.map(|text| {
            let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
            Statement { path, line, keyword, rest: rest.trim() }
        }))
    })
}

impl<'a> Statement<'a> {
    /// The words after the keyword, up to a comment at the end of the line.
    pub(super) fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.rest.split_whitespace().take_while(|word| !word.starts_with('#'))
    }

    pub(super) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> LoadError {
        LoadError::Line { path: self.path.to_owned(), line: self.line, found: found.into(), expected: expected.into() }
    }

    /// That the statement does not have the words it should have.
    pub(super) fn unexpected(&self, expected: &str) -> LoadError {
        self.error(format!("`{}`", abridged(self.keyword, self.rest)), expected)
    }

    /// That one of its words is not what it should be.
    pub(super) fn unexpected_word(&self, word: &str, expected: &str) -> LoadError {
        self.error(format!("`{}` in `{}`", abridged(word, ""), self.keyword), expected)
    }

    /// A word as a finite number.
    pub(super) fn number(&self, word: &str) -> Result<f32, LoadError> {
        match f32::from_str(word) {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(self.unexpected_word(word, "a finite number is")),
        }
    }
}

/// A statement as it is quoted in an error: a file may have lines of any length.
pub(super) fn abridged(keyword: &str, rest: &str) -> String {
    const LONGEST: usize = 60;
    let whole = format!("{keyword} {rest}");
    let whole = whole.trim_end();
    match whole.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole.to_owned(),
    }
}

/// Kinds of statements that were skipped, each with its first line and how many there were. A file of anything else
/// has as many kinds as words; past the first few they count as one.
#[derive(Debug, Default)]
pub(super) struct Skipped(BTreeMap<String, (usize, usize)>);

/// How many kinds are told apart.
const KINDS: usize = 20;

impl Skipped {
    /// Counts one of a kind, as "`begin` is skipped".
    pub(super) fn add(&mut self, line: usize, kind: impl Into<String>) {
        let mut kind = kind.into();
        if self.0.len() >= KINDS && !self.0.contains_key(&kind) {
            kind = String::from("something else is skipped or not found");
        }
        self.0.entry(kind).or_insert((line, 0)).1 += 1;
    }

    /// Counts a statement that is not read.
    pub(super) fn add_statement(&mut self, statement: &Statement) {
        self.add(statement.line, format!("`{}` is skipped", abridged(statement.keyword, "")));
    }

    /// A sentence for every kind, in the order of their first lines.
    pub(super) fn warnings(self, path: &Path) -> Vec<String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let mut kinds: Vec<_> = self.0.into_iter().collect();
        kinds.sort_by_key(|&(_, (line, _))| line);
        kinds
            .into_iter()
            .map(|(kind, (line, count))| match count {
                1 => format!("{name}:{line}: {kind}"),
                _ => format!("{name}:{line}: {kind} (and {} more such lines)", count - 1),
            })
            .collect()
    }
}

//! Shared by the line-based formats: lines, numbers, and the count of skipped statements.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use glam::Vec2;

use super::LoadError;
use super::source::{Reader, continued_at};

/// The statements of a text, one at a time: lines that are neither empty nor comments.
///
/// Lines end with LF, CRLF or CR; `#` at the beginning makes a comment, which may hold any bytes; other lines are UTF-8, or
/// else Latin-1, as older programs write names. A byte order mark at the beginning is skipped. No more than a line is
/// in memory.
pub(super) struct Statements<'a> {
    reader: Reader<'a>,
    buffer: Vec<u8>,
    /// The line in the buffer as text, where it is Latin-1.
    latin1: String,
    /// The first line that is Latin-1, and how many lines are.
    latin1_lines: Option<(usize, usize)>,
    /// The number of the line in the buffer, from 1, and how many lines were read.
    line: usize,
    read: usize,
    continued: bool,
}

impl<'a> Statements<'a> {
    /// If lines are `continued`, a backslash at the end of a line joins it with the next, unless it ends a comment.
    pub(super) fn new(reader: Reader<'a>, continued: bool) -> Self {
        let (buffer, latin1) = (Vec::new(), String::new());
        Self { reader, buffer, latin1, latin1_lines: None, line: 0, read: 0, continued }
    }

    /// Counts lines on from those before the reader's.
    pub(super) fn after(self, lines: usize) -> Self {
        Self { read: lines, ..self }
    }

    pub(super) fn path(&self) -> &'a Path {
        self.reader.path()
    }

    /// Counts the lines that are not UTF-8.
    pub(super) fn warn_of_encoding(&self, skipped: &mut Skipped) {
        if let Some((first, count)) = self.latin1_lines {
            skipped.add_several(first, count, "a line that is not UTF-8 is read as Latin-1");
        }
    }

    /// The number of the last line, for errors at the end of the file.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next statement.
    pub(super) fn next(&mut self) -> Result<Option<Statement<'_>>, LoadError> {
        loop {
            if !self.read_line()? {
                return Ok(None);
            }
            match self.buffer.trim_ascii_start().first() {
                None | Some(b'#') => {}
                Some(_) => break,
            }
        }
        let path = self.reader.path();
        let text = if let Ok(text) = str::from_utf8(self.buffer.trim_ascii()) {
            text
        } else {
            self.latin1_lines.get_or_insert((self.line, 0)).1 += 1;
            self.latin1.clear();
            self.latin1.extend(self.buffer.trim_ascii().iter().map(|&byte| char::from(byte)));
            &self.latin1
        };
        let (keyword, rest) = match text.bytes().position(|byte| byte.is_ascii_whitespace()) {
            Some(end) => (&text[..end], text[end..].trim_ascii_start()),
            None => (text, ""),
        };
        Ok(Some(Statement { path, line: self.line, keyword, rest }))
    }

    fn read_line(&mut self) -> Result<bool, LoadError> {
        self.buffer.clear();
        if !self.reader.line(&mut self.buffer)? {
            return Ok(false);
        }
        self.read += 1;
        self.line = self.read;
        if self.line == 1 && self.buffer.starts_with(b"\xEF\xBB\xBF") {
            self.buffer.drain(..3);
        }
        let mut last = 0;
        while self.continued && !has_comment(&self.buffer[last..]) {
            let Some(end) = continued_at(&self.buffer) else { break };
            self.buffer.truncate(end);
            self.buffer.push(b' ');
            last = self.buffer.len();
            if !self.reader.line(&mut self.buffer)? {
                break;
            }
            self.read += 1;
        }
        Ok(true)
    }
}

/// Whether a word of the line begins with `#`.
fn has_comment(line: &[u8]) -> bool {
    memchr::memchr_iter(b'#', line).any(|at| at == 0 || line[at - 1].is_ascii_whitespace())
}

/// A statement: a keyword and its words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    pub(super) path: &'a Path,
    /// The number of its line, from 1.
    pub(super) line: usize,
    /// Its first word.
    pub(super) keyword: &'a str,
    /// The text after it, trimmed.
    pub(super) rest: &'a str,
}

impl<'a> Statement<'a> {
    /// The words after the keyword, up to a comment at the end of the line.
    pub(super) fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#'))
    }

    /// The words after the keyword; there must be `N`.
    pub(super) fn exactly<const N: usize>(&self, expected: &str) -> Result<[&'a str; N], LoadError> {
        let mut found = [""; N];
        let mut words = self.words();
        for place in &mut found {
            *place = words.next().ok_or_else(|| self.unexpected(expected))?;
        }
        if words.next().is_some() {
            return Err(self.unexpected(expected));
        }
        Ok(found)
    }

    /// The words after the keyword as finite numbers, whose count must be one of `counts`, and how many there are.
    pub(super) fn numbers<const N: usize>(
        &self,
        counts: &[usize],
        expected: &str,
    ) -> Result<([f32; N], usize), LoadError> {
        let (words, count): ([&str; N], usize) = self.up_to(counts, expected)?;
        let mut found = [0.0; N];
        for (number, word) in found.iter_mut().zip(&words[..count]) {
            *number = self.number(word)?;
        }
        Ok((found, count))
    }

    /// The same as they are in the file, in f64; they may be NaN or infinite.
    pub(super) fn any_numbers<const N: usize>(
        &self,
        counts: &[usize],
        expected: &str,
    ) -> Result<([f64; N], usize), LoadError> {
        let (words, count): ([&str; N], usize) = self.up_to(counts, expected)?;
        let mut found = [0.0; N];
        for (number, word) in found.iter_mut().zip(&words[..count]) {
            *number = number64(word).ok_or_else(|| self.unexpected_word(word, "a finite number is"))?;
        }
        Ok((found, count))
    }

    /// The words after the keyword, whose count must be one of `counts`, and how many there are.
    fn up_to<const N: usize>(&self, counts: &[usize], expected: &str) -> Result<([&'a str; N], usize), LoadError> {
        let mut words = [""; N];
        let mut count = 0;
        for word in self.words() {
            *words.get_mut(count).ok_or_else(|| self.unexpected(expected))? = word;
            count += 1;
        }
        if counts.contains(&count) { Ok((words, count)) } else { Err(self.unexpected(expected)) }
    }

    pub(super) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> LoadError {
        LoadError::Line { path: self.path.to_owned(), line: self.line, found: found.into(), expected: expected.into() }
    }

    /// The error of a statement with the wrong words.
    pub(super) fn unexpected(&self, expected: &str) -> LoadError {
        self.error(format!("`{}`", abridged(self.keyword, self.rest)), expected)
    }

    /// The error of one wrong word.
    pub(super) fn unexpected_word(&self, word: &str, expected: &str) -> LoadError {
        self.error(format!("`{}` in `{}`", abridged(word, ""), abridged(self.keyword, "")), expected)
    }

    /// A word as a finite number.
    pub(super) fn number(&self, word: &str) -> Result<f32, LoadError> {
        match f32::from_str(word) {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(self.unexpected_word(word, "a finite number is")),
        }
    }

    /// Two of its words as texture coordinates, whose v runs upward in the file.
    pub(super) fn uv(&self, u: &str, v: &str) -> Result<Vec2, LoadError> {
        let u = self.number(u)?;
        self.number(v)?;
        // In f64, where v is flipped without loss.
        let v: f64 = v.parse().map_err(|_| self.unexpected_word(v, "a finite number is"))?;
        Ok(Vec2::new(u, (1.0 - v) as f32))
    }
}

/// A number, which may be NaN or infinite: an f64 that rounds to the same f32 as the text.
pub(super) fn number64(word: &str) -> Option<f64> {
    let x: f64 = word.parse().ok()?;
    // Rounding to f64 may end in the middle between two f32, from which a second rounding may lead astray.
    let is_between = x.to_bits() << 35 == 1 << 63 || x.abs() < f64::from(f32::MIN_POSITIVE);
    if is_between && x != 0.0 {
        let near: f32 = word.parse().ok()?;
        if near.to_bits() != (x as f32).to_bits() {
            return Some(if f64::from(near) > x { x.next_up() } else { x.next_down() });
        }
    }
    Some(x)
}

/// A statement as errors quote it, cut short: a file may have lines of any length.
pub(super) fn abridged(keyword: &str, rest: &str) -> String {
    const LONGEST: usize = 60;
    let mut shown: String = [keyword, " ", rest].into_iter().flat_map(str::chars).take(LONGEST + 1).collect();
    if shown.chars().count() > LONGEST {
        shown.pop();
        shown.push('…');
    } else {
        shown.truncate(shown.trim_end().len());
    }
    shown
}

/// Kinds of skipped statements, each with its first line and how many there were. A file of anything else has as many
/// kinds as words; beyond the first few they count as one.
#[derive(Debug, Default)]
pub(super) struct Skipped(BTreeMap<String, (usize, usize)>);

/// How many kinds are listed separately.
const KINDS: usize = 20;

impl Skipped {
    /// Counts one of a kind, as "`begin` is skipped".
    pub(super) fn add(&mut self, line: usize, kind: impl Into<String>) {
        self.add_several(line, 1, kind);
    }

    /// Counts several of a kind, of which the first is in this line.
    fn add_several(&mut self, line: usize, count: usize, kind: impl Into<String>) {
        let mut kind = kind.into();
        if self.0.len() >= KINDS && !self.0.contains_key(&kind) {
            kind = String::from("something else is skipped or not found");
        }
        self.0.entry(kind).or_insert((line, 0)).1 += count;
    }

    /// Counts a statement that is not supported.
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

#[cfg(test)]
mod tests {
    #![expect(clippy::float_cmp, reason = "the numbers of a text, to the last bit")]

    use super::*;

    #[test]
    fn numbers_round_to_the_f32_of_their_text() {
        // One above the middle of 1 and the next f32, by less than f64 holds; and a middle itself, which rounds to even.
        let above = "1.00000005960464477539062500000000001";
        assert_eq!(above.parse::<f64>().unwrap() as f32, 1.0);
        for (word, expected) in [
            (above, 1.0_f32.next_up()),
            ("1.00000005960464477539062499999999999", 1.0),
            ("1.000000059604644775390625", 1.0),
            ("0.1", 0.1),
            ("-0", -0.0),
            ("1e-46", 0.0),
            ("1e39", f32::INFINITY),
        ] {
            assert_eq!(number64(word).unwrap() as f32, expected, "{word}");
            assert_eq!(word.parse::<f32>().unwrap(), expected, "{word}");
        }
        assert_eq!(number64("500000.123456789"), Some(500_000.123_456_789));
        assert!(number64("nan").unwrap().is_nan() && number64("x").is_none());
    }
}

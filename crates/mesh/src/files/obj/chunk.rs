//! The common statements of a piece of the file: what can be read without the lines before it.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};

use crate::files::source::continued_at;
use crate::files::text::number64;

/// The statements of some whole lines. Chunks are read on all cores, and taken in their order.
#[derive(Default)]
pub(super) struct ObjChunk {
    pub(super) runs: Vec<StatementRun>,
    pub(super) positions: Vec<DVec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// As in the file: position, texture coordinate and normal, 0 for none.
    pub(super) corners: Vec<[i32; 3]>,
    /// How many lines there are.
    pub(super) lines: usize,
}

/// Lines of one kind that follow each other.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct StatementRun {
    pub(super) kind: RunKind,
    /// The lines before them in the chunk.
    pub(super) line: usize,
    /// How many lines.
    pub(super) count: usize,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) enum RunKind {
    /// `v` and three numbers.
    Positions,
    /// `vt` and two numbers.
    Uvs,
    /// `vn` and three numbers.
    Normals,
    /// `f` and so many corners, each with no index of 0.
    Faces(usize),
    /// Anything else, and what is not as expected: these bytes.
    Others(Range<usize>),
}

impl ObjChunk {
    pub(super) fn new(bytes: &[u8]) -> Self {
        let mut chunk = Self::default();
        let mut words = Words { bytes, at: 0 };
        let mut is_continued = false;
        while words.at < bytes.len() {
            let start = words.at;
            let common = if is_continued { None } else { chunk.statement(&mut words) };
            let kind = common.unwrap_or_else(|| {
                words.at = line_end(bytes, start);
                is_continued = continued_at(&bytes[start..words.at]).is_some();
                RunKind::Others(start..words.at)
            });
            chunk.push(kind);
        }
        chunk
    }

    fn push(&mut self, kind: RunKind) {
        let line = self.lines;
        self.lines += 1;
        if let Some(last) = self.runs.last_mut() {
            let goes_on = match (&mut last.kind, &kind) {
                (RunKind::Others(before), RunKind::Others(own)) => {
                    before.end = own.end;
                    true
                }
                (before, own) => before == own,
            };
            if goes_on {
                last.count += 1;
                return;
            }
        }
        self.runs.push(StatementRun { kind, line, count: 1 });
    }

    /// Reads a common statement with its line end.
    fn statement(&mut self, words: &mut Words) -> Option<RunKind> {
        match words.word() {
            b"v" => {
                let position = [words.number()?, words.number()?, words.number()?];
                words.end()?;
                self.positions.push(position.into());
                Some(RunKind::Positions)
            }
            b"vt" => {
                let [u, v] = [words.number()?, words.number()?];
                words.end()?;
                self.uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
                Some(RunKind::Uvs)
            }
            b"vn" => {
                let normal = [words.number()?, words.number()?, words.number()?];
                words.end()?;
                self.normals.push(Vec3::from_array(normal.map(|x| x as f32)));
                Some(RunKind::Normals)
            }
            b"f" => {
                let before = self.corners.len();
                while words.end().is_none() {
                    if let Some(corner) = words.corner() {
                        self.corners.push(corner);
                    } else {
                        self.corners.truncate(before);
                        return None;
                    }
                }
                let count = self.corners.len() - before;
                if count < 3 {
                    self.corners.truncate(before);
                }
                (count >= 3).then_some(RunKind::Faces(count))
            }
            _ => None,
        }
    }
}

/// The end of the line that begins at `start`, after its LF, CRLF or CR.
fn line_end(bytes: &[u8], start: usize) -> usize {
    match memchr::memchr2(b'\n', b'\r', &bytes[start..]) {
        Some(at) if bytes[start + at..].starts_with(b"\r\n") => start + at + 2,
        Some(at) => start + at + 1,
        None => bytes.len(),
    }
}

/// The words of a line.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    fn skip_blanks(&mut self) {
        self.at += self.bytes[self.at..].iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
    }

    /// The next word of the line, empty at its end.
    fn word(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|byte| **byte > b' ').count();
        self.at += length;
        &rest[..length]
    }

    /// Goes on behind the line end, if it comes next.
    fn end(&mut self) -> Option<()> {
        self.skip_blanks();
        let is_end = self.bytes.get(self.at).is_none_or(|byte| matches!(byte, b'\n' | b'\r'));
        is_end.then(|| self.at = line_end(self.bytes, self.at))
    }

    /// A number within f32.
    fn number(&mut self) -> Option<f64> {
        let number = number64(str::from_utf8(self.word()).ok()?)?;
        (number as f32).is_finite().then_some(number)
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, also with nothing after a slash.
    fn corner(&mut self) -> Option<[i32; 3]> {
        let mut rest = self.word();
        let mut corner = [0; 3];
        for (kind, place) in corner.iter_mut().enumerate() {
            if kind == 0 || rest.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'-') {
                *place = index(&mut rest)?;
            }
            match rest.split_first() {
                Some((b'/', others)) if kind < 2 => rest = others,
                Some(_) => return None,
                None => break,
            }
        }
        Some(corner)
    }
}

/// Takes an index other than 0 from the beginning.
fn index(word: &mut &[u8]) -> Option<i32> {
    let is_negative = word.first() == Some(&b'-');
    let digits = &word[usize::from(is_negative)..];
    let mut index = 0_i32;
    let mut length = 0;
    for byte in digits.iter().take_while(|byte| byte.is_ascii_digit()) {
        index = index.checked_mul(10)?.checked_add(i32::from(byte - b'0'))?;
        length += 1;
    }
    *word = &digits[length..];
    (index != 0).then_some(if is_negative { -index } else { index })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_lines_are_told_from_others() {
        use RunKind::{Faces, Normals, Others, Positions, Uvs};
        let text = b"# a\nv 1 2 3\r\nv\t-1 .5 1e2 \rvt 0 1\nvn 0 0 1\nf 1 2 3\nf 1/1 -2/-3/4 3//1\n\n f 1// 2/ 3 4\nf 1 2 \\\nf 3 4\nv 1 2";
        let chunk = ObjChunk::new(text);
        let runs: Vec<_> = chunk.runs.into_iter().map(|run| (run.kind, run.line, run.count)).collect();
        let at = |text_of: &[u8]| text.windows(text_of.len()).position(|window| window == text_of).unwrap();
        let continued = at(b"f 1 2 \\");
        assert_eq!(
            runs,
            [
                (Others(0..4), 0, 1),
                (Positions, 1, 2),
                (Uvs, 3, 1),
                (Normals, 4, 1),
                (Faces(3), 5, 2),
                (Others(at(b"\n\n") + 1..at(b"\n\n") + 2), 7, 1),
                (Faces(4), 8, 1),
                (Others(continued..text.len()), 9, 3),
            ]
        );
        assert_eq!(chunk.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 100.0)]);
        assert_eq!((chunk.uvs[0], chunk.normals[0], chunk.lines), (Vec2::ZERO, Vec3::Z, 12));
        assert_eq!(chunk.corners[3..6], [[1, 1, 0], [-2, -3, 4], [3, 0, 1]]);
    }

    #[test]
    fn lines_with_anything_wrong_are_left_to_the_general_reader() {
        for line in [
            "v 1 2",
            "v 1 2 x",
            "v 1 2 nan",
            "v 1 2 1e39",
            "v 1 2 3 4",
            "v 1 2 3 # c",
            "vt 1",
            "vt 0 0 0",
            "vn 0 0",
            "f 1 2",
            "f 0 1 2",
            "f 1/0 2 3",
            "f 1/1/1/1 2 3",
            "f 1 2 3.0",
            "f 1 2 99999999999",
            "f 1 2 -",
            "f 1 2 3 # c",
            "f 1 2 +3",
            "f 1 2 \\",
            "vp 1",
            "",
            "o f 1 2 3",
        ] {
            let chunk = ObjChunk::new(format!("{line}\n").as_bytes());
            assert!(matches!(chunk.runs[0].kind, RunKind::Others(_)), "{line}");
            assert!(chunk.positions.is_empty() && chunk.corners.is_empty(), "{line}");
        }
    }
}

//! The numbers of a body, one after the other.

use super::header::{Header, PlyEncoding, Scalar};
use crate::files::LoadError;
use crate::files::source::Reader;
use crate::files::text::abridged;

/// The numbers after the header.
pub(super) struct Values<'a> {
    reader: Reader<'a>,
    encoding: PlyEncoding,
    /// The current line of a text, or the next bytes of a binary body, and the end of the number that was read last.
    buffer: Vec<u8>,
    at: usize,
    /// The number of the line.
    line: usize,
}

/// So many bytes of a binary body are read ahead.
const AHEAD: usize = 1 << 18;

/// The element and property of a number, for errors.
#[derive(Clone, Copy)]
pub(super) struct ElementProperty<'p> {
    pub(super) element: &'p str,
    /// The element's number, from 0.
    pub(super) number: u64,
    pub(super) property: &'p str,
}

impl<'a> Values<'a> {
    pub(super) fn new(reader: Reader<'a>, header: &Header) -> Self {
        Self { reader, encoding: header.encoding, buffer: Vec::new(), at: 0, line: header.lines }
    }

    /// The next number. Every `f32` and every whole number of the format is exact.
    #[expect(clippy::inline_always, reason = "half of the time of reading is spent in calls otherwise")]
    #[inline(always)]
    pub(super) fn next(&mut self, scalar: Scalar, place: ElementProperty) -> Result<f64, LoadError> {
        match self.encoding {
            PlyEncoding::Ascii => self.word(scalar, place),
            PlyEncoding::LittleEndian => self.bytes(scalar, place, false),
            PlyEncoding::BigEndian => self.bytes(scalar, place, true),
        }
    }

    fn word(&mut self, scalar: Scalar, place: ElementProperty) -> Result<f64, LoadError> {
        loop {
            self.at += self.buffer[self.at..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            if self.at < self.buffer.len() {
                break;
            }
            self.buffer.clear();
            self.at = 0;
            if !self.reader.line(&mut self.buffer)? {
                return Err(self.error(place, "the end of the file", "a number is"));
            }
            self.line += 1;
        }
        let rest = &self.buffer[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let word = String::from_utf8_lossy(&rest[..end]);
        let number = match scalar {
            // Rounded once.
            Scalar::F32 => word.parse::<f32>().map(f64::from).ok(),
            Scalar::F64 => word.parse().ok(),
            _ => word.parse::<i64>().map(|number| number as f64).ok(),
        };
        let expected = if scalar.is_float() { "a number is" } else { "a whole number is" };
        let number = number.ok_or_else(|| self.error(place, &format!("`{}`", abridged(&word, "")), expected))?;
        self.at += end;
        Ok(number)
    }

    #[expect(clippy::inline_always, reason = "half of the time of reading is spent in calls otherwise")]
    #[inline(always)]
    fn bytes(&mut self, scalar: Scalar, place: ElementProperty, big: bool) -> Result<f64, LoadError> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.array(place, big)?).into(),
            Scalar::U8 => u8::from_le_bytes(self.array(place, big)?).into(),
            Scalar::I16 => i16::from_le_bytes(self.array(place, big)?).into(),
            Scalar::U16 => u16::from_le_bytes(self.array(place, big)?).into(),
            Scalar::I32 => i32::from_le_bytes(self.array(place, big)?).into(),
            Scalar::U32 => u32::from_le_bytes(self.array(place, big)?).into(),
            Scalar::F32 => f32::from_le_bytes(self.array(place, big)?).into(),
            Scalar::F64 => f64::from_le_bytes(self.array(place, big)?),
        })
    }

    /// The next bytes, in little-endian order.
    #[expect(clippy::inline_always, reason = "half of the time of reading is spent in calls otherwise")]
    #[inline(always)]
    fn array<const N: usize>(&mut self, place: ElementProperty, big: bool) -> Result<[u8; N], LoadError> {
        let mut bytes = match self.buffer.get(self.at..).and_then(<[u8]>::first_chunk) {
            Some(bytes) => *bytes,
            None => self.read_ahead(place)?,
        };
        self.at += N;
        if big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// The bytes ahead in a binary body: at least so many (up to 65536), unless it ends before; none in a text.
    pub(super) fn ahead(&mut self, least: usize) -> Result<&[u8], LoadError> {
        if self.encoding == PlyEncoding::Ascii {
            return Ok(&[]);
        }
        if self.buffer.len() - self.at < least {
            self.read_on()?;
        }
        Ok(&self.buffer[self.at..])
    }

    /// Goes on behind so many of the bytes ahead.
    pub(super) fn consume(&mut self, bytes: usize) {
        self.at += bytes;
    }

    pub(super) fn is_big_endian(&self) -> bool {
        self.encoding == PlyEncoding::BigEndian
    }

    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// Lets errors name another line of a text.
    pub(super) fn at_line(&mut self, line: usize) {
        self.line = line;
    }

    fn read_on(&mut self) -> Result<(), LoadError> {
        let left = self.buffer.len() - self.at;
        self.buffer.copy_within(self.at.., 0);
        self.at = 0;
        self.buffer.resize(AHEAD, 0);
        let read = self.reader.fill(&mut self.buffer[left..])?;
        self.buffer.truncate(left + read);
        Ok(())
    }

    /// Reads on, and returns the next bytes.
    #[cold]
    fn read_ahead<const N: usize>(&mut self, place: ElementProperty) -> Result<[u8; N], LoadError> {
        self.read_on()?;
        match self.buffer.first_chunk() {
            Some(bytes) => Ok(*bytes),
            None => Err(self.error(place, "the end of the file", "a number is")),
        }
    }

    pub(super) fn error(&self, place: ElementProperty, found: &str, expected: &str) -> LoadError {
        let path = self.reader.path().to_owned();
        let ElementProperty { element, number, property } = place;
        let element = format!("{} {number}, {}", abridged(element, ""), abridged(property, ""));
        let expected = expected.to_owned();
        match self.encoding {
            PlyEncoding::Ascii => {
                LoadError::Line { path, line: self.line, found: format!("{element}: {found}"), expected }
            }
            _ => LoadError::Element { path, element, found: found.to_owned(), expected },
        }
    }
}

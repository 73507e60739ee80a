//! The header: the elements of the file, and their encoding.

use crate::files::LoadError;
use crate::files::source::Reader;
use crate::files::text::abridged;

/// The encoding of the elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyEncoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// How many bytes it has in a binary body.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number in the first bytes, of which there are enough.
    pub(super) fn decode(self, bytes: &[u8], big: bool) -> f64 {
        fn first<const N: usize>(bytes: &[u8], big: bool) -> [u8; N] {
            let mut first = [0; N];
            first.copy_from_slice(&bytes[..N]);
            if big {
                first.reverse();
            }
            first
        }
        match self {
            Self::I8 => i8::from_le_bytes(first(bytes, big)).into(),
            Self::U8 => u8::from_le_bytes(first(bytes, big)).into(),
            Self::I16 => i16::from_le_bytes(first(bytes, big)).into(),
            Self::U16 => u16::from_le_bytes(first(bytes, big)).into(),
            Self::I32 => i32::from_le_bytes(first(bytes, big)).into(),
            Self::U32 => u32::from_le_bytes(first(bytes, big)).into(),
            Self::F32 => f32::from_le_bytes(first(bytes, big)).into(),
            Self::F64 => f64::from_le_bytes(first(bytes, big)),
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The value that means 1 in colours.
    pub(super) fn one(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

/// A property of an element: a number, or a list with its length before it.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// The type of the length.
    pub(super) list: Option<Scalar>,
}

/// Elements of one kind.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    /// The count that the file claims, unchecked.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// The header, and how many lines it has.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: PlyEncoding,
    pub(super) elements: Vec<Element>,
    pub(super) lines: usize,
}

/// Reads the header, including `end_header`.
pub(super) fn parse(reader: &mut Reader) -> Result<Header, LoadError> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut buffer = Vec::new();
    let mut line = 0;
    loop {
        line += 1;
        buffer.clear();
        let is_there = reader.line(&mut buffer)?;
        // Comments may be of any encoding.
        let text = String::from_utf8_lossy(&buffer);
        let text = text.trim_ascii();
        let error = |expected: &str| LoadError::Line {
            path: reader.path().to_owned(),
            line,
            found: if is_there { format!("`{}`", abridged(text, "")) } else { "the end of the file".to_owned() },
            expected: expected.to_owned(),
        };
        if !is_there {
            return Err(error("`end_header` is"));
        }
        if line == 1 {
            if text != "ply" {
                return Err(error("`ply` is"));
            }
            continue;
        }
        let words: Vec<&str> = text.split_ascii_whitespace().take(6).collect();
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", format, version] => {
                encoding = Some(match (format, version) {
                    ("ascii", "1.0") => PlyEncoding::Ascii,
                    ("binary_little_endian", "1.0") => PlyEncoding::LittleEndian,
                    ("binary_big_endian", "1.0") => PlyEncoding::BigEndian,
                    _ => {
                        return Err(error(
                            "`format`, one of ascii, binary_little_endian and binary_big_endian, and 1.0 are",
                        ));
                    }
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| error("`element`, a name and a number are"))?;
                if elements.iter().any(|before| before.name == name) {
                    return Err(error("an `element` of another name is"));
                }
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ..] => {
                let property = property(&words).ok_or_else(|| {
                    error(
                        "`property`, its type or `list` and two types (whole numbers for the first), and its name are",
                    )
                })?;
                let element = elements.last_mut().ok_or_else(|| error("an `element` before it is"))?;
                element.properties.push(property);
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| error("a `format` before it is"))?;
                return Ok(Header { encoding, elements, lines: line });
            }
            _ => return Err(error("`format`, `element`, `property`, `comment` or `end_header` is")),
        }
    }
}

fn property(words: &[&str]) -> Option<Property> {
    match *words {
        [_, "list", length, scalar, name] => {
            let length = Scalar::from_name(length).filter(|length| !length.is_float())?;
            Some(Property { name: name.to_owned(), scalar: Scalar::from_name(scalar)?, list: Some(length) })
        }
        [_, scalar, name] => Some(Property { name: name.to_owned(), scalar: Scalar::from_name(scalar)?, list: None }),
        _ => None,
    }
}

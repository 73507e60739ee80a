//! The bytes that a glTF file describes: in the file, in a data URI or in a file beside it.

use std::borrow::Cow;
use std::path::PathBuf;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::Document;
use gltf::buffer::{Buffer, Source};

use super::fault::Fault;
use super::meshopt;
use crate::files::source::{ModelFolder, Reader};
use crate::files::text::abridged;

/// Base64 as in RFC 4648, with or without the padding at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The data of a file.
pub(super) struct Buffers<'a> {
    /// Each of exactly the length that the document says.
    pub(super) all: Vec<Cow<'a, [u8]>>,
    /// How many bytes of them are in the file; others were unpacked.
    pub(super) bytes_of_file: usize,
}

/// All buffers of the document.
pub(super) fn resolve<'a>(
    document: &Document,
    mut binary: Option<&'a [u8]>,
    around: ModelFolder,
) -> Result<Buffers<'a>, Fault> {
    let (mut buffers, mut are_empty) = (Vec::new(), Vec::new());
    for buffer in document.buffers() {
        let bytes = match buffer.source() {
            Source::Bin => binary_chunk(&buffer, &mut binary).map(Cow::Borrowed),
            Source::Uri(uri) => from_uri(&name(&buffer), uri, around).map(Cow::Owned),
        };
        let is_empty = bytes.is_err()
            && matches!(buffer.source(), Source::Bin)
            && meshopt::is_unpacked_into(document.as_json(), buffer.index());
        buffers.push(if is_empty { Cow::Borrowed(&[][..]) } else { whole(&buffer, bytes?)? });
        are_empty.push(is_empty);
    }
    let bytes_of_file = buffers.iter().map(|buffer| buffer.len()).sum();
    meshopt::unpack(document.as_json(), &mut buffers, &are_empty)?;
    Ok(Buffers { all: buffers, bytes_of_file })
}

/// The bytes of a buffer, as many as it says.
fn whole<'a>(buffer: &Buffer, bytes: Cow<'a, [u8]>) -> Result<Cow<'a, [u8]>, Fault> {
    if bytes.len() < buffer.length() {
        return Err(Fault::element(
            name(buffer),
            format!("byteLength {} for {} bytes of data", buffer.length(), bytes.len()),
            "at most as many as there are is",
        ));
    }
    Ok(match bytes {
        Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[..buffer.length()]),
        Cow::Owned(mut bytes) => {
            bytes.truncate(buffer.length());
            Cow::Owned(bytes)
        }
    })
}

/// The bytes that a URI stands for; `name` is the element that has it.
pub(super) fn from_uri(name: &str, uri: &str, around: ModelFolder) -> Result<Vec<u8>, Fault> {
    match uri.strip_prefix("data:") {
        Some(data) => data_uri(name, data),
        None => file(name, uri, around),
    }
}

fn name(buffer: &Buffer) -> String {
    format!("buffers[{}]", buffer.index())
}

fn binary_chunk<'a>(buffer: &Buffer, binary: &mut Option<&'a [u8]>) -> Result<&'a [u8], Fault> {
    let chunk = if buffer.index() == 0 { binary.take() } else { None };
    chunk.ok_or_else(|| {
        let expected = "a uri, or a binary chunk for the first buffer, is";
        Fault::element(name(buffer), "neither", expected)
    })
}

/// The bytes of a data URI: base64, or text with `%20` and the like (RFC 2397).
fn data_uri(name: &str, data: &str) -> Result<Vec<u8>, Fault> {
    let Some((head, body)) = data.split_once(',') else {
        return Err(Fault::element(name.to_owned(), "a data uri without a comma", "one before the data is"));
    };
    if !head.ends_with(";base64") {
        return Ok(percent_decoded(body));
    }
    BASE64.decode(body).map_err(|error| Fault::element(name.to_owned(), error.to_string(), "base64 is"))
}

fn file(name: &str, uri: &str, around: ModelFolder) -> Result<Vec<u8>, Fault> {
    let refused = || {
        let expected = "a file in the folder of the model, or in one inside it, is";
        Fault::element(name.to_owned(), format!("uri {:?}", abridged(uri, "")), expected)
    };
    let decoded = String::from_utf8(percent_decoded(uri)).ok();
    let path = decoded.and_then(|decoded| place(&decoded, around)).ok_or_else(refused)?;
    // Some programs write the names of files as they are, so that what looks like an escape is part of a name.
    let raw = || place(uri, around).filter(|raw| raw.is_file());
    let path = if path.exists() { path } else { raw().unwrap_or(path) };
    around.open(&path).and_then(Reader::whole).map_err(Fault::Elsewhere)
}

/// The path of a file, if it may be read. A colon makes a scheme, or a drive; a backslash separates folders on some systems
/// and not on others.
fn place(name: &str, around: ModelFolder) -> Option<PathBuf> {
    if name.contains([':', '\\', '\0']) { None } else { around.find(name) }
}

/// `%20` and the like resolved (RFC 3986 §2.1). A `%` without two hexadecimal digits after it stands for itself.
fn percent_decoded(uri: &str) -> Vec<u8> {
    let digit = |byte: &u8| char::from(*byte).to_digit(16);
    let mut decoded = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [byte, after @ ..] = rest {
        let escape = match after {
            [high, low, ..] if *byte == b'%' => digit(high).zip(digit(low)),
            _ => None,
        };
        decoded.push(escape.map_or(*byte, |(high, low)| (high * 16 + low) as u8));
        rest = if escape.is_some() { &after[2..] } else { after };
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::percent_decoded;

    #[test]
    fn percent_decoding() {
        for (uri, decoded) in [
            ("a.bin", &b"a.bin"[..]),
            ("my%20file.bin", b"my file.bin"),
            ("%2e%2E/a", b"../a"),
            ("%C3%A9", "é".as_bytes()),
            ("%E9", b"\xE9"),
            ("10%", b"10%"),
            ("10%.bin", b"10%.bin"),
            ("%2", b"%2"),
            ("%zz%20", b"%zz "),
            ("%%41", b"%A"),
            ("a%00", b"a\0"),
        ] {
            assert_eq!(percent_decoded(uri), decoded, "{uri}");
        }
    }
}

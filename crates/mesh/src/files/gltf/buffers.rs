//! The bytes that a glTF file describes: in the file, in a data URI or in a file beside it.

use std::borrow::Cow;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::Document;
use gltf::buffer::{Buffer, Source};

use super::fault::Fault;
use crate::files::source::{ModelFolder, Reader};
use crate::files::text::abridged;

/// Base64 as in RFC 4648, with or without the padding at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// All buffers of the document, each of exactly the length that the document says.
pub(super) fn resolve<'a>(
    document: &Document,
    mut binary: Option<&'a [u8]>,
    around: ModelFolder,
) -> Result<Vec<Cow<'a, [u8]>>, Fault> {
    document
        .buffers()
        .map(|buffer| {
            let bytes = match buffer.source() {
                Source::Bin => Cow::Borrowed(binary_chunk(&buffer, &mut binary)?),
                Source::Uri(uri) => Cow::Owned(from_uri(&name(&buffer), uri, around)?),
            };
            if bytes.len() < buffer.length() {
                return Err(Fault::element(
                    name(&buffer),
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
        })
        .collect()
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

fn data_uri(name: &str, data: &str) -> Result<Vec<u8>, Fault> {
    let (head, body) = data.split_once(',').unwrap_or((data, ""));
    if !head.ends_with(";base64") {
        let expected = "a data uri in base64 is";
        return Err(Fault::element(name.to_owned(), "another data uri", expected));
    }
    BASE64.decode(body).map_err(|error| Fault::element(name.to_owned(), error.to_string(), "base64 is"))
}

fn file(name: &str, uri: &str, around: ModelFolder) -> Result<Vec<u8>, Fault> {
    let refused = || {
        let expected = "a file in the folder of the model, or in one inside it, is";
        Fault::element(name.to_owned(), format!("uri {:?}", abridged(uri, "")), expected)
    };
    let decoded = percent_decoded(uri).ok_or_else(refused)?;
    // A colon makes a scheme, or a drive; a backslash separates folders on some systems and not on others.
    if decoded.contains([':', '\\']) {
        return Err(refused());
    }
    let path = around.find(&decoded).ok_or_else(refused)?;
    around.open(&path).and_then(Reader::whole).map_err(Fault::Elsewhere)
}

/// `%20` and the like resolved (RFC 3986 §2.1); `None` where a `%` has no two hexadecimal digits after it, or where
/// the result is not UTF-8 or holds a zero byte.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        decoded.push(if byte == b'%' {
            let digit = |byte: u8| char::from(byte).to_digit(16);
            (digit(rest.next()?)? * 16 + digit(rest.next()?)?) as u8
        } else {
            byte
        });
    }
    String::from_utf8(decoded).ok().filter(|text| !text.contains('\0'))
}

#[cfg(test)]
mod tests {
    use super::percent_decoded;

    #[test]
    fn percent_decoding() {
        for (uri, decoded) in [
            ("a.bin", Some("a.bin")),
            ("my%20file.bin", Some("my file.bin")),
            ("%2e%2E/a", Some("../a")),
            ("%C3%A9", Some("é")),
            ("%E9", None),
            ("%2", None),
            ("%zz", None),
            ("a%00", None),
        ] {
            assert_eq!(percent_decoded(uri).as_deref(), decoded, "{uri}");
        }
    }
}

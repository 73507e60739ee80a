//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: packed buffer views.
//!
//! Views whose buffer has no data of its own are unpacked into it, so that the rest of the reader sees plain buffers.
//! A decoder of our own: `meshopt` is a binding to C++, and `meshopt-rs`, its port to Rust, has not been kept since 2022
//! and stops the program on malformed data.

mod attributes;
mod bytes;
mod filters;
mod indices;

use std::borrow::Cow;

use gltf::json::Root;
use gltf::json::buffer::View;
use gltf::json::validation::USize64;
use serde::Deserialize;
use serde_json::Value;

use super::accessor::EXPANSION;
use super::fault::Fault;

/// The names of the extension.
pub(super) const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Where the packed bytes of a view are, and how they are packed.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Packed {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Default, Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

/// Whether a view of this buffer is packed.
pub(super) fn is_unpacked_into(json: &Root, buffer: usize) -> bool {
    json.buffer_views.iter().any(|view| view.buffer.value() == buffer && extension(view).is_some())
}

/// The extension of a view, and its name.
fn extension(view: &View) -> Option<(&'static str, &Value)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.iter().find_map(|name| Some((*name, others.get(*name)?)))
}

/// Fills the buffers that have no data with their unpacked views.
pub(super) fn unpack(json: &Root, buffers: &mut [Cow<[u8]>], is_empty: &[bool]) -> Result<(), Fault> {
    let mut left = buffers.iter().map(|buffer| buffer.len()).sum::<usize>().saturating_mul(EXPANSION);
    for (index, view) in json.buffer_views.iter().enumerate() {
        let Some((name, value)) = extension(view) else { continue };
        let into = view.buffer.value();
        if is_empty.get(into) != Some(&true) {
            continue;
        }
        let element = || format!("bufferViews[{index}].extensions.{name}");
        let packed = Packed::deserialize(value).map_err(|error| {
            Fault::element(element(), error.to_string(), "buffer, byteLength, byteStride, count and mode are")
        })?;
        let place = place(view, &packed).map_err(|found| Fault::element(element(), found.0, found.1))?;
        let data = packed_bytes(&packed, buffers, is_empty)
            .ok_or_else(|| Fault::element(element(), "bytes that are not there", "a part of a buffer with data is"))?;
        // Unfilled gaps between views count as well.
        let more = place.end.saturating_sub(buffers[into].len()) + (place.end - place.start);
        left = left.checked_sub(more).ok_or_else(|| {
            let found = format!("{} items of {} bytes", packed.count, packed.byte_stride);
            Fault::element(
                element(),
                found,
                format!("at most {EXPANSION} times the bytes of the file, in all views, are"),
            )
        })?;
        let unpacked = packed.unpacked(data).ok_or_else(|| {
            Fault::element(
                element(),
                format!("packed data that do not make {} items", packed.count),
                "a whole stream is",
            )
        })?;
        let buffer = buffers[into].to_mut();
        if buffer.len() < place.end {
            buffer.resize(place.end, 0);
        }
        buffer[place].copy_from_slice(&unpacked);
    }
    Ok(())
}

/// The place of the unpacked bytes in the buffer of their view; otherwise what was found and what is expected.
fn place(view: &View, packed: &Packed) -> Result<std::ops::Range<usize>, (String, &'static str)> {
    let whole = |size: USize64| usize::try_from(size.0).unwrap_or(usize::MAX);
    let stride = packed.byte_stride;
    let (is_possible, expected) = match (packed.mode, packed.filter) {
        (Mode::Attributes, Filter::None | Filter::Exponential) => {
            ((4..=256).contains(&stride) && stride.is_multiple_of(4), "a multiple of 4 up to 256 is")
        }
        (Mode::Attributes, Filter::Octahedral | Filter::Color) => (stride == 4 || stride == 8, "4 or 8 is"),
        (Mode::Attributes, Filter::Quaternion) => (stride == 8, "8 is"),
        (Mode::Triangles | Mode::Indices, _) => (stride == 2 || stride == 4, "2 or 4 is"),
    };
    if !is_possible {
        return Err((format!("byteStride {stride}"), expected));
    }
    let start = view.byte_offset.map_or(0, whole);
    let length = packed.count.checked_mul(stride).filter(|length| *length <= whole(view.byte_length) && *length > 0);
    let end = length.and_then(|length| start.checked_add(length));
    end.map(|end| start..end)
        .ok_or_else(|| (format!("count {}", packed.count), "at least one item, and no more than the view holds, is"))
}

fn packed_bytes<'b>(packed: &Packed, buffers: &'b [Cow<[u8]>], is_empty: &[bool]) -> Option<&'b [u8]> {
    let end = packed.byte_offset.checked_add(packed.byte_length)?;
    let buffer = buffers.get(packed.buffer).filter(|_| !is_empty[packed.buffer])?;
    buffer.get(packed.byte_offset..end)
}

impl Packed {
    fn unpacked(&self, data: &[u8]) -> Option<Vec<u8>> {
        let (count, stride) = (self.count, self.byte_stride);
        match self.mode {
            Mode::Triangles => indices::triangles(data, count).map(|all| indices::to_bytes(&all, stride)),
            Mode::Indices => indices::sequence(data, count).map(|all| indices::to_bytes(&all, stride)),
            Mode::Attributes => {
                let mut bytes = attributes::decode(data, count, stride)?;
                match (self.filter, stride) {
                    (Filter::None, _) => {}
                    (Filter::Octahedral, 4) => filters::octahedral_8(&mut bytes),
                    (Filter::Octahedral, _) => filters::octahedral_16(&mut bytes),
                    (Filter::Quaternion, _) => filters::quaternion(&mut bytes),
                    (Filter::Exponential, _) => filters::exponential(&mut bytes),
                    (Filter::Color, 4) => filters::color_8(&mut bytes),
                    (Filter::Color, _) => filters::color_16(&mut bytes),
                }
                Some(bytes)
            }
        }
    }
}

#[cfg(test)]
mod tests;

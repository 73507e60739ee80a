//! glTF 2.0, in text and binary.
//!
//! The `gltf` crate reads the JSON and checks that every index refers to an element; it does not check that the data
//! exist, and its readers may panic where they do not. So every buffer, view and accessor is measured before reading.

mod accessor;
mod animations;
mod buffers;
mod document;
mod extensions;
mod fault;
mod images;
mod instances;
mod material;
mod meshopt;
mod nodes;
mod placed;
mod primitive;
mod scene;
mod skins;

use std::sync::Arc;

use gltf::{Document, Glb};

use self::accessor::Accessors;
use self::animations::Clips;
use self::buffers::Buffers;
use self::document::{Opened, open};
use self::extensions::QUANTIZATION;
use self::fault::Fault;
use self::images::Images;
use self::nodes::Nodes;
use self::primitive::Primitives;
use super::source::{ModelFolder, Source};
use super::{Format, LoadError};
use crate::{Animations, Model};

/// Reads the default scene of a glTF file.
pub(super) fn parse(source: Source, format: Format) -> Result<Model, LoadError> {
    let Source { path, reader, around } = source;
    let bytes = reader.whole()?;
    read(&bytes, format == Format::Glb, around).map_err(|fault| fault.at(path))
}

fn read(bytes: &[u8], is_binary: bool, around: ModelFolder) -> Result<Model, Fault> {
    // A slice of the file, not a copy.
    let container = if is_binary || bytes.starts_with(b"glTF") { Some(open_container(bytes)?) } else { None };
    let Opened { document, beside, dropped_channels } = open(container.as_ref().map_or(bytes, |glb| &glb.json))?;
    let binary = container.as_ref().and_then(|glb| glb.bin.as_deref());
    let Buffers { all: buffers, bytes_of_file } = buffers::resolve(&document, binary, around)?;
    let mut images = Images::new(document.as_json(), &buffers, around);
    let materials = material::materials(&document, &mut images)?;
    let Images { warnings: of_images, mut used, .. } = images;
    used.sort_unstable();
    used.dedup();
    let mut warnings = Vec::new();
    warn_of_skipped(&document, used.len(), &mut warnings);
    warnings.extend(of_images);
    let is_quantized = document.extensions_used().any(|extension| extension == QUANTIZATION);
    let mut primitives = Primitives::new(Accessors::new(&buffers, bytes_of_file, is_quantized));
    let with_more_targets = beside.with_more_targets();
    let mut nodes = Nodes::new(&document, beside.nodes);
    let contents = scene::read(&document, &mut nodes, &mut primitives)?;
    let Clips { clips, unknown } = Clips::read(&document, &nodes, &mut primitives.accessors)?;
    if let Some((count, first)) = nodes.mended.take() {
        let more = if count > 1 { format!(" (and {} more such matrices)", count - 1) } else { String::new() };
        warnings.push(format!("{first} is taken for 0, 0, 0, 1{more}"));
    }
    for (count, what) in [
        (
            unknown + dropped_channels,
            "channels of animations are skipped, since they move no node that is shown, or a property that is not known",
        ),
        (contents.without_joints, "meshes of nodes with a skin have no joints or no weights, and stay as they are"),
        (with_more_targets, "primitives have morph targets of colours or texture coordinates, which are skipped"),
    ] {
        if count > 0 {
            warnings.push(format!("{count} {what}"));
        }
    }
    let (model, animations) = placed::model(contents, nodes, &mut primitives)?;
    warnings.extend(primitives.into_warnings());
    let animations = (!clips.is_empty()).then(|| Arc::new(Animations { clips, ..animations }));
    Ok(Model { materials, animations, warnings, ..model })
}

fn open_container(bytes: &[u8]) -> Result<Glb<'_>, Fault> {
    check_header(bytes)?;
    Glb::from_slice(bytes).map_err(|error| unreadable(&error))
}

/// Checks the header of a binary file (magic, version, length): its reader subtracts from the length unchecked.
fn check_header(bytes: &[u8]) -> Result<(), Fault> {
    const HEADER: usize = 12;
    let header = |found: String, expected: &str| Fault::element("GLB header", found, expected);
    if !bytes.starts_with(b"glTF") {
        return Err(header("no magic".to_owned(), "a file that begins with \"glTF\" is"));
    }
    let Some(&[a, b, c, d]) = bytes.get(8..HEADER) else {
        let found = format!("{} bytes", bytes.len());
        return Err(header(found, "at least 12 bytes are"));
    };
    let length = u32::from_le_bytes([a, b, c, d]) as usize;
    if length < HEADER || length > bytes.len() {
        let found = format!("length {length}");
        let expected = format!("at most the file's {} bytes are", bytes.len());
        return Err(header(found, &expected));
    }
    Ok(())
}

fn unreadable(error: &gltf::Error) -> Fault {
    Fault::element("GLB", error.to_string(), "a whole binary glTF file is")
}

fn warn_of_skipped(document: &Document, used_textures: usize, warnings: &mut Vec<String>) {
    warnings.extend(extensions::warnings(document));
    let textures = document.textures().len() - used_textures;
    if textures > 0 {
        warnings.push(format!("textures are skipped ({textures})"));
    }
    if document.scenes().len() > 1 {
        let count = document.scenes().len();
        warnings.push(format!("only the default scene of {count} is read"));
    }
}

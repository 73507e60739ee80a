//! glTF 2.0, in text and binary.
//!
//! The `gltf` crate reads the JSON and checks that every index refers to an element; it does not check that the data
//! exist, and its readers may panic where they do not. So every buffer, view and accessor is measured before reading.

mod accessor;
mod buffers;
mod fault;
mod images;
mod material;
mod primitive;
mod scene;

use gltf::json::Root;
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::ENABLED_EXTENSIONS;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::{Document, Glb, Gltf};

use self::accessor::Accessors;
use self::fault::Fault;
use self::images::Images;
use self::primitive::Primitives;
use super::source::{ModelFolder, Source};
use super::{Format, LoadError};
use crate::Model;

/// The extension that allows integers in attributes.
const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Reads the default scene of a glTF file.
pub(super) fn parse(source: Source, format: Format) -> Result<Model, LoadError> {
    let Source { path, reader, around } = source;
    let bytes = reader.whole()?;
    read(&bytes, format == Format::Glb, around).map_err(|fault| fault.at(path))
}

fn read(bytes: &[u8], is_binary: bool, around: ModelFolder) -> Result<Model, Fault> {
    // A slice of the file, not a copy.
    let container = if is_binary || bytes.starts_with(b"glTF") { Some(open_container(bytes)?) } else { None };
    let document = open(container.as_ref().map_or(bytes, |glb| &glb.json))?;
    let binary = container.as_ref().and_then(|glb| glb.bin.as_deref());
    let buffers = buffers::resolve(&document, binary, around)?;
    let mut warnings = Vec::new();
    let mut images = Images::new(&buffers, around);
    let materials = material::materials(&document, &mut images)?;
    let Images { warnings: of_images, mut used, .. } = images;
    used.sort_unstable();
    used.dedup();
    warn_of_skipped(&document, used.len(), &mut warnings);
    warnings.extend(of_images);
    let is_quantized = document.extensions_used().any(|extension| extension == QUANTIZATION);
    let mut primitives = Primitives::new(Accessors::new(&buffers, is_quantized));
    let scene::Contents { parts, lines, lights, cameras, mended } = scene::read(&document, &mut primitives)?;
    if let Some((count, first)) = mended {
        let more = if count > 1 { format!(" (and {} more such matrices)", count - 1) } else { String::new() };
        warnings.push(format!("{first} is taken for 0, 0, 0, 1{more}"));
    }
    warnings.extend(primitives.into_warnings());
    Ok(Model { parts, lines, materials, lights, cameras, warnings, ..Model::default() })
}

fn open_container(bytes: &[u8]) -> Result<Glb<'_>, Fault> {
    check_header(bytes)?;
    Glb::from_slice(bytes).map_err(|error| unreadable(&error))
}

/// The document, valid as far as the `gltf` crate looks.
fn open(json: &[u8]) -> Result<Document, Fault> {
    // A binary file in the place of text, which the `gltf` crate would open without checking its header.
    if json.starts_with(b"glTF") {
        return Err(Fault::element("JSON chunk", "binary glTF", "JSON is"));
    }
    let Gltf { document, .. } = Gltf::from_slice_without_validation(json).map_err(|error| unreadable(&error))?;
    let mut json = document.into_json();
    if !json.asset.version.starts_with("2.") {
        let found = format!("version {:?}", json.asset.version);
        return Err(Fault::element("asset.version", found, "version \"2.0\" is"));
    }
    // The `gltf` crate refuses extensions that it does not read itself.
    json.extensions_required.retain(|extension| extension != QUANTIZATION);
    for extension in &json.extensions_required {
        if !ENABLED_EXTENSIONS.contains(&extension.as_str()) {
            return Err(Fault::RequiredExtension(extension.clone()));
        }
    }
    check_positions(&json)?;
    check_cameras(&json)?;
    // Attributes of an application's own, as `_ID`, are allowed; the `gltf` crate reports them as mistakes.
    for primitive in json.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.attributes.remove(&Checked::Invalid);
    }
    Document::from_json(json).map_err(|error| invalid(&error))
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

/// Checks that the accessors of positions exist: the `gltf` crate's validation looks them up before checking.
fn check_positions(json: &Root) -> Result<(), Fault> {
    for (m, mesh) in json.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            let Some(position) = position.filter(|index| index.value() >= json.accessors.len()) else {
                continue;
            };
            return Err(Fault::element(
                format!("meshes[{m}].primitives[{p}].attributes.POSITION"),
                format!("accessor {}", position.value()),
                format!("one of the {} accessors, from 0, is", json.accessors.len()),
            ));
        }
    }
    Ok(())
}

/// Checks that cameras have the projection that they name, which the `gltf` crate takes for granted.
fn check_cameras(json: &Root) -> Result<(), Fault> {
    for (index, camera) in json.cameras.iter().enumerate() {
        let is_there = match camera.type_ {
            Checked::Valid(CameraType::Perspective) => camera.perspective.is_some(),
            Checked::Valid(CameraType::Orthographic) => camera.orthographic.is_some(),
            // Validation finds this.
            Checked::Invalid => true,
        };
        if !is_there {
            return Err(Fault::element(format!("cameras[{index}]"), "no projection of its type", "one is"));
        }
    }
    Ok(())
}

fn unreadable(error: &gltf::Error) -> Fault {
    let (element, expected) = match error {
        gltf::Error::Binary(_) => ("GLB", "a whole binary glTF file is"),
        _ => ("JSON", "a glTF 2.0 document is"),
    };
    Fault::element(element, error.to_string(), expected)
}

fn invalid(error: &gltf::Error) -> Fault {
    match error {
        gltf::Error::Validation(errors) if !errors.is_empty() => {
            let (path, error) = &errors[0];
            let more = match errors.len() - 1 {
                0 => String::new(),
                n => format!(" (and {n} more)"),
            };
            let found = format!("{}{more}", error.to_string().to_lowercase());
            Fault::element(path.to_string(), found, "valid glTF 2.0 is")
        }
        _ => unreadable(error),
    }
}

fn warn_of_skipped(document: &Document, used_textures: usize, warnings: &mut Vec<String>) {
    for extension in document.extensions_used() {
        if !ENABLED_EXTENSIONS.contains(&extension) && extension != QUANTIZATION {
            warnings.push(format!("the extension {extension} is skipped"));
        }
    }
    let counts = [
        ("animations", document.animations().len()),
        ("skins", document.skins().len()),
        ("textures", document.textures().len() - used_textures),
    ];
    for (what, count) in counts {
        if count > 0 {
            warnings.push(format!("{what} are skipped ({count})"));
        }
    }
    if document.scenes().len() > 1 {
        let count = document.scenes().len();
        warnings.push(format!("only the default scene of {count} is read"));
    }
}

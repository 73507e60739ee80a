//! Extensions of glTF: which are read, and which may be left out.

use gltf::Document;
use gltf::json::extensions::ENABLED_EXTENSIONS;

use super::fault::Fault;
use super::meshopt;

/// Integers in attributes.
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";
/// One mesh at many places.
pub(super) const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// Images in WebP.
pub(super) const WEBP: &str = "EXT_texture_webp";
/// Images in Basis Universal, which nothing here decodes.
pub(super) const BASISU: &str = "KHR_texture_basisu";
/// Triangles that Draco packed.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// The extensions that are read here, besides those of the `gltf` crate.
const READ: [&str; 3] = [QUANTIZATION, INSTANCING, WEBP];

/// The beginnings of the names of extensions that change how a model looks, moves or is described, but not its shape:
/// files that require them are shown without.
const LESS: [&str; 16] = [
    "KHR_materials_",
    "EXT_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "MSFT_packing_",
    "EXT_lights_",
    "KHR_animation_",
    "KHR_audio",
    "KHR_xmp",
    "KHR_interactivity",
    "KHR_node_",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "CESIUM_primitive_outline",
];

/// Whether it is read, all of it.
pub(super) fn is_read(extension: &str) -> bool {
    extension != BASISU && ENABLED_EXTENSIONS.contains(&extension) && !extension.starts_with("MSFT_")
        || READ.contains(&extension)
        || meshopt::NAMES.contains(&extension)
}

/// Checks that the file can be shown without the extensions that are not read.
pub(super) fn check_required(required: &[String]) -> Result<(), Fault> {
    let is_needed = |name: &&String| !is_read(name) && !LESS.iter().any(|beginning| name.starts_with(beginning));
    match required.iter().find(is_needed) {
        Some(extension) => Err(self::required(extension)),
        None => Ok(()),
    }
}

/// Sentences about those that are not read.
pub(super) fn warnings(document: &Document) -> impl Iterator<Item = String> {
    let required = |extension: &str| document.extensions_required().any(|other| other == extension);
    document.extensions_used().filter(|extension| !is_read(extension)).map(move |extension| {
        let though = if required(extension) { ", though the file requires it" } else { "" };
        format!("the extension {extension} is skipped{though}")
    })
}

/// The error of a file that cannot be shown without an extension.
pub(super) fn required(extension: &str) -> Fault {
    let remedy = match extension {
        DRACO => "; `gltf-transform copy` writes the file without it",
        _ => "",
    };
    Fault::RequiredExtension { extension: extension.to_owned(), remedy }
}

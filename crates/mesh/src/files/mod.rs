//! Model files: which there are, and how they are opened.

mod error;
mod format;
mod gltf;
mod obj;
mod ply;
mod polygon;
mod smf;
mod source;
mod stl;
mod text;
mod write;

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::Path;

use crate::Model;

pub use error::LoadError;
pub use format::Format;
pub use source::{LoadOptions, LoadProgress};
pub use write::{WriteError, write, write_quantised};

use source::Source;

/// Reads a model file. Its format is told by its extension, in either case:
///
/// | extension | format | what is read |
/// |---|---|---|
/// | `smf` | Garland's SMF | vertices, triangles, scopes, transforms, bound normals, colours and texture coordinates; a part for each group |
/// | `obj` | Wavefront OBJ with its MTL files | polygons, normals, texture coordinates, colours, smoothing groups, materials; a part for each name of an object or group and material |
/// | `gltf`, `glb` | glTF 2.0 | the default scene: nodes, cameras, triangles, normals, tangents, the first texture coordinates and colours, metallic-roughness factors, `KHR_lights_punctual`, `KHR_mesh_quantization`; a part for each primitive of each node |
/// | `ply` | PLY | polygons and strips, normals, texture coordinates and colours of vertices, as one part |
/// | `stl` | STL | triangles, with vertices at equal positions as one; a part for each solid |
///
/// Polygons are cut into triangles, concave ones too. Files that a model refers to are read only from its own folder
/// and those in it. What is skipped is said in [`Model::warnings`]. Normals that are missing are those of the default
/// [weighting](crate::NormalWeighting).
///
/// No memory is taken on the word of a number in the file: what is allocated is in proportion to the data that is
/// there.
///
/// # Errors
/// The file is missing, empty, not a regular file or of another format; it is malformed, where the error names the line
/// or the element and what was expected there; or it holds no triangle.
pub fn load(path: &Path) -> Result<Model, LoadError> {
    load_with(path, LoadOptions::default(), &mut |_| ControlFlow::Continue(()))
}

/// [`load`], with options, and with a function that is told now and then how far a large file is read; where it breaks,
/// the error is [`LoadError::Stopped`].
///
/// # Errors
/// As [`load`].
pub fn load_with(
    path: &Path,
    options: LoadOptions,
    progress: &mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
) -> Result<Model, LoadError> {
    let Some(format) = Format::of(path) else {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        return Err(LoadError::UnknownExtension { path: path.to_owned(), extension });
    };
    // Several readers tell it, one at a time.
    let progress = RefCell::new(progress);
    let on_progress = |at| (progress.borrow_mut())(at);
    parse(format, Source::open(path, options, &on_progress)?)
}

/// Reads a model that is in memory. It has no folder: files that it refers to are not read. In errors it goes by the
/// name `model` and the format's extension.
///
/// # Errors
/// As [`load`].
pub fn load_bytes(format: Format, bytes: &[u8]) -> Result<Model, LoadError> {
    let name = format!("model.{}", format.extension());
    let path = Path::new(&name);
    parse(format, Source::of_bytes(path, bytes)?)
}

fn parse(format: Format, source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let model = match format {
        Format::Smf => smf::parse(source),
        Format::Obj => obj::parse(source),
        Format::Gltf | Format::Glb => gltf::parse(source, format),
        Format::Ply => ply::parse(source),
        Format::Stl => stl::parse(source),
    }?;
    if model.parts.is_empty() {
        let skipped = model.warnings.into_iter().next();
        return Err(LoadError::NoTriangles { path: path.to_owned(), skipped });
    }
    Ok(model)
}

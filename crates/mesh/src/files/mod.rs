//! Model files: their formats, and how they are opened.

mod error;
mod format;
mod gltf;
mod obj;
mod off;
mod ply;
mod polygon;
mod smf;
mod source;
mod srgb;
mod stl;
mod text;
#[cfg(feature = "threemf")]
mod threemf;
mod write;

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::Path;

use crate::Model;

pub use error::LoadError;
pub use format::Format;
pub use source::{LoadOptions, LoadProgress, MOST_PIPED};
pub use write::{WriteError, write, write_ascii, write_quantised};

use source::Source;

/// Reads a model file. Its format is told by its extension, in upper or lower case:
///
/// | extension | format | contents that are read |
/// |---|---|---|
/// | `smf` | Garland's SMF | vertices, triangles, scopes, transforms, bound normals, colours and texture coordinates; a part for each group |
/// | `obj` | Wavefront OBJ with its MTL files | polygons, lines, points, normals, texture coordinates, colours, smoothing groups, materials; a part for each name of an object or group and material |
/// | `gltf`, `glb` | glTF 2.0 | the default scene: nodes, cameras, triangles, lines, points, normals, tangents, the first texture coordinates and colours, materials, skins, morph targets, animations, lights; a part for each primitive of each node |
/// | `ply` | PLY | polygons, strips and edges, or points where there are none of them; normals, texture coordinates and colours of vertices; as one part |
/// | `stl` | STL | triangles, with vertices at equal positions as one, colours of triangles; a part for each solid |
/// | `off` | OFF in text, also COFF, NOFF, STOFF, 4OFF | polygons, or points where there are none; normals, texture coordinates and colours of vertices, colours of faces; as one part |
/// | `3mf` | 3MF | the build: objects, components, transforms, base materials and colour groups in units of the file; a part for each object of each item |
///
/// Polygons are cut into triangles, concave ones too. Files that a model refers to are read only from its own folder
/// and its subfolders. [`Model::warnings`] lists what was skipped. Missing normals are computed by the default
/// [weighting](crate::NormalWeighting).
///
/// Allocations are in proportion to the data in the file; no count in a header is believed.
///
/// ```
/// use glam::Mat4;
/// use halfway_mesh::{Mesh, Model, Part, Teapot, load, write};
///
/// let path = std::env::temp_dir().join(format!("teapot_{}.glb", std::process::id()));
/// let mesh = Mesh::from(Teapot::new(4));
/// let part = Part { name: "pot".into(), mesh, material: None, world_from_part: Mat4::IDENTITY };
/// write(&path, &Model { parts: vec![part], ..Model::default() })?;
///
/// let model = load(&path)?;
/// assert_eq!((model.parts[0].name.as_str(), model.triangle_count()), ("pot", 992));
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The file is missing, empty, neither a regular file nor a named pipe, or of another format; it is malformed, where the error names the line
/// or the element and what was expected there; or it holds no triangle, no line and no point.
pub fn load(path: &Path) -> Result<Model, LoadError> {
    load_with(path, LoadOptions::default(), &mut |_| ControlFlow::Continue(()))
}

/// [`load`], with options and a progress function, which is called now and then while a large file is read; if it
/// breaks, the error is [`LoadError::Stopped`].
///
/// ```
/// use std::{ops::ControlFlow, path::Path};
/// use halfway_mesh::{LoadError, LoadOptions, LoadProgress, load_with};
///
/// let mut progress = |LoadProgress { done, of }| {
///     println!("{done} of {of} bytes");
///     ControlFlow::Continue(())
/// };
/// let error = load_with(Path::new("missing.obj"), LoadOptions { outside: true, ..LoadOptions::default() }, &mut progress).unwrap_err();
/// assert!(matches!(error, LoadError::Read { .. }));
/// ```
///
/// # Errors
/// As [`load`].
pub fn load_with(
    path: &Path,
    options: LoadOptions,
    progress: &mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
) -> Result<Model, LoadError> {
    let Some(format) = options.format.or_else(|| Format::from_path(path)) else {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        return Err(LoadError::UnknownExtension { path: path.to_owned(), extension });
    };
    // Several readers report to it, one at a time.
    let progress = RefCell::new(progress);
    let on_progress = |at| (progress.borrow_mut())(at);
    parse(format, Source::open(path, options, &on_progress)?)
}

/// Reads a model from memory. It has no folder: files that it refers to are not read. Error messages call it `model`
/// with the format's extension.
///
/// ```
/// use halfway_mesh::{Format, load_bytes};
///
/// let model = load_bytes(Format::Obj, b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// assert_eq!(model.parts[0].mesh.triangle_count(), 2);
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
///
/// # Errors
/// As [`load`].
pub fn load_bytes(format: Format, bytes: &[u8]) -> Result<Model, LoadError> {
    let name = format!("model.{}", format.extension());
    let path = Path::new(&name);
    parse(format, Source::from_bytes(path, bytes)?)
}

/// Reads a model from a stream, such as standard input, to its end; it is kept in memory meanwhile. `name` is what
/// messages call it. It has no folder: files that it refers to are not read. [`LoadOptions::limit`] holds, by default
/// [`MOST_PIPED`].
///
/// ```
/// use std::path::Path;
/// use halfway_mesh::{Format, LoadOptions, load_stream};
///
/// let stream = &b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"[..];
/// let model = load_stream(Format::Obj, Path::new("standard input"), stream, LoadOptions::default())?;
/// assert_eq!(model.triangle_count(), 1);
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
///
/// # Errors
/// As [`load`], and [`LoadError::TooLarge`].
pub fn load_stream(
    format: Format,
    name: &Path,
    stream: impl std::io::Read,
    options: LoadOptions,
) -> Result<Model, LoadError> {
    parse(format, Source::from_stream(name, stream, options)?)
}

fn parse(format: Format, source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let model = match format {
        Format::Smf => smf::parse(source),
        Format::Obj => obj::parse(source),
        Format::Gltf | Format::Glb => gltf::parse(source, format),
        Format::Ply => ply::parse(source),
        Format::Stl => stl::parse(source),
        Format::Off => off::parse(source),
        #[cfg(feature = "threemf")]
        Format::ThreeMf => threemf::parse(source),
        #[cfg(not(feature = "threemf"))]
        Format::ThreeMf => Err(LoadError::Element {
            path: path.to_owned(),
            element: "3MF".to_owned(),
            found: "a build of halfway_mesh without its feature `threemf`".to_owned(),
            expected: "one with it is".to_owned(),
        }),
    }?;
    if model.is_empty() {
        let skipped = model.warnings.into_iter().next();
        return Err(LoadError::NoTriangles { path: path.to_owned(), skipped });
    }
    Ok(model)
}

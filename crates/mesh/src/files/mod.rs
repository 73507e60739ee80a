//! Model files: which there are, and how they are opened.

mod error;
mod gltf;
mod mtl;
mod obj;
mod smf;
mod text;

use std::fs;
use std::path::{Component, Path};

use crate::Model;

pub use error::LoadError;

/// Reads a model file. Its format is told by its extension, in either case:
///
/// | extension | format | what is read |
/// |---|---|---|
/// | `smf` | Garland's SMF | vertices and triangles, as one part |
/// | `obj` | Wavefront OBJ with its MTL files | polygons (cut into fans), normals, texture coordinates, materials; a part for each object or group and material |
/// | `gltf`, `glb` | glTF 2.0 | the default scene: nodes, triangles, normals, the first texture coordinates, metallic-roughness factors, `KHR_lights_punctual`; a part for each primitive of each node |
///
/// Files that a model refers to are read only from its own folder and those in it. What is skipped is said in
/// [`Model::warnings`]. Normals that are missing are those of the default weighting
/// ([`NormalWeighting::Angle`](crate::NormalWeighting::Angle)).
///
/// No memory is taken on the word of a number in the file: what is allocated is in proportion to the data that is there.
///
/// # Errors
/// The file is missing, empty, not a regular file or of another format; it is malformed, where the error names the line
/// or the element and what was expected there; or it holds no triangle.
pub fn load(path: &Path) -> Result<Model, LoadError> {
    let extension =
        path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let parse = match extension.as_str() {
        "smf" => smf::parse,
        "obj" => obj::parse,
        "gltf" | "glb" => gltf::parse,
        "ply" | "stl" => {
            return Err(LoadError::NotYet { path: path.to_owned(), extension });
        }
        _ => {
            return Err(LoadError::UnknownExtension { path: path.to_owned(), extension });
        }
    };
    let model = parse(path, &read(path)?)?;
    if model.parts.is_empty() {
        return Err(LoadError::NoTriangles { path: path.to_owned() });
    }
    Ok(model)
}

/// The bytes of a regular file that has some.
fn read(path: &Path) -> Result<Vec<u8>, LoadError> {
    let failed = |source| LoadError::Read { path: path.to_owned(), source };
    // Asked before it is opened: opening a pipe waits for its other end.
    if !fs::metadata(path).map_err(failed)?.is_file() {
        return Err(LoadError::NotAFile { path: path.to_owned() });
    }
    let bytes = fs::read(path).map_err(failed)?;
    if bytes.is_empty() {
        return Err(LoadError::Empty { path: path.to_owned() });
    }
    Ok(bytes)
}

/// Whether a path that stands in a file stays in that file's folder: relative, and without `..`.
fn stays_inside(reference: &Path) -> bool {
    let mut names = 0;
    reference.components().all(|component| {
        names += usize::from(matches!(component, Component::Normal(_)));
        matches!(component, Component::Normal(_) | Component::CurDir)
    }) && names > 0
}

/// The folder that a file lies in.
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_stay_inside() {
        for (reference, inside) in [
            ("a.bin", true),
            ("./a.bin", true),
            ("sub/a.bin", true),
            ("a..b", true),
            ("../a.bin", false),
            ("sub/../../a.bin", false),
            ("sub/../a.bin", false),
            ("/etc/passwd", false),
            ("", false),
            (".", false),
        ] {
            assert_eq!(stays_inside(Path::new(reference)), inside, "{reference:?}");
        }
    }
}

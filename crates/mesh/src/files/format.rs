//! The formats of model files.

use std::path::Path;

/// A format of model files.
///
/// ```
/// use std::path::Path;
/// use halfway_mesh::Format;
///
/// assert_eq!(Format::from_path(Path::new("scans/bunny.PLY")), Some(Format::Ply));
/// assert_eq!(Format::from_path(Path::new("bunny.txt")), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Garland's SMF.
    Smf,
    /// Wavefront OBJ with its MTL files.
    Obj,
    /// glTF 2.0 in text.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// PLY, in ASCII or binary.
    Ply,
    /// STL, in ASCII or binary.
    Stl,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Smf, Self::Obj, Self::Gltf, Self::Glb, Self::Ply, Self::Stl];

    /// The extension of its files, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Smf => "smf",
            Self::Obj => "obj",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::Ply => "ply",
            Self::Stl => "stl",
        }
    }

    /// The format that a file's extension names, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }
}

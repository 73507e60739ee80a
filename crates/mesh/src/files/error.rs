//! What can be wrong with a model file.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::MeshError;

/// Why a model file was refused. Every message begins with the file; lines are numbered from 1, as editors do, and the
/// elements of a glTF file from 0, as that format does.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file is missing or cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A directory, a device or the like.
    #[error("{}: not a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// The file has no bytes.
    #[error("{}: the file is empty", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The extension names no format that is known.
    #[error("{}: the extension {extension:?} is unknown; smf, obj, gltf, glb, ply or stl is expected", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// What follows the last dot of its name, in lower case; empty where there is none.
        extension: String,
    },
    /// Whoever was told of the progress asked for the end.
    #[error("{}: stopped", path.display())]
    Stopped {
        /// The file.
        path: PathBuf,
    },
    /// A line of a text file is not what its place asks for.
    #[error("{}:{line}: {found}; {expected} expected", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What was found.
        found: String,
        /// What was expected, with its verb.
        expected: String,
    },
    /// An element of a glTF file is not what its place asks for.
    #[error("{}: {element}: {found}; {expected} expected", path.display())]
    Element {
        /// The file.
        path: PathBuf,
        /// The element, as `accessors[3]`.
        element: String,
        /// What was found.
        found: String,
        /// What was expected, with its verb.
        expected: String,
    },
    /// A mesh of the file is not valid.
    #[error("{}: {element}: {source}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// The mesh.
        element: String,
        /// What is wrong with it.
        source: MeshError,
    },
    /// The file shows nothing.
    #[error("{}: no triangles; at least one is expected{}", path.display(), in_brackets(skipped.as_ref()))]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// The first thing that was skipped in it, if any.
        skipped: Option<String>,
    },
    /// A glTF file cannot be shown rightly without an extension of the format that is not supported.
    #[error("{}: the extension {extension} is required, which is not supported", path.display())]
    RequiredExtension {
        /// The file.
        path: PathBuf,
        /// The extension's name.
        extension: String,
    },
}

impl LoadError {
    /// The file that was refused: the one asked for, or one that it refers to.
    pub fn path(&self) -> &Path {
        match self {
            Self::Read { path, .. }
            | Self::NotAFile { path }
            | Self::Empty { path }
            | Self::UnknownExtension { path, .. }
            | Self::Stopped { path }
            | Self::Line { path, .. }
            | Self::Element { path, .. }
            | Self::Mesh { path, .. }
            | Self::NoTriangles { path, .. }
            | Self::RequiredExtension { path, .. } => path,
        }
    }
}

fn in_brackets(text: Option<&String>) -> String {
    text.map_or_else(String::new, |text| format!(" ({text})"))
}

//! Errors of model files.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::format::Format;
use crate::MeshError;

/// Why a model file was refused. Every message begins with the file; lines are numbered from 1, as editors do, and the
/// elements of a glTF file from 0, as that format does.
///
/// ```
/// use halfway_mesh::{Format, load_bytes};
///
/// let error = load_bytes(Format::Obj, b"v 0 0 0\nv 1 zero 0\n").unwrap_err();
/// assert!(error.to_string().starts_with("model.obj:2: "), "{error}");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file is missing or cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A directory, a device or the like; for a file that a model refers to, also a pipe.
    #[error("{}: not a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// The file has more bytes than [`LoadOptions::limit`](crate::LoadOptions::limit) allows, or a pipe than
    /// [`MOST_PIPED`](crate::MOST_PIPED).
    #[error("{}: the file is larger than {most} bytes, the limit", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit in bytes.
        most: u64,
    },
    /// The file has no bytes.
    #[error("{}: the file is empty", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The extension names no known format.
    #[error("{}: the extension {extension:?} is unknown; smf, obj, gltf, glb, ply, stl, off or 3mf is expected{}", path.display(), conversion(path))]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// The text after the last dot of the name, in lower case; empty where there is none.
        extension: String,
    },
    /// The caller's progress function asked to stop.
    #[error("{}: stopped", path.display())]
    Stopped {
        /// The file.
        path: PathBuf,
    },
    /// A line of a text file is malformed.
    #[error("{}:{line}: {found}; {expected} expected", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The text that was found.
        found: String,
        /// The text that was expected, with its verb.
        expected: String,
    },
    /// An element of a glTF file is invalid.
    #[error("{}: {element}: {found}; {expected} expected", path.display())]
    Element {
        /// The file.
        path: PathBuf,
        /// The element, as `accessors[3]`.
        element: String,
        /// The value that was found.
        found: String,
        /// The value that was expected, with its verb.
        expected: String,
    },
    /// A mesh of the file is not valid.
    #[error("{}: {element}: {source}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// The mesh.
        element: String,
        /// The fault of the mesh.
        source: MeshError,
    },
    /// The file has no triangles, no lines and no points.
    #[error("{}: no triangles, lines or points; at least one is expected{}", path.display(), in_brackets(skipped.as_ref()))]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// The first thing that was skipped in it, if any.
        skipped: Option<String>,
    },
    /// A glTF file cannot be shown rightly without an extension of the format that is not supported.
    #[error("{}: the extension {extension} is required, which is not supported{remedy}", path.display())]
    RequiredExtension {
        /// The file.
        path: PathBuf,
        /// The extension's name.
        extension: String,
        /// A program that writes the file without it, after a semicolon; empty where none is known.
        remedy: &'static str,
    },
}

impl LoadError {
    /// The file that was refused: the one asked for, or one that it refers to.
    pub fn path(&self) -> &Path {
        match self {
            Self::Read { path, .. }
            | Self::NotAFile { path }
            | Self::TooLarge { path, .. }
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

/// How a file of a format that is not read becomes one that is.
fn conversion(path: &Path) -> String {
    Format::converter(path).map_or_else(String::new, |program| format!("; {program}"))
}

fn in_brackets(text: Option<&String>) -> String {
    text.map_or_else(String::new, |text| format!(" ({text})"))
}

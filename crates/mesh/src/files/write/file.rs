//! Files that are written whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a model was not written. No partial file is left, and an existing file stays as it was.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The extension names no format that can be written.
    #[error("{}: the extension {extension:?} names no format that is written; smf, obj, glb, gltf, ply or stl is expected", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// The text after the last dot of the name, in lower case; empty where there is none.
        extension: String,
    },
    /// Only GLB holds quantised meshes.
    #[error("{}: only .glb holds integers of 16 bits", path.display())]
    NotQuantised {
        /// The file.
        path: PathBuf,
    },
    /// Only PLY is written in ASCII on demand.
    #[error("{}: only .ply is binary or ASCII", path.display())]
    NotAscii {
        /// The file.
        path: PathBuf,
    },
    /// The model has no parts, and no format can say so.
    #[error("{}: the model has no parts; at least one is expected", path.display())]
    NoParts {
        /// The file.
        path: PathBuf,
    },
    /// The model has more elements than the format can count.
    #[error("{}: {what}; at most {} are expected", path.display(), u32::MAX)]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The elements, and how many there are.
        what: String,
    },
    /// The vertices of a part leave the range of single precision in world space.
    #[error("{}: the vertices of part {part}, where they stand in the world, are not finite", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// The part, from 0.
        part: usize,
    },
    /// The system refuses.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

/// Writes a temporary file beside the target and renames it.
pub(super) fn replace(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let failed = |source| WriteError::Write { path: path.to_owned(), source };
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.partial", std::process::id()));
    let beside = path.with_file_name(name);
    let written = File::create(&beside).and_then(|file| {
        let mut file = BufWriter::with_capacity(1 << 16, file);
        content(&mut file)?;
        file.flush()
    });
    written.and_then(|()| fs::rename(&beside, path)).map_err(|source| {
        let _ = fs::remove_file(&beside);
        failed(source)
    })
}

//! A file that appears in its place only when it is complete.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::OutputError;

/// Writes a text to a file, complete or not at all. Missing folders are created.
///
/// # Errors
/// The error that kept the file from being written; an existing file is then unchanged.
pub fn write_text(file: &Path, text: &str) -> Result<(), OutputError> {
    write_bytes(file, text.as_bytes())
}

/// [`write_text`] of any bytes, such as a picture that was encoded by other means.
///
/// # Errors
/// As [`write_text`].
pub fn write_bytes(file: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let (partial, mut writer) = Partial::create(file)?;
    writer.write_all(bytes).and_then(|()| writer.flush()).map_err(|source| OutputError::io(file, source))?;
    // Closed before it is moved.
    drop(writer);
    partial.keep()
}

/// An incomplete file. It is removed if it is dropped before [`Partial::keep`].
#[derive(Debug)]
pub(super) struct Partial {
    /// The name that was given.
    file: PathBuf,
    /// The final path: `file`, with links followed.
    target: PathBuf,
    /// The path until then.
    waiting: PathBuf,
    kept: bool,
}

impl Partial {
    /// Opens a new file beside `file`, on the same file system so that it can be moved there atomically. Missing
    /// folders are created.
    pub(super) fn create(file: &Path) -> Result<(Self, BufWriter<File>), OutputError> {
        let io_error = |source| OutputError::io(file, source);
        if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(io_error)?;
        }
        // A link keeps its name and its target gets the content, as if it were written directly.
        let target = match fs::canonicalize(file) {
            Ok(target) => target,
            Err(error) if error.kind() == io::ErrorKind::NotFound => file.to_owned(),
            Err(error) => return Err(io_error(error)),
        };
        if target.exists() && !target.is_file() {
            return Err(OutputError::NotAFile { file: file.to_owned() });
        }
        let waiting = beside(&target).ok_or_else(|| OutputError::NotAFile { file: file.to_owned() })?;
        let handle = File::create_new(&waiting).map_err(io_error)?;
        Ok((Self { file: file.to_owned(), target, waiting, kept: false }, BufWriter::new(handle)))
    }

    /// The file's name, for errors.
    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// Moves the complete and closed file to its place.
    pub(super) fn keep(mut self) -> Result<(), OutputError> {
        fs::rename(&self.waiting, &self.target).map_err(|source| OutputError::io(&self.file, source))?;
        self.kept = true;
        Ok(())
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        if !self.kept {
            // The error that led here is already reported.
            let _ = fs::remove_file(&self.waiting);
        }
    }
}

/// A name that is unique to this process and this file.
fn beside(target: &Path) -> Option<PathBuf> {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    let mut name = std::ffi::OsString::from(".");
    name.push(target.file_name()?);
    name.push(format!(".{}-{number}.partial", std::process::id()));
    Some(target.with_file_name(name))
}

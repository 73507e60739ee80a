//! Files that appear in their place only when they are complete.

use std::fs;
use std::path::{Path, PathBuf};

use super::ReportError;

/// Writes a file, complete or not at all: under another name beside its own, to which it is then moved. Folders on the
/// way that are missing are made.
///
/// # Errors
/// [`ReportError::Io`]; what was there before is then still there.
pub fn write(file: &Path, content: &str) -> Result<(), ReportError> {
    let failed = |source| ReportError::Io { file: file.to_owned(), source };
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    let waiting = beside(file);
    let written = fs::write(&waiting, content).and_then(|()| fs::rename(&waiting, file));
    if written.is_err() {
        // The error that led here is the one to tell.
        let _ = fs::remove_file(&waiting);
    }
    written.map_err(failed)
}

/// A name of this process's own in the same folder.
fn beside(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!(".{name}.{}.partial", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_complete_or_not_there() {
        let folder = std::env::temp_dir().join(format!("halfway-chart-write-{}", std::process::id()));
        let file = folder.join("new/page.html");
        write(&file, "one").unwrap();
        write(&file, "two").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "two");
        // A folder stands where the file should be.
        let taken = folder.join("new");
        let problem = write(&taken, "three").unwrap_err().to_string();
        assert!(problem.starts_with(&taken.display().to_string()), "{problem}");
        let left: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["new"]);
        fs::remove_dir_all(&folder).unwrap();
    }
}

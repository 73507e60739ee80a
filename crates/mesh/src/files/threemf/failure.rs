//! Errors within the archive of a 3MF file, whose name is added at the end.

use std::path::Path;

use crate::files::LoadError;

/// Why a file was refused.
pub(super) enum Failure {
    Load(LoadError),
    Element { element: String, found: String, expected: String },
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Self::Load(error)
    }
}

impl Failure {
    pub(super) fn new(element: &str, found: impl Into<String>, expected: &str) -> Self {
        Self::Element { element: element.to_owned(), found: found.into(), expected: expected.to_owned() }
    }

    pub(super) fn for_file(self, path: &Path) -> LoadError {
        match self {
            Self::Load(error) => error,
            Self::Element { element, found, expected } => {
                LoadError::Element { path: path.to_owned(), element, found, expected }
            }
        }
    }
}

//! Errors of glTF files.

use std::path::Path;

use crate::MeshError;
use crate::files::LoadError;

/// An error without the name of the file, which is added later.
#[derive(Debug)]
pub(super) enum Fault {
    Element {
        element: String,
        found: String,
        expected: String,
    },
    Mesh {
        element: String,
        source: MeshError,
    },
    RequiredExtension {
        extension: String,
        /// A program that writes the file without it, after a semicolon.
        remedy: &'static str,
    },
    /// An error in a file that the document refers to, complete.
    Elsewhere(LoadError),
}

impl Fault {
    pub(super) fn element(element: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::Element { element: element.into(), found: found.into(), expected: expected.into() }
    }

    /// The message without the element: for warnings.
    pub(super) fn reason(self) -> String {
        match self {
            Self::Element { found, expected, .. } => format!("{found}; {expected} expected"),
            Self::Mesh { source, .. } => source.to_string(),
            Self::RequiredExtension { extension, .. } => extension,
            Self::Elsewhere(error) => error.to_string(),
        }
    }

    pub(super) fn at(self, path: &Path) -> LoadError {
        let path = path.to_owned();
        match self {
            Self::Element { element, found, expected } => LoadError::Element { path, element, found, expected },
            Self::Mesh { element, source } => LoadError::Mesh { path, element, source },
            Self::RequiredExtension { extension, remedy } => LoadError::RequiredExtension { path, extension, remedy },
            Self::Elsewhere(error) => error,
        }
    }
}

/// Checks that the numbers of an element are finite; the JSON reader makes infinities of numbers too large for `f32`.
pub(super) fn check_finite(element: &dyn Fn() -> String, numbers: &[f32]) -> Result<(), Fault> {
    match numbers.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(_) => Err(Fault::element(element(), format!("{numbers:?}"), "finite numbers are")),
    }
}

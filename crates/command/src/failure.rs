//! Why a command failed, and its exit code.

use std::error::Error;

/// Why a command failed, and the exit code that says so.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) code: u8,
    /// The message still to be printed.
    pub(crate) error: Option<Box<dyn Error>>,
}

/// The exit code of pictures that differ by more than allowed.
pub(crate) const DIFFERENT: u8 = 4;
/// The exit code of work that Ctrl-C or SIGTERM stopped, as in shells for the first.
pub(crate) const STOPPED: u8 = 130;

impl Failure {
    pub(crate) fn new(code: u8, error: impl Into<Box<dyn Error>>) -> Self {
        Self { code, error: Some(error.into()) }
    }

    /// A failure whose message was already printed.
    pub(crate) fn already_printed(code: u8) -> Self {
        Self { code, error: None }
    }
}

/// Bad input has exit code 2.
macro_rules! bad_input {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::new(2, error)
            }
        })*
    };
}
bad_input!(
    halfway::scene::SceneError,
    halfway::mesh::LoadError,
    halfway::mesh::WriteError,
    halfway::output::OutputError,
    halfway::reference::OracleError,
    String
);

impl From<halfway::render::RenderError> for Failure {
    fn from(error: halfway::render::RenderError) -> Self {
        use halfway::render::RenderError as E;
        let code = match error {
            E::NoAdapter
            | E::NoAdapterAmong { .. }
            | E::NoSuchAdapter { .. }
            | E::NoDevice { .. }
            | E::NoVectors { .. } => 3,
            E::Device(_) => 1,
            _ => 2,
        };
        Self::new(code, error)
    }
}

impl From<halfway::record::RecordError> for Failure {
    fn from(error: halfway::record::RecordError) -> Self {
        use halfway::record::RecordError as E;
        match error {
            E::Render(error) => error.into(),
            E::Stopped(_) => Self::new(STOPPED, error),
            other => Self::new(2, other),
        }
    }
}

//! How the work is run: without the interpreter's lock, on threads that exist, and without a panic that gets out.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, OnceLock, PoisonError};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The process that loaded the module.
static FIRST: OnceLock<u32> = OnceLock::new();

pub(crate) fn remember_process() {
    FIRST.get_or_init(std::process::id);
}

/// A reason why something cannot be done.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input cannot be used.
    Input(String),
    /// It can, and the work failed all the same.
    Work(String),
}

impl Failure {
    pub(crate) fn input(error: impl std::fmt::Display) -> Self {
        Self::Input(error.to_string())
    }

    pub(crate) fn work(error: impl std::fmt::Display) -> Self {
        Self::Work(error.to_string())
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Input(message) => PyValueError::new_err(message),
            Failure::Work(message) => PyRuntimeError::new_err(message),
        }
    }
}

/// Does the work while other threads of Python run. A panic becomes an error.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T, Failure> + Send) -> PyResult<T> {
    let done = py.detach(|| {
        let work = || catch_unwind(AssertUnwindSafe(work));
        if FIRST.get() == Some(&std::process::id()) { work() } else { on_own_threads(work) }
    });
    match done {
        Ok(done) => Ok(done?),
        Err(panic) => {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
            Err(PyRuntimeError::new_err(format!("halfway failed, which is a mistake in halfway itself: {said}")))
        }
    }
}

/// Does the work on threads of this process. A process that was forked has none of its parent's, which would be waited
/// for without end.
fn on_own_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static POOL: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);
    let process = std::process::id();
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let threads = match *pool {
        Some((of, threads)) if of == process => Some(threads),
        // The pool of a parent is left alone: to end it would be to wait for its threads.
        _ => ThreadPoolBuilder::new().build().ok().map(|threads| &*Box::leak(Box::new(threads))),
    };
    *pool = threads.map(|threads| (process, threads));
    drop(pool);
    match threads {
        Some(threads) => threads.install(work),
        None => work(),
    }
}

//! Reports each problem once, in the log or on standard error.

use std::collections::HashSet;
use std::fmt::Display;

/// The most different messages that are reported: an error whose text changes from frame to frame must not fill the
/// log, or the memory.
const MOST: usize = 100;

/// The messages reported so far.
#[derive(Default)]
pub(crate) struct Reported(HashSet<String>);

impl Reported {
    /// Those of `errors` that were not reported yet, in order.
    fn new_ones(&mut self, errors: impl IntoIterator<Item = impl Display>) -> Vec<String> {
        let mut new = Vec::new();
        for error in errors {
            let message = error.to_string();
            if self.0.len() < MOST && self.0.insert(message.clone()) {
                new.push(message);
                if self.0.len() == MOST {
                    new.push(format!("{MOST} different errors; further ones are not shown"));
                }
            }
        }
        new
    }

    /// Reports those of `errors` that were not reported yet.
    pub(crate) fn report_new(&mut self, errors: impl IntoIterator<Item = impl Display>) {
        for message in self.new_ones(errors) {
            report(message);
        }
    }
}

/// Logs an error; writes it to standard error if the App has no logger that shows errors.
pub(crate) fn report(message: impl Display) {
    if log::log_enabled!(log::Level::Error) {
        log::error!("{message}");
    } else {
        eprintln!("error: {message}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_said_once() {
        let mut reported = Reported::default();
        assert_eq!(reported.new_ones(["a", "b", "a"]), ["a", "b"]);
        assert_eq!(reported.new_ones(["b", "c"]), ["c"]);
        assert!(reported.new_ones(["a", "b", "c"]).is_empty());
    }

    #[test]
    fn endless_different_errors_end() {
        let mut reported = Reported::default();
        // All of them, and the line that announces the limit.
        assert_eq!(reported.new_ones(0..10 * MOST).len(), MOST + 1);
        assert!(reported.new_ones([-1]).is_empty());
    }
}

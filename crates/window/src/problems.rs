//! Problems are reported once, where people see them.

use std::collections::HashSet;
use std::fmt::Display;

/// How many different messages are said before the rest is silence: an error whose text changes
/// from frame to frame must not fill the log, or the memory.
const MOST: usize = 100;

/// Messages that have been said.
#[derive(Default)]
pub(crate) struct Said(HashSet<String>);

impl Said {
    /// Those of `errors` that have not been said yet, in order.
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

    /// Says those of `errors` that have not been said yet.
    pub(crate) fn say_new(&mut self, errors: impl IntoIterator<Item = impl Display>) {
        for message in self.new_ones(errors) {
            say(message);
        }
    }
}

/// Logs an error; writes it to the standard error output where the App has no logger that shows errors.
pub(crate) fn say(message: impl Display) {
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
        let mut said = Said::default();
        assert_eq!(said.new_ones(["a", "b", "a"]), ["a", "b"]);
        assert_eq!(said.new_ones(["b", "c"]), ["c"]);
        assert!(said.new_ones(["a", "b", "c"]).is_empty());
    }

    #[test]
    fn endless_different_errors_end() {
        let mut said = Said::default();
        // All of them, and the line that says so.
        assert_eq!(said.new_ones(0..10 * MOST).len(), MOST + 1);
        assert!(said.new_ones([-1]).is_empty());
    }
}

//! What is measured already, kept in a file so that a run that was interrupted goes on where it stopped.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Results by their keys; in memory, and in a file if there is one.
#[derive(Debug, Default)]
pub struct KeptResults {
    found: HashMap<String, Value>,
    file: Option<File>,
}

impl KeptResults {
    /// What the file holds, if it was written for the same `run`: the program and the machine, in words. A file of
    /// another run is begun anew. What follows a line that was not finished is measured again.
    ///
    /// # Errors
    /// The file can be neither read nor made; in words.
    pub fn open(path: &Path, run: &str) -> Result<Self, String> {
        let told = |error: std::io::Error| format!("{}: {error}", path.display());
        let text = fs::read_to_string(path).unwrap_or_default();
        let mut lines = text.split_inclusive('\n').map_while(|line| serde_json::from_str::<(String, Value)>(line).ok());
        let head = (RUN.to_owned(), Value::from(run));
        let mut found = HashMap::new();
        if lines.next().is_some_and(|first| first == head) {
            found.extend(lines);
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(told)?;
        }
        let file = OpenOptions::new().create(true).write(true).truncate(true).open(path).map_err(told)?;
        let mut kept = Self { found: HashMap::new(), file: Some(file) };
        kept.keep(RUN, &run)?;
        found.into_iter().try_for_each(|(key, value)| kept.keep(&key, &value))?;
        Ok(kept)
    }

    /// What is kept by this key, if that is a `T`.
    pub fn find<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        serde_json::from_value(self.found.get(key)?.clone()).ok()
    }

    /// Keeps it.
    ///
    /// # Errors
    /// It cannot be written; in words.
    pub fn keep<T: Serialize>(&mut self, key: &str, value: &T) -> Result<(), String> {
        let value = serde_json::to_value(value).map_err(|error| error.to_string())?;
        if let Some(file) = &mut self.file {
            let line = Value::from(vec![Value::from(key), value.clone()]);
            writeln!(file, "{line}").map_err(|error| error.to_string())?;
        }
        self.found.insert(key.to_owned(), value);
        Ok(())
    }
}

/// The key of the first line.
const RUN: &str = "run";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_kept_is_found_again_up_to_a_half_written_line() {
        let folder = std::env::temp_dir().join(format!("halfway-kept-{}", std::process::id()));
        let file = folder.join("deep").join("kept.jsonl");
        let mut kept = KeptResults::open(&file, "this run").unwrap();
        kept.keep("a", &1.25).unwrap();
        kept.keep("b", &vec!["x"]).unwrap();
        drop(kept);
        let text = fs::read_to_string(&file).unwrap();
        fs::write(&file, text + "[\"c\", [1, 2").unwrap();
        let kept = KeptResults::open(&file, "this run").unwrap();
        assert_eq!(kept.find::<f64>("a"), Some(1.25));
        assert_eq!(kept.find::<Vec<String>>("b"), Some(vec!["x".to_owned()]));
        assert_eq!((kept.find::<f64>("b"), kept.find::<f64>("c")), (None, None));
        drop(kept);
        // Another machine's figures are not this one's.
        assert_eq!(KeptResults::open(&file, "another run").unwrap().find::<f64>("a"), None);
        assert_eq!(KeptResults::open(&file, "this run").unwrap().find::<f64>("a"), None, "and they are gone");
        fs::remove_dir_all(folder).unwrap();
    }
}

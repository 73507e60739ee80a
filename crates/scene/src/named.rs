//! The names of cameras, lights and objects, and how entries refer to one another.

use std::collections::HashMap;
use std::fmt;

use serde::de::{Deserializer, Error, Visitor};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits};
use crate::entry::Entry;

/// One of a list, by its name or by its number, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NameOrIndex {
    /// The one of this name.
    Name(String),
    /// The one at this place in its list, counted from 0.
    Index(u32),
}

impl From<&str> for NameOrIndex {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl From<String> for NameOrIndex {
    fn from(name: String) -> Self {
        Self::Name(name)
    }
}

impl NameOrIndex {
    /// Its place in a list of names.
    pub(crate) fn find<'a>(&self, names: impl IntoIterator<Item = Option<&'a str>>) -> Option<usize> {
        let mut names = names.into_iter().enumerate();
        match self {
            Self::Name(wanted) => names.find(|(_, name)| *name == Some(wanted)),
            Self::Index(wanted) => names.find(|(index, _)| *index == *wanted as usize),
        }
        .map(|(index, _)| index)
    }

    /// The same, where a name that is none of them may be a number as text, such as that of an option.
    pub(crate) fn find_by_text<'a>(&self, names: impl Iterator<Item = Option<&'a str>> + Clone) -> Option<usize> {
        let by_number = || match self {
            Self::Name(text) => Self::Index(text.parse().ok()?).find(names.clone()),
            Self::Index(_) => None,
        };
        self.find(names.clone()).or_else(by_number)
    }
}

/// As messages have it.
impl fmt::Display for NameOrIndex {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Name(name) => write!(f, "{name:?}"),
            Self::Index(index) => write!(f, "{index}"),
        }
    }
}

impl Default for NameOrIndex {
    fn default() -> Self {
        Self::Index(0)
    }
}

impl Entry for NameOrIndex {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl Visitor<'_> for Either {
            type Value = NameOrIndex;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a name, or a number counted from 0")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<NameOrIndex, E> {
                Ok(NameOrIndex::from(name))
            }

            fn visit_u64<E: Error>(self, index: u64) -> Result<NameOrIndex, E> {
                // No list has so many; the check names the number.
                Ok(NameOrIndex::Index(u32::try_from(index).unwrap_or(u32::MAX)))
            }
        }

        deserializer.deserialize_any(Either)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Name(name) => serializer.serialize_str(name),
            Self::Index(index) => serializer.serialize_u32(*index),
        }
    }

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        json!({ "type": ["string", "integer"], "minimum": 0 })
    }
}

/// Checks that no two entries have the same name; each comes with its path.
pub(crate) fn check_names<'a>(named: impl IntoIterator<Item = (String, Option<&'a str>)>) -> Check {
    let mut first: HashMap<&str, String> = HashMap::new();
    for (path, name) in named {
        let Some(name) = name else { continue };
        if let Some(other) = first.get(name) {
            let message = format!("is {name:?}, as of `{other}`; expected a name of its own");
            return Err(KeyProblem::new(format!("{path}.name"), message));
        }
        first.insert(name, path);
    }
    Ok(())
}

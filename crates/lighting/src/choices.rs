//! The names of values of which a user picks one.

/// A value that has a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice<T> {
    /// The value.
    pub value: T,
    /// Its name in scene files, in lower case with underscores. On the command line, hyphens stand for underscores.
    pub key: &'static str,
    /// Its name for readers, as it stands in a sentence.
    pub name: &'static str,
    /// Its meaning, a sentence.
    pub meaning: &'static str,
}

/// A type whose named values are listed once, for scene files and their schema, options, keys and titles.
///
/// ```
/// use halfway_lighting::{Choices, Shading};
///
/// let keys: Vec<&str> = Shading::CHOICES.iter().map(|choice| choice.key).collect();
/// assert_eq!(keys, ["flat", "gouraud", "phong", "unlit"]);
/// assert_eq!(Shading::from_key("gouraud"), Some(Shading::Gouraud));
/// assert_eq!(Shading::Gouraud.choice().map(|choice| choice.name), Some("Gouraud"));
/// ```
pub trait Choices: Copy + PartialEq + 'static {
    /// The values that have names, in the order in which they are offered.
    const CHOICES: &'static [Choice<Self>];

    /// The value of this key.
    fn from_key(key: &str) -> Option<Self> {
        Self::CHOICES.iter().find(|choice| choice.key == key).map(|choice| choice.value)
    }

    /// The name of this value, if it has one.
    fn choice(&self) -> Option<&'static Choice<Self>> {
        Self::CHOICES.iter().find(|choice| choice.value == *self)
    }
}

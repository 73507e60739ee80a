//! Values with names as values of options.

use clap::builder::PossibleValue;
use halfway::lighting::Choices;

/// The choices of a type as values of an option, with their meanings as help.
pub(crate) fn values<T: Choices>() -> impl Iterator<Item = PossibleValue> {
    T::CHOICES.iter().map(|choice| {
        let meaning = choice.meaning.trim_end_matches('.');
        PossibleValue::new(choice.key.replace('_', "-")).help(meaning)
    })
}

/// The value of this name.
pub(crate) fn choice<T: Choices>(text: &str) -> Option<T> {
    T::from_key(&text.replace('-', "_"))
}

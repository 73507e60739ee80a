//! Values with names as values of options.

use clap::builder::PossibleValue;
use halfway::lighting::Choices;
pub(crate) use halfway::scene::options::parse::choice;

/// The choices of a type as values of an option, with their meanings as help.
pub(crate) fn values<T: Choices>() -> impl Iterator<Item = PossibleValue> {
    T::CHOICES.iter().map(|choice| {
        let meaning = choice.meaning.trim_end_matches('.');
        PossibleValue::new(choice.key.replace('_', "-")).help(meaning)
    })
}

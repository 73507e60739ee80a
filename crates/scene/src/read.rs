//! Reading words, objects and lists, with errors that keep their place and say what was expected.
//!
//! The derived readers do most of the work, but take more than the format has, such as `[…]` for the keys of an object
//! in some order and `{"flat": null}` for a word; they say "expected value" where a word is a number; and told to try
//! one shape after the other they take values into a buffer, which loses their lines. The functions here go in front of
//! them, by `deserialize_with`.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Deserialize, Deserializer, Error, IntoDeserializer, MapAccess, Unexpected, Visitor};

/// A value that JSON has as an object.
pub(crate) trait JsonObject {
    /// Such an object in words; follows "expected".
    const EXPECTED: &'static str;
}

/// A value that JSON has as one of a few words; one of its kinds may be an object with one key instead.
pub(crate) trait Word: Sized {
    /// The words, and the object; follows "expected".
    const EXPECTED: &'static str;
    /// The key of the object.
    const KEY: Option<&'static str> = None;

    /// The value with the object's key, whose own value `map` has next.
    fn from_member<'de, A: MapAccess<'de>>(_map: &mut A) -> Result<Self, A::Error> {
        Err(A::Error::custom(format_args!("expected {}", Self::EXPECTED)))
    }
}

/// Reads an object and nothing else.
pub(crate) fn object<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + JsonObject,
{
    Given::deserialize(deserializer).map(|Given(object)| object)
}

/// Reads an object or `null`.
pub(crate) fn object_or_null<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + JsonObject,
{
    Ok(Option::deserialize(deserializer)?.map(|Given(object)| object))
}

/// Reads a list of objects.
pub(crate) fn objects<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + JsonObject,
{
    let objects: Vec<Given<T>> = Vec::deserialize(deserializer)?;
    Ok(objects.into_iter().map(|Given(object)| object).collect())
}

/// Reads a list of objects or `null`.
pub(crate) fn objects_or_null<'de, D, T>(deserializer: D) -> Result<Option<Vec<T>>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + JsonObject,
{
    let objects: Option<Vec<Given<T>>> = Option::deserialize(deserializer)?;
    Ok(objects.map(|objects| objects.into_iter().map(|Given(object)| object).collect()))
}

/// Reads a word, or its object.
pub(crate) fn word<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + Word,
{
    deserializer.deserialize_any(WordVisitor(PhantomData))
}

/// Reads a word, or its object, or `null`.
pub(crate) fn word_or_null<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + Word,
{
    struct Spoken<T>(T);

    impl<'de, T: Deserialize<'de> + Word> Deserialize<'de> for Spoken<T> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            word(deserializer).map(Self)
        }
    }

    Ok(Option::deserialize(deserializer)?.map(|Spoken(word)| word))
}

/// Reads an optional word whose `null` is not the same as leaving it out.
pub(crate) fn given_word<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + Word,
{
    word(deserializer).map(Some)
}

/// Reads an optional value whose `null` is not the same as leaving it out.
pub(crate) fn given<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    T::deserialize(deserializer).map(Some)
}

/// Refuses a second key.
pub(crate) fn no_more<'de, A: MapAccess<'de>>(map: &mut A, expected: &str) -> Result<(), A::Error> {
    match map.next_key::<String>()? {
        None => Ok(()),
        Some(key) => Err(A::Error::custom(format_args!("unknown field `{key}`, expected one key only: {expected}"))),
    }
}

/// A value that was given as an object.
pub(crate) struct Given<T>(pub(crate) T);

impl<'de, T: Deserialize<'de> + JsonObject> Deserialize<'de> for Given<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData)).map(Self)
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + JsonObject> Visitor<'de> for ObjectVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    // What `T` finds wrong with the object as a whole is reported at the end of the object only if it is found in here.
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map))
    }
}

struct WordVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + Word> Visitor<'de> for WordVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<T, E> {
        let deserializer: StrDeserializer<E> = word.into_deserializer();
        T::deserialize(deserializer)
            .map_err(|_| E::custom(format_args!("unknown variant `{word}`, expected {}", T::EXPECTED)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<T, A::Error> {
        let Some(expected) = T::KEY else { return Err(A::Error::invalid_type(Unexpected::Map, &self)) };
        match map.next_key::<String>()? {
            Some(key) if key == expected => {
                let value = T::from_member(&mut map)?;
                no_more(&mut map, T::EXPECTED)?;
                Ok(value)
            }
            Some(key) => Err(A::Error::custom(format_args!("unknown field `{key}`, expected {}", T::EXPECTED))),
            None => Err(A::Error::custom(format_args!("is empty; expected {}", T::EXPECTED))),
        }
    }
}

//! Words, objects and lists of a scene file: read with errors that keep their place and say what was expected.
//!
//! The derived readers do most of the work, but take more than the format has, such as `[…]` for the keys of an object
//! in some order and `{"flat": null}` for a word; they say "expected value" where a word is a number; and told to try
//! one shape after the other they take values into a buffer, which loses their lines. The functions here go in front of
//! them, by `deserialize_with`.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::ser::{Serialize, Serializer};

/// A value that JSON has as an object.
pub(crate) trait JsonObject {
    /// Such an object in words; follows "expected".
    const EXPECTED: &'static str;
}

/// A value that JSON has as one of a few words; some of its kinds may be an object with one key instead.
pub(crate) trait Word: Clone + PartialEq + fmt::Debug + 'static {
    /// The words and their values.
    const WORDS: &'static [(&'static str, Self)];
    /// The key of each object, and an example of the object.
    const OBJECTS: &'static [(&'static str, &'static str)] = &[];

    /// The words and the objects in a sentence; follows "expected".
    fn expected() -> String {
        let mut ways: Vec<String> = Self::WORDS.iter().map(|(word, _)| format!("{word:?}")).collect();
        ways.extend(Self::OBJECTS.iter().map(|(_, example)| (*example).to_owned()));
        let last = ways.pop().unwrap_or_default();
        if ways.is_empty() { last } else { format!("{} or {last}", ways.join(", ")) }
    }

    /// The value with the object's `key`, one of those in the table, whose own value `map` has next.
    fn from_member<'de, A: MapAccess<'de>>(_key: &str, _map: &mut A) -> Result<Self, A::Error> {
        Err(A::Error::custom(format_args!("expected {}", Self::expected())))
    }
}

/// A component that a scene file says in words, with what the schema says of it.
pub(crate) trait ComponentWord: Word {
    /// The name of its definition.
    const NAME: &'static str;
    /// What is chosen.
    const MEANING: &'static str;
    /// What each word means, in their order.
    const MEANINGS: &'static [&'static str];
}

/// A [`Word`] as it is read, written and described.
pub(crate) struct Spoken<T>(pub(crate) T);

impl<'de, T: Word> Deserialize<'de> for Spoken<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WordVisitor(PhantomData)).map(Self)
    }
}

impl<T: Word> Serialize for Spoken<&T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match T::WORDS.iter().find(|(_, value)| value == self.0) {
            Some((word, _)) => serializer.serialize_str(word),
            None => Err(serde::ser::Error::custom(format_args!("a scene file has no word for {:?}", self.0))),
        }
    }
}

impl<T: ComponentWord> JsonSchema for Spoken<T> {
    fn schema_name() -> Cow<'static, str> {
        T::NAME.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let word = |((word, _), meaning): (&(&str, T), &&str)| json_schema!({ "type": "string", "const": word, "description": meaning });
        let words: Vec<Schema> = T::WORDS.iter().zip(T::MEANINGS).map(word).collect();
        json_schema!({ "description": T::MEANING, "oneOf": words })
    }
}

/// Writes a word.
pub(crate) fn write_word<T: Word, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    Spoken(value).serialize(serializer)
}

/// Writes a word or `null`.
#[allow(clippy::ref_option, reason = "serde asks for this signature")]
pub(crate) fn write_word_or_null<T: Word, S: Serializer>(value: &Option<T>, serializer: S) -> Result<S::Ok, S::Error> {
    value.as_ref().map(Spoken).serialize(serializer)
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
pub(crate) fn word<'de, D: Deserializer<'de>, T: Word>(deserializer: D) -> Result<T, D::Error> {
    Spoken::deserialize(deserializer).map(|Spoken(word)| word)
}

/// Reads a word, or its object, or `null`.
pub(crate) fn word_or_null<'de, D: Deserializer<'de>, T: Word>(deserializer: D) -> Result<Option<T>, D::Error> {
    Ok(Option::deserialize(deserializer)?.map(|Spoken(word)| word))
}

/// Reads an optional word whose `null` is not the same as leaving it out.
pub(crate) fn given_word<'de, D: Deserializer<'de>, T: Word>(deserializer: D) -> Result<Option<T>, D::Error> {
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

impl<'de, T: Word> Visitor<'de> for WordVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&T::expected())
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<T, E> {
        match T::WORDS.iter().find(|(known, _)| *known == word) {
            Some((_, value)) => Ok(value.clone()),
            None => Err(E::custom(format_args!("unknown variant `{word}`, expected {}", T::expected()))),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<T, A::Error> {
        if T::OBJECTS.is_empty() {
            return Err(A::Error::invalid_type(Unexpected::Map, &self));
        }
        match map.next_key::<String>()? {
            Some(key) if T::OBJECTS.iter().any(|(expected, _)| key == *expected) => {
                let value = T::from_member(&key, &mut map)?;
                no_more(&mut map, &T::expected())?;
                Ok(value)
            }
            Some(key) => Err(A::Error::custom(format_args!("unknown field `{key}`, expected {}", T::expected()))),
            None => Err(A::Error::custom(format_args!("is empty; expected {}", T::expected()))),
        }
    }
}

//! Objects and words of scene files: one table a type, from which it is read, written, described and checked.

use std::convert::Infallible;
use std::fmt;
use std::marker::PhantomData;

use halfway_lighting::{Choice, Choices};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within};
use crate::entry::{Entry, Read, Written, reference};

/// Words of scene files, each with its value and its description.
pub(crate) type Words<T> = &'static [(&'static str, T, &'static str)];

/// How a type appears in a scene file: as an object with keys, as a word, or as either.
///
/// The macros [`keys!`] and [`words!`] generate this from tables.
pub(crate) trait Keys: Clone + PartialEq + 'static {
    /// The name of the definition in the schema.
    const NAME: &'static str;
    /// Its description in the schema.
    const MEANING: &'static str;
    /// The words.
    const WORDS: Words<Self> = &[];
    /// The value of a word.
    fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, ..)| *known == word).map(|(_, value, _)| value.clone())
    }
    /// The word of this value.
    fn word(&self) -> Option<&str> {
        Self::WORDS.iter().find(|(_, value, _)| value == self).map(|(word, ..)| *word)
    }
    /// The value of an object without keys. The values of required keys are placeholders.
    fn blank() -> Self;
    /// Passes every key and its value to a visitor; words have none.
    fn visit<V: Visit>(&self, _visitor: &mut V) -> Result<(), V::Error> {
        Ok(())
    }
    /// Lets `from` set the value of any key.
    fn fill<F: Fill>(&mut self, _from: &mut F) -> Result<(), F::Error> {
        Ok(())
    }
}

/// A type of entry that consists of these keys and words.
pub(crate) trait Object: Keys {
    /// Whether an object has exactly one of the keys.
    const ONE_KEY: bool = false;
    /// The words of messages for what is expected in its place; if empty, the words and [`EXAMPLES`](Self::EXAMPLES).
    const EXPECTED: &'static str = "";
    /// Examples of the objects of a type that also has words.
    const EXAMPLES: &'static [&'static str] = &[];

    /// The words of messages for what is expected in its place.
    fn expected() -> String {
        if !Self::EXPECTED.is_empty() {
            return Self::EXPECTED.to_owned();
        }
        let words = Self::WORDS.iter().map(|(word, ..)| format!("{word:?}"));
        let mut ways: Vec<String> = words.chain(Self::EXAMPLES.iter().map(|example| (*example).to_owned())).collect();
        let last = ways.pop().unwrap_or_default();
        if ways.is_empty() { last } else { format!("{} or {last}", ways.join(", ")) }
    }

    /// Completes the value after `given` keys have been read. An error message begins with a key in backticks.
    fn with_given(self, _given: &[&str]) -> Result<Self, String> {
        Ok(self)
    }

    /// The JSON schema.
    fn definition(definitions: &mut Map<String, Value>) -> Value {
        words_or_keys::<Self>(definitions)
    }

    /// Checks rules that involve several keys.
    fn check_whole(&self) -> Check {
        Ok(())
    }
}

/// A key of an object.
#[derive(Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) presence: Presence,
    pub(crate) limits: Limits,
    /// Its description in the schema.
    pub(crate) meaning: &'static str,
    /// Introduces the limits in the description, such as "Each channel", unless `meaning` has them already.
    pub(crate) whose: Option<&'static str>,
}

impl Key {
    /// A required key with any value, such as the only key of an object.
    pub(crate) const fn required(name: &'static str, meaning: &'static str) -> Self {
        Self { name, presence: Presence::Required, limits: Limits::Any, meaning, whose: None }
    }
}

/// Whether a key has to be there.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Presence {
    /// It is required.
    Required,
    /// It has a default.
    Optional,
    /// It has neither a default nor `null`: leaving it out is a choice of its own.
    LeftOut,
    /// It is read, but no longer documented.
    Retired,
}

/// Visits keys and their values, to write, check or describe them.
pub(crate) trait Visit {
    type Error;
    /// `value` is `None` for a key that is left out.
    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), Self::Error>;
}

/// Supplies values for keys, when a file is read.
pub(crate) trait Fill {
    type Error;
    fn key<T: Entry>(&mut self, key: &Key, put: impl FnOnce(T)) -> Result<(), Self::Error>;
}

impl<T: Object> Entry for T {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ObjectVisitor(PhantomData))
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let Some(word) = self.word() {
            return serializer.serialize_str(word);
        }
        let mut map = serializer.serialize_map(None)?;
        let mut write = Write { map: &mut map, count: 0 };
        self.visit(&mut write)?;
        if write.count == 0 && !T::WORDS.is_empty() {
            return Err(serde::ser::Error::custom(format_args!("a scene file has no word for this {}", T::NAME)));
        }
        map.end()
    }

    fn schema(definitions: &mut Map<String, Value>, _: &Limits) -> Value {
        reference(definitions, T::NAME, T::definition)
    }

    fn check(&self, _: &Limits) -> Check {
        self.visit(&mut CheckKeys)?;
        self.check_whole()
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Object> Visitor<'de> for ObjectVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&T::expected())
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<T, E> {
        match T::from_word(word) {
            Some(value) => Ok(value),
            None if T::WORDS.is_empty() => Err(E::invalid_type(Unexpected::Str(word), &self)),
            None => Err(E::custom(format_args!("unknown value `{word}`, expected {}", T::expected()))),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<T, A::Error> {
        let mut value = T::blank();
        let keys = key_list::<T>();
        if keys.is_empty() {
            Err(A::Error::invalid_type(Unexpected::Map, &self))
        } else if T::ONE_KEY {
            read_one_key(&mut value, &keys, &mut map).map(|()| value)
        } else {
            let given = read_keys(&mut value, &keys, &mut map)?;
            value.with_given(&given).map_err(A::Error::custom)
        }
    }
}

/// All keys of a type.
fn key_list<T: Keys>() -> Vec<Key> {
    struct List(Vec<Key>);

    impl Fill for List {
        type Error = Infallible;

        fn key<T: Entry>(&mut self, key: &Key, _put: impl FnOnce(T)) -> Result<(), Infallible> {
            self.0.push(*key);
            Ok(())
        }
    }

    let mut list = List(Vec::new());
    let Ok(()) = T::blank().fill(&mut list);
    list.0
}

/// Reads the keys of an object and returns their names. A required key that is missing is an error.
fn read_keys<'de, T: Keys, A: MapAccess<'de>>(
    value: &mut T,
    keys: &[Key],
    map: &mut A,
) -> Result<Vec<&'static str>, A::Error> {
    let mut given = Vec::new();
    // An error has the key in its path only if it is raised while the key is read.
    while let Some(key) = map.next_key_seed(KeySeed(|name: &str| {
        let Some(key) = keys.iter().find(|key| key.name == name) else {
            let known: Vec<String> = keys.iter().map(|key| format!("`{}`", key.name)).collect();
            let expected = if known.len() < 3 { known.join(" or ") } else { format!("one of {}", known.join(", ")) };
            return Err(format!("unknown key `{name}`, expected {expected}"));
        };
        if given.contains(&key.name) {
            return Err(format!("key given twice: `{name}`"));
        }
        given.push(key.name);
        Ok(key.name)
    }))? {
        value.fill(&mut ReadValue { key, map, text: PhantomData })?;
    }
    match keys.iter().find(|key| key.presence == Presence::Required && !given.contains(&key.name)) {
        Some(Key { name, .. }) => Err(A::Error::custom(format_args!("missing key `{name}`"))),
        None => Ok(given),
    }
}

/// Reads an object with exactly one of the keys.
fn read_one_key<'de, T: Object, A: MapAccess<'de>>(value: &mut T, keys: &[Key], map: &mut A) -> Result<(), A::Error> {
    let known = |name: &str| {
        let unknown = || format!("unknown key `{name}`, expected {}", T::expected());
        keys.iter().find(|key| key.name == name).map(|key| key.name).ok_or_else(unknown)
    };
    let Some(key) = map.next_key_seed(KeySeed(known))? else {
        return Err(A::Error::custom(format_args!("is empty; expected {}", T::expected())));
    };
    value.fill(&mut ReadValue { key, map, text: PhantomData })?;
    let more = |name: &str| Err(format!("unknown key `{name}`, expected one key only: {}", T::expected()));
    map.next_key_seed(KeySeed(more)).map(|_: Option<()>| ())
}

/// Reads a key and maps it, or refuses it with a message.
struct KeySeed<F>(F);

impl<'de, T, F: FnOnce(&str) -> Result<T, String>> DeserializeSeed<'de> for KeySeed<F> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl<T, F: FnOnce(&str) -> Result<T, String>> Visitor<'_> for KeySeed<F> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<T, E> {
        (self.0)(name).map_err(E::custom)
    }
}

/// Reads the value of the key that was read last.
struct ReadValue<'a, 'de, A> {
    key: &'static str,
    map: &'a mut A,
    text: PhantomData<&'de str>,
}

impl<'de, A: MapAccess<'de>> Fill for ReadValue<'_, 'de, A> {
    type Error = A::Error;

    fn key<T: Entry>(&mut self, key: &Key, put: impl FnOnce(T)) -> Result<(), A::Error> {
        if key.name == self.key {
            let Read(value) = self.map.next_value()?;
            put(value);
        }
        Ok(())
    }
}

/// Writes keys and values.
struct Write<'a, M> {
    map: &'a mut M,
    count: usize,
}

impl<M: SerializeMap> Visit for Write<'_, M> {
    type Error = M::Error;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), M::Error> {
        let Some(value) = value else { return Ok(()) };
        self.count += 1;
        self.map.serialize_entry(key.name, &Written(value))
    }
}

/// Checks that values are within their limits.
pub(crate) struct CheckKeys;

impl Visit for CheckKeys {
    type Error = KeyProblem;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Check {
        value.map_or(Ok(()), |value| value.check(&key.limits)).within(key.name)
    }
}

/// Collects the schemas of keys, with the visited values as defaults, and the names of those that are required.
struct Properties<'a> {
    definitions: &'a mut Map<String, Value>,
    found: Map<String, Value>,
    required: Vec<&'static str>,
}

impl Visit for Properties<'_> {
    type Error = Infallible;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), Infallible> {
        let mut property = T::schema(self.definitions, &key.limits);
        let mut meaning = key.meaning.trim().to_owned();
        if let (Some(whose), Limits::Numbers(range)) = (key.whose, key.limits) {
            let or_null = if property["type"].is_array() { ", or null" } else { "" };
            meaning = format!("{meaning} {whose}: {}{or_null}.", range.expected);
        }
        property["description"] = meaning.into();
        match key.presence {
            Presence::Required => self.required.push(key.name),
            Presence::Optional => property["default"] = json!(value.map(Written)),
            Presence::LeftOut | Presence::Retired => {}
        }
        self.found.insert(key.name.to_owned(), property);
        Ok(())
    }
}

/// Collects the schemas of objects with one key each.
struct Alternatives<'a> {
    definitions: &'a mut Map<String, Value>,
    ways: Vec<Value>,
}

impl Fill for Alternatives<'_> {
    type Error = Infallible;

    fn key<T: Entry>(&mut self, key: &Key, _put: impl FnOnce(T)) -> Result<(), Infallible> {
        if key.presence != Presence::Retired {
            let value = T::schema(self.definitions, &key.limits);
            let properties = [(key.name.to_owned(), value)].into_iter().collect();
            self.ways.push(closed_object(properties, &[key.name], key.meaning));
        }
        Ok(())
    }
}

/// The schema of all words and objects of a type, or of its keys.
fn words_or_keys<T: Object>(definitions: &mut Map<String, Value>) -> Value {
    if T::WORDS.is_empty() && !T::ONE_KEY {
        return keys_schema(&T::blank(), T::MEANING, definitions);
    }
    let word = |(word, _, meaning): &(&str, T, &str)| json!({ "type": "string", "const": word, "description": meaning.trim() });
    let mut alternatives = Alternatives { definitions, ways: T::WORDS.iter().map(word).collect() };
    let Ok(()) = T::blank().fill(&mut alternatives);
    json!({ "description": T::MEANING.trim(), "oneOf": alternatives.ways })
}

/// The schema of an object with all keys that this one has, and with its values as defaults.
pub(crate) fn keys_schema<T: Keys>(default: &T, meaning: &str, definitions: &mut Map<String, Value>) -> Value {
    let mut seen = Properties { definitions, found: Map::new(), required: Vec::new() };
    let Ok(()) = default.visit(&mut seen);
    closed_object(seen.found, &seen.required, meaning)
}

/// The schema of an object with these properties and no others.
fn closed_object(properties: Map<String, Value>, required: &[&str], meaning: &str) -> Value {
    let mut schema = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    schema["description"] = meaning.trim().into();
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

/// Generates a struct and its [`Keys`] from a table of keys, or, with `impl`, the keys of a struct of another crate.
///
/// A key has a type, a default and [`Limits`]; its documentation is also its description in the schema. Keys are grouped
/// by [`Presence`], in this order; those under `[left out]` are `Option`s in the struct. A field that is not in the file
/// comes last.
///
/// A struct without required keys implements `Default`; any other has a function `new` that takes the required values.
macro_rules! keys {
    (
        $(#[doc = $about:literal])*
        #[derive($($derive:ident),*)]
        $vis:vis struct $entry:ident {
            $([required] $($(#[doc = $rdoc:literal])* $rkey:ident: $rtype:ty $(=> $rlimits:expr)?,)*)?
            $([optional] $($(#[doc = $doc:literal])* $key:ident: $type:ty = $default:expr $(=> $limits:expr)?,)*)?
            $([left out] $($(#[doc = $odoc:literal])* $okey:ident: $otype:ty $(=> $olimits:expr)?,)*)?
            $([not in the file] $(#[doc = $ndoc:literal])* $nkey:ident: $ntype:ty,)?
        }
    ) => {
        $(#[doc = $about])*
        #[derive($($derive),*)]
        $vis struct $entry {
            $($($(#[doc = $rdoc])* $vis $rkey: $rtype,)*)?
            $($($(#[doc = $doc])* $vis $key: $type,)*)?
            $($($(#[doc = $odoc])* $vis $okey: Option<$otype>,)*)?
            $($(#[doc = $ndoc])* $vis $nkey: $ntype,)?
        }

        keys! { @new $entry $($($rkey: $rtype,)*)? }

        keys! {
            $(#[doc = $about])*
            impl $entry {
                $([required] $($(#[doc = $rdoc])* $rkey: $rtype $(=> $rlimits)?,)*)?
                $([optional] $($(#[doc = $doc])* $key: $type = $default $(=> $limits)?,)*)?
                $([left out] $($(#[doc = $odoc])* $okey: $otype $(=> $olimits)?,)*)?
                $([not in the file] $nkey,)?
            }
        }
    };
    (
        $(#[doc = $about:literal])*
        impl $entry:ident {
            $([required] $($(#[doc = $rdoc:literal])* $rkey:ident: $rtype:ty $(=> $rlimits:expr)?,)*)?
            $([optional] $($(#[doc = $doc:literal])* $key:ident: $type:ty = $default:expr $(=> $limits:expr)?,)*)?
            $([left out] $($(#[doc = $odoc:literal])* $okey:ident: $otype:ty $(=> $olimits:expr)?,)*)?
            $([not in the file] $nkey:ident,)?
        }
    ) => {
        impl $crate::keys::Keys for $entry {
            const NAME: &'static str = stringify!($entry);
            const MEANING: &'static str = concat!($($about),*);

            fn blank() -> Self {
                Self {
                    $($($rkey: Default::default(),)*)?
                    $($($key: $default,)*)?
                    $($($okey: None,)*)?
                    $($nkey: Default::default(),)?
                }
            }

            fn visit<V: $crate::keys::Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
                $($(visitor.key(&keys!(@key $rkey Required ($($rdoc)*) $($rlimits)?), Some(&self.$rkey))?;)*)?
                $($(visitor.key(&keys!(@key $key Optional ($($doc)*) $($limits)?), Some(&self.$key))?;)*)?
                $($(visitor.key(&keys!(@key $okey LeftOut ($($odoc)*) $($olimits)?), self.$okey.as_ref())?;)*)?
                Ok(())
            }

            fn fill<F: $crate::keys::Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
                $($(from.key(&keys!(@key $rkey Required ($($rdoc)*)), |value| self.$rkey = value)?;)*)?
                $($(from.key(&keys!(@key $key Optional ($($doc)*)), |value| self.$key = value)?;)*)?
                $($(from.key(&keys!(@key $okey LeftOut ($($odoc)*)), |value| self.$okey = Some(value))?;)*)?
                Ok(())
            }
        }
    };
    (@key $name:ident $presence:ident ($($doc:literal)*) $($limits:expr)?) => {
        $crate::keys::Key {
            name: stringify!($name),
            presence: $crate::keys::Presence::$presence,
            limits: keys!(@limits $($limits)?),
            meaning: concat!($($doc),*),
            whose: None,
        }
    };
    (@limits) => { $crate::check::Limits::Any };
    (@limits $limits:expr) => { $limits };
    (@new $entry:ident) => {
        impl Default for $entry {
            fn default() -> Self {
                $crate::keys::Keys::blank()
            }
        }
    };
    (@new $entry:ident $($rkey:ident: $rtype:ty,)+) => {
        impl $entry {
            /// With the required values, and otherwise with the defaults of the format.
            pub fn new($($rkey: $rtype),+) -> Self {
                #[allow(clippy::needless_update, reason = "there may be required keys only")]
                Self { $($rkey,)+ ..$crate::keys::Keys::blank() }
            }
        }
    };
}
pub(crate) use keys;

/// The words of a type whose values have names in `halfway_lighting`; `N` is their number.
pub(crate) const fn named_words<T: Choices, const N: usize>() -> [(&'static str, T, &'static str); N] {
    let Choice { value, key, meaning, .. } = T::CHOICES[0];
    let mut words = [(key, value, meaning); N];
    let mut i = 1;
    while i < N {
        let Choice { value, key, meaning, .. } = T::CHOICES[i];
        words[i] = (key, value, meaning);
        i += 1;
    }
    words
}

/// Generates [`Keys`] for a type that has words only, from a table of words and values; the documentation of a word is
/// also its description in the schema.
macro_rules! words {
    ($(
        $(#[doc = $about:literal])*
        $entry:ident { $($(#[doc = $doc:literal])* $word:ident = $value:expr,)* }
    )*) => {$(
        impl $crate::keys::Keys for $entry {
            const NAME: &'static str = stringify!($entry);
            const MEANING: &'static str = concat!($($about),*);
            const WORDS: $crate::keys::Words<Self> =
                &[$((stringify!($word), $value, concat!($($doc),*)),)*];

            fn blank() -> Self {
                Self::WORDS[0].1.clone()
            }
        }

        impl $crate::keys::Object for $entry {}
    )*};
}
pub(crate) use words;

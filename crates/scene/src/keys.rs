//! Objects and words: what a type of entry is in the file, as a table from which it is read, written, described and
//! checked.

use std::convert::Infallible;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within};
use crate::entry::{Entry, Read, Written, reference};

/// What a type of entry is in the file: an object with these keys, or one of these words, or either.
///
/// The macros [`keys!`] and [`words!`] make this of tables.
pub(crate) trait Keys: Clone + PartialEq + 'static {
    /// The name of the definition in the schema.
    const NAME: &'static str;
    /// What the schema says of it.
    const MEANING: &'static str;
    /// The words, each with its value and what it means.
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[];
    /// The value of a word.
    fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, ..)| *known == word).map(|(_, value, _)| value.clone())
    }
    /// The word of this value.
    fn word(&self) -> Option<&str> {
        Self::WORDS.iter().find(|(_, value, _)| value == self).map(|(word, ..)| *word)
    }
    /// The values that are there where the file has no keys.
    fn blank() -> Self;
    /// Shows every key and its value.
    fn see<S: See>(&self, to: &mut S) -> Result<(), S::Error>;
    /// Offers every key and a place for its value.
    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error>;
}

/// An entry that has only these keys and words.
pub(crate) trait Object: Keys {
    /// Whether it has exactly one of the keys.
    const ONE_KEY: bool = false;
    /// Such an entry in a sentence; follows "expected". Left out: its words, and the examples.
    const EXPECTED: &'static str = "";
    /// Examples of objects beside words.
    const EXAMPLES: &'static [&'static str] = &[];

    /// What follows "expected".
    fn expected() -> String {
        if !Self::EXPECTED.is_empty() {
            return Self::EXPECTED.to_owned();
        }
        let words = Self::WORDS.iter().map(|(word, ..)| format!("{word:?}"));
        let mut ways: Vec<String> = words.chain(Self::EXAMPLES.iter().map(|example| (*example).to_owned())).collect();
        let last = ways.pop().unwrap_or_default();
        if ways.is_empty() { last } else { format!("{} or {last}", ways.join(", ")) }
    }

    /// The value for these given keys, or what is wrong with them, beginning with a key in backticks.
    fn with_given(self, _given: &[&str]) -> Result<Self, String> {
        Ok(self)
    }

    /// The schema.
    fn definition(definitions: &mut Map<String, Value>) -> Value {
        words_or_keys::<Self>(definitions)
    }

    /// What the limits of the keys do not say.
    fn check_whole(&self) -> Check {
        Ok(())
    }
}

/// A key of an object.
#[derive(Clone, Copy)]
pub(crate) struct Key {
    /// Its name.
    pub(crate) name: &'static str,
    /// What the file may leave out.
    pub(crate) presence: Presence,
    /// Its values.
    pub(crate) limits: Limits,
    /// What it means.
    pub(crate) meaning: &'static str,
    /// If the limits are not part of that: whose they are.
    pub(crate) whose: Option<&'static str>,
}

impl Key {
    /// One of the keys that an object has alone.
    pub(crate) const fn of_choice(name: &'static str, meaning: &'static str) -> Self {
        Self { name, presence: Presence::Required, limits: Limits::Any, meaning, whose: None }
    }
}

/// What a file may leave out.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Presence {
    /// Nothing.
    Required,
    /// The key, which then has its default.
    Optional,
    /// The key, which then has no value; it cannot be `null`.
    LeftOut,
    /// The key, which is read and not offered any more.
    Retired,
}

/// Who is shown keys and their values.
pub(crate) trait See {
    type Error;
    /// There is no value where a key is left out.
    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), Self::Error>;
}

/// Who has values for keys.
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
        self.see(&mut write)?;
        if write.count == 0 && !T::WORDS.is_empty() {
            return Err(serde::ser::Error::custom(format_args!("a scene file has no word for this {}", T::NAME)));
        }
        map.end()
    }

    fn schema(definitions: &mut Map<String, Value>, _: &Limits) -> Value {
        reference(definitions, T::NAME, T::definition)
    }

    fn check(&self, _: &Limits) -> Check {
        self.see(&mut CheckKeys)?;
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

/// Reads the keys of an object, all of which have to be there that are required, and returns them.
fn read_keys<'de, T: Keys, A: MapAccess<'de>>(
    value: &mut T,
    keys: &[Key],
    map: &mut A,
) -> Result<Vec<&'static str>, A::Error> {
    let mut given = Vec::new();
    // The path of an error ends with the key only while that is read.
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

/// Reads a key and makes something of it, or says what is wrong with it.
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

impl<M: SerializeMap> See for Write<'_, M> {
    type Error = M::Error;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), M::Error> {
        let Some(value) = value else { return Ok(()) };
        self.count += 1;
        self.map.serialize_entry(key.name, &Written(value))
    }
}

/// Checks that values are within their limits.
pub(crate) struct CheckKeys;

impl See for CheckKeys {
    type Error = KeyProblem;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Check {
        value.map_or(Ok(()), |value| value.check(&key.limits)).within(key.name)
    }
}

/// Describes the keys of an object with these defaults, and says which are required.
struct Properties<'a> {
    definitions: &'a mut Map<String, Value>,
    found: Map<String, Value>,
    required: Vec<&'static str>,
}

impl See for Properties<'_> {
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

/// Describes an object with each of the keys alone.
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
    let Ok(()) = default.see(&mut seen);
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

/// Makes a struct and its [`Keys`] of a table of keys, or, after `impl`, the keys of a struct of another crate.
///
/// A key has a type, a default and [`Limits`], and its documentation is what the schema says of it. The kinds of keys
/// stand in the order of [`Presence`]; those `[left out]` are `Option`s in the struct. After them comes a field of the
/// struct that is not in the file.
///
/// A struct without required keys has the defaults as its `Default`, another one a function `new`, which takes the
/// values of those.
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

            fn see<S: $crate::keys::See>(&self, to: &mut S) -> Result<(), S::Error> {
                $($(to.key(&keys!(@key $rkey Required ($($rdoc)*) $($rlimits)?), Some(&self.$rkey))?;)*)?
                $($(to.key(&keys!(@key $key Optional ($($doc)*) $($limits)?), Some(&self.$key))?;)*)?
                $($(to.key(&keys!(@key $okey LeftOut ($($odoc)*) $($olimits)?), self.$okey.as_ref())?;)*)?
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
            /// With these, and otherwise as a scene file has it that says no more.
            pub fn new($($rkey: $rtype),+) -> Self {
                #[allow(clippy::needless_update, reason = "there may be required keys only")]
                Self { $($rkey,)+ ..$crate::keys::Keys::blank() }
            }
        }
    };
}
pub(crate) use keys;

/// Implements [`Keys`] for a type that has only words, of a table of its values; each with its word, and what it means
/// as its documentation.
macro_rules! words {
    ($(
        $(#[doc = $about:literal])*
        $entry:ident { $($(#[doc = $doc:literal])* $word:ident = $value:expr,)* }
    )*) => {$(
        impl $crate::keys::Keys for $entry {
            const NAME: &'static str = stringify!($entry);
            const MEANING: &'static str = concat!($($about),*);
            const WORDS: &'static [(&'static str, Self, &'static str)] =
                &[$((stringify!($word), $value, concat!($($doc),*)),)*];

            fn blank() -> Self {
                Self::WORDS[0].1.clone()
            }

            fn see<S: $crate::keys::See>(&self, _to: &mut S) -> Result<(), S::Error> {
                Ok(())
            }

            fn fill<F: $crate::keys::Fill>(&mut self, _from: &mut F) -> Result<(), F::Error> {
                Ok(())
            }
        }

        impl $crate::keys::Object for $entry {}
    )*};
}
pub(crate) use words;

//! The types of values in a scene file: how each is read, written, described and checked.
//!
//! Types of other crates cannot derive serde's traits here, and derived readers accept more than the format has, such as
//! `[…]` in place of an object. So all types implement [`Entry`]; [`Read`] and [`Written`] adapt it to serde.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Bound::{Excluded, Included, Unbounded};
use std::path::PathBuf;

use bevy_math::Vec3;
use halfway_lighting::Range;
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};
use serde::ser::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within, in_range};

/// A type of value in a scene file.
pub(crate) trait Entry: Sized {
    /// Reads a value of this type.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;
    /// Writes it.
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;
    /// Its JSON schema; schemas that it refers to are added to the definitions.
    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value;
    /// Whether the format allows the value.
    fn check(&self, _limits: &Limits) -> Check {
        Ok(())
    }
}

/// A value, as serde reads it.
pub(crate) struct Read<T>(pub(crate) T);

impl<'de, T: Entry> Deserialize<'de> for Read<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::read(deserializer).map(Self)
    }
}

/// A value, as serde writes it.
pub(crate) struct Written<'a, T>(pub(crate) &'a T);

impl<T: Entry> Serialize for Written<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.write(serializer)
    }
}

/// A reference to the definition `name`, which is made if it is not there.
pub(crate) fn reference(
    definitions: &mut Map<String, Value>,
    name: &str,
    make: impl FnOnce(&mut Map<String, Value>) -> Value,
) -> Value {
    if !definitions.contains_key(name) {
        let definition = make(definitions);
        definitions.insert(name.to_owned(), definition);
    }
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// Reads and writes a type by its implementation of serde's traits.
macro_rules! as_serde_has_it {
    () => {
        fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            Self::deserialize(deserializer)
        }

        fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            self.serialize(serializer)
        }
    };
}

impl Entry for f32 {
    as_serde_has_it!();

    fn schema(_: &mut Map<String, Value>, limits: &Limits) -> Value {
        number(&limits.range())
    }

    fn check(&self, limits: &Limits) -> Check {
        in_range("", *self, limits.range())
    }
}

impl Entry for f64 {
    as_serde_has_it!();

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        let mut schema = f32::schema(definitions, limits);
        schema["format"] = json!("double");
        schema
    }

    /// Ranges are in `f32`, as everything that is drawn.
    fn check(&self, limits: &Limits) -> Check {
        (*self as f32).check(limits)
    }
}

impl Entry for u32 {
    as_serde_has_it!();

    fn schema(_: &mut Map<String, Value>, limits: &Limits) -> Value {
        match limits {
            Limits::Counts(least, most) => {
                json!({ "type": "integer", "format": "uint32", "minimum": least, "maximum": most })
            }
            Limits::OneOf([only], _) => json!({ "type": "integer", "format": "uint32", "const": only }),
            Limits::OneOf(all, _) => json!({ "type": "integer", "format": "uint32", "enum": all }),
            Limits::Any | Limits::Numbers(_) => json!({ "type": "integer", "format": "uint32", "minimum": 0 }),
        }
    }

    fn check(&self, limits: &Limits) -> Check {
        let expected = match limits {
            Limits::Counts(least, most) if !(least..=most).contains(&self) => format!("expected {least} to {most}"),
            Limits::OneOf(all, expected) if !all.contains(self) => (*expected).to_owned(),
            _ => return Ok(()),
        };
        Err(KeyProblem::new("", format!("is {self}; {expected}")))
    }
}

impl Entry for bool {
    as_serde_has_it!();

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        json!({ "type": "boolean" })
    }
}

impl Entry for String {
    as_serde_has_it!();

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        json!({ "type": "string" })
    }
}

impl Entry for PathBuf {
    as_serde_has_it!();

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        json!({ "type": "string" })
    }
}

impl Entry for Vec3 {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        <[f32; 3]>::read(deserializer).map(Self::from)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Entry::write(&self.to_array(), serializer)
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        <[f32; 3]>::schema(definitions, limits)
    }

    fn check(&self, limits: &Limits) -> Check {
        Entry::check(&self.to_array(), limits)
    }
}

/// `null` is a value.
impl<T: Entry> Entry for Option<T> {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Option::deserialize(deserializer)?.map(|Read(value)| value))
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_ref().map(Written).serialize(serializer)
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        let mut schema = T::schema(definitions, limits);
        match schema.get("type").cloned() {
            Some(Value::Array(mut names)) => {
                names.push(json!("null"));
                schema["type"] = Value::Array(names);
                schema
            }
            Some(name) => {
                schema["type"] = json!([name, "null"]);
                schema
            }
            None => json!({ "anyOf": [schema, { "type": "null" }] }),
        }
    }

    fn check(&self, limits: &Limits) -> Check {
        self.as_ref().map_or(Ok(()), |value| value.check(limits))
    }
}

impl<T: Entry> Entry for Vec<T> {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let items: Vec<Read<T>> = Vec::deserialize(deserializer)?;
        Ok(items.into_iter().map(|Read(item)| item).collect())
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(Written))
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        json!({ "type": "array", "items": T::schema(definitions, limits) })
    }

    fn check(&self, limits: &Limits) -> Check {
        self.iter().enumerate().try_for_each(|(i, item)| item.check(limits).within_item(i))
    }
}

impl<T: Entry, const N: usize> Entry for [T; N] {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ArrayVisitor(PhantomData))
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(Written))
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        list(T::schema(definitions, limits), N)
    }

    fn check(&self, limits: &Limits) -> Check {
        self.iter().enumerate().try_for_each(|(i, item)| item.check(limits).within_item(i))
    }
}

struct ArrayVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: Entry, const N: usize> Visitor<'de> for ArrayVisitor<T, N> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a list of length {N}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<[T; N], A::Error> {
        let mut items = Vec::with_capacity(N);
        while items.len() < N {
            let Some(Read(item)) = seq.next_element()? else { break };
            items.push(item);
        }
        let items = items.try_into().map_err(|items: Vec<T>| A::Error::invalid_length(items.len(), &self))?;
        seq.next_element_seed(OneTooMany(N))?;
        Ok(items)
    }
}

/// Refuses an item at its own place in the list.
struct OneTooMany(usize);

impl<'de> DeserializeSeed<'de> for OneTooMany {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, _: D) -> Result<(), D::Error> {
        Err(D::Error::custom(format_args!("is one item too many; expected a list of length {}", self.0)))
    }
}

/// The schema of a list of `count` items.
pub(crate) fn list(item: Value, count: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": count, "maxItems": count })
}

/// The schema of a number in a range.
pub(crate) fn number(range: &Range) -> Value {
    let mut limits = Map::new();
    for (bound, inclusive, exclusive) in
        [(range.least, "minimum", "exclusiveMinimum"), (range.most, "maximum", "exclusiveMaximum")]
    {
        match bound {
            Included(limit) => limits.insert(inclusive.to_owned(), json!(limit)),
            Excluded(limit) => limits.insert(exclusive.to_owned(), json!(limit)),
            Unbounded => None,
        };
    }
    let mut number = json!({ "type": "number", "format": "float" });
    match range.also {
        Some(also) => number["anyOf"] = json!([limits, { "const": also }]),
        None => number.as_object_mut().into_iter().for_each(|number| number.extend(limits.clone())),
    }
    number
}

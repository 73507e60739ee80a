//! Numbers, colors and flags of components as keys of a JSON object: read, written, checked and described by the tables
//! of `halfway_lighting`, so that a field stands there and nowhere here.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Bound::{Excluded, Included};

use halfway_lighting::{Described, Field, FieldPlace, FieldValue, Range};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, Within, in_range};
use crate::read::JsonObject;

/// What messages call the numbers of a vector.
pub(crate) const XYZ: [&str; 3] = ["x", "y", "z"];

/// A component that a scene file has as an object with its fields, and with no other keys.
pub(crate) trait ComponentObject: Described + JsonObject {
    /// The name of its definition in the schema.
    const NAME: &'static str;
    /// What the schema says of it.
    const MEANING: &'static str;
}

/// A [`ComponentObject`] as it is read, written and described.
pub(crate) struct Keys<T>(pub(crate) T);

impl<'de, T: ComponentObject> Deserialize<'de> for Keys<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(KeysVisitor(PhantomData)).map(Self)
    }
}

impl<T: ComponentObject> Serialize for Keys<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        write(&self.0, serializer)
    }
}

impl<T: ComponentObject> JsonSchema for Keys<T> {
    fn schema_name() -> Cow<'static, str> {
        T::NAME.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = object(properties(&T::default()).collect());
        schema["description"] = T::MEANING.into();
        schema.try_into().unwrap_or_default()
    }
}

struct KeysVisitor<T>(PhantomData<T>);

impl<'de, T: ComponentObject> Visitor<'de> for KeysVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
        read(map)
    }
}

/// Reads an object with the fields of a component, or `null`.
pub(crate) fn keys_or_null<'de, D: Deserializer<'de>, T: ComponentObject>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    Ok(Option::deserialize(deserializer)?.map(|Keys(component)| component))
}

/// Writes the fields of a component, or `null`.
#[allow(clippy::ref_option, reason = "serde asks for this signature")]
pub(crate) fn write_keys_or_null<T: ComponentObject, S: Serializer>(
    component: &Option<T>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    component.map(Keys).serialize(serializer)
}

/// The names of all fields.
pub(crate) fn names<T: Described>() -> impl Iterator<Item = &'static str> {
    T::FIELDS.iter().map(|field| field.name)
}

/// Reads the next key, which has to be a `known` one that is not among those `given` so far.
pub(crate) fn next_key<'de, A: MapAccess<'de>>(
    map: &mut A,
    known: &[&'static str],
    given: &mut Vec<&'static str>,
) -> Result<Option<&'static str>, A::Error> {
    // The parser knows the place of the key only while it reads it.
    map.next_key_seed(Key { known, given })
}

/// Reads the value of the field `name` into a component; false if there is no such field.
pub(crate) fn read_field<'de, T: Described, A: MapAccess<'de>>(
    component: &mut T,
    name: &str,
    map: &mut A,
) -> Result<bool, A::Error> {
    let Some(field) = T::FIELDS.iter().find(|field| field.name == name) else { return Ok(false) };
    let value = match field.place {
        FieldPlace::Number(_) => FieldValue::Number(map.next_value()?),
        FieldPlace::Optional(_) => FieldValue::Optional(map.next_value()?),
        FieldPlace::Three(..) => FieldValue::Three(map.next_value()?),
        FieldPlace::Flag(_) => FieldValue::Flag(map.next_value()?),
    };
    field.set(component, value);
    Ok(true)
}

/// Reads the fields of a component; those that are left out have their defaults.
pub(crate) fn read<'de, T: Described, A: MapAccess<'de>>(mut map: A) -> Result<T, A::Error> {
    let (known, mut given): (Vec<_>, _) = (names::<T>().collect(), Vec::new());
    let mut component = T::default();
    while let Some(name) = next_key(&mut map, &known, &mut given)? {
        read_field(&mut component, name, &mut map)?;
    }
    Ok(component)
}

/// Writes the fields of a component that `has` names.
pub(crate) fn write_fields<T: Described, M: SerializeMap>(
    component: &T,
    has: impl Fn(&str) -> bool,
    map: &mut M,
) -> Result<(), M::Error> {
    let fields = T::FIELDS.iter().filter(|field| has(field.name));
    fields.into_iter().try_for_each(|field| map.serialize_entry(field.name, &Written(field.value(component))))
}

/// Writes every field of a component.
pub(crate) fn write<T: Described, S: Serializer>(component: &T, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(T::FIELDS.len()))?;
    write_fields(component, |_| true, &mut map)?;
    map.end()
}

/// Checks every field of a component against its range.
pub(crate) fn check<T: Described>(component: &T) -> Check {
    for field in T::FIELDS {
        for (index, number) in field.numbers(component) {
            let found = in_range("", number, field.range);
            match index {
                None => found.within(field.name),
                Some(i) => found.within_item(field.name, i),
            }?;
        }
    }
    Ok(())
}

/// The schema of an object with these properties and no others.
pub(crate) fn object(properties: Map<String, Value>) -> Value {
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// What the schema says of each field of a component that has these defaults.
pub(crate) fn properties<T: Described>(default: &T) -> impl Iterator<Item = (String, Value)> {
    T::FIELDS.iter().map(move |field| (field.name.to_owned(), property(field, default)))
}

fn property<T: Described>(field: &Field<T>, default: &T) -> Value {
    let Field { meaning, range, .. } = field;
    let (mut property, whose, end) = match field.place {
        FieldPlace::Number(_) => (number(range), "Expected", "."),
        FieldPlace::Optional(_) => {
            let mut number = number(range);
            number["type"] = json!(["number", "null"]);
            (number, "Expected", ", or null.")
        }
        FieldPlace::Three(_, ["red", ..]) => (list(number(range), 3), "Each channel", "."),
        FieldPlace::Three(..) => (list(number(range), 3), "Each", "."),
        FieldPlace::Flag(_) => (json!({ "type": "boolean" }), "Expected", "."),
    };
    // That a number is finite goes without saying.
    let words = if *range == Range::FINITE { String::new() } else { format!(" {whose}: {}{end}", range.expected) };
    property["description"] = format!("{meaning}{words}").into();
    property["default"] = json!(Written(field.value(default)));
    property
}

/// A list of `count` items.
pub(crate) fn list(item: Value, count: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": count, "maxItems": count })
}

/// A number in a range.
pub(crate) fn number(range: &Range) -> Value {
    let mut limits = Map::new();
    for (bound, inclusive, exclusive) in
        [(range.least, "minimum", "exclusiveMinimum"), (range.most, "maximum", "exclusiveMaximum")]
    {
        match bound {
            Included(limit) => limits.insert(inclusive.to_owned(), json!(limit)),
            Excluded(limit) => limits.insert(exclusive.to_owned(), json!(limit)),
            std::ops::Bound::Unbounded => None,
        };
    }
    let mut number = json!({ "type": "number", "format": "float" });
    match range.also {
        Some(also) => number["anyOf"] = json!([limits, { "const": also }]),
        None => number.as_object_mut().into_iter().for_each(|number| number.extend(limits.clone())),
    }
    number
}

/// A value as it is written.
struct Written(FieldValue);

impl Serialize for Written {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            FieldValue::Number(number) => number.serialize(serializer),
            FieldValue::Optional(number) => number.serialize(serializer),
            FieldValue::Three(numbers) => numbers.serialize(serializer),
            FieldValue::Flag(flag) => flag.serialize(serializer),
        }
    }
}

/// Reads one of the known keys.
struct Key<'a> {
    known: &'a [&'static str],
    given: &'a mut Vec<&'static str>,
}

impl<'de> DeserializeSeed<'de> for Key<'_> {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'static str, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Key<'_> {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<&'static str, E> {
        let Some(known) = self.known.iter().find(|known| **known == name) else {
            let known: Vec<String> = self.known.iter().map(|known| format!("`{known}`")).collect();
            // As `serde` says it.
            let expected = if known.len() < 3 { known.join(" or ") } else { format!("one of {}", known.join(", ")) };
            return Err(E::custom(format_args!("unknown field `{name}`, expected {expected}")));
        };
        if self.given.contains(known) {
            return Err(E::duplicate_field(known));
        }
        self.given.push(known);
        Ok(known)
    }
}

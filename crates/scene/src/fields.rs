//! Components of numbers and colors as JSON objects: read, written, checked and described by the tables of
//! `halfway_lighting`, so that a field stands there and nowhere here.

use std::fmt;
use std::marker::PhantomData;

use bevy_color::LinearRgba;
use halfway_lighting::{Described, Field, FieldNumbers, FieldPlace, Range};
use schemars::Schema;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, Within, color, in_range};

/// Reads the fields of a component; those that are left out have their defaults.
pub(crate) fn read<'de, T: Described, A: MapAccess<'de>>(mut map: A) -> Result<T, A::Error> {
    let mut component = T::default();
    let mut given = Vec::new();
    while let Some(Key(field)) = map.next_key::<Key<T>>()? {
        if given.contains(&field.name) {
            return Err(A::Error::duplicate_field(field.name));
        }
        given.push(field.name);
        match field.place {
            FieldPlace::Number(place) => *place(&mut component) = map.next_value()?,
            FieldPlace::Color(place) => {
                let [red, green, blue] = map.next_value()?;
                *place(&mut component) = LinearRgba::rgb(red, green, blue);
            }
        }
    }
    Ok(component)
}

/// Writes every field of a component.
pub(crate) fn write<T: Described, S: Serializer>(component: &T, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(T::FIELDS.len()))?;
    for field in T::FIELDS {
        match field.numbers(component) {
            FieldNumbers::One(number) => map.serialize_entry(field.name, &number)?,
            FieldNumbers::Three(rgb) => map.serialize_entry(field.name, &rgb)?,
        }
    }
    map.end()
}

/// Checks every field of a component against its range.
pub(crate) fn check<T: Described>(component: &T) -> Check {
    T::FIELDS.iter().try_for_each(|field| match field.numbers(component) {
        FieldNumbers::One(number) => in_range("", number, field.range).within(field.name),
        FieldNumbers::Three(rgb) => color(field.name, &rgb),
    })
}

/// The schema of a component's object.
pub(crate) fn schema<T: Described>() -> Schema {
    let default = T::default();
    let properties: Map<String, Value> =
        T::FIELDS.iter().map(|field| (field.name.to_owned(), property(field, &default))).collect();
    let mut schema = Schema::default();
    schema.insert("type".to_owned(), json!("object"));
    schema.insert("properties".to_owned(), properties.into());
    schema.insert("additionalProperties".to_owned(), json!(false));
    schema
}

fn property<T: Described>(field: &Field<T>, default: &T) -> Value {
    let mut number = json!({ "type": "number", "format": "float" });
    let least = if field.range == Range::Positive { "exclusiveMinimum" } else { "minimum" };
    number[least] = json!(0);
    if let Some(most) = field.range.most() {
        number["maximum"] = json!(most);
    }
    let expected = field.range.expected();
    let (description, default) = match field.numbers(default) {
        FieldNumbers::One(default) => (format!("{} Expected: {expected}.", field.meaning), json!(default)),
        FieldNumbers::Three(rgb) => (format!("{} Each channel: {expected}.", field.meaning), json!(rgb)),
    };
    let mut property = match field.place {
        FieldPlace::Number(_) => number,
        FieldPlace::Color(_) => json!({ "type": "array", "items": number, "minItems": 3, "maxItems": 3 }),
    };
    property["description"] = description.into();
    property["default"] = default;
    property
}

/// The name of a field of `T`.
struct Key<T: 'static>(&'static Field<T>);

impl<'de, T: Described> Deserialize<'de> for Key<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // The parser knows the place of the key only while it reads it.
        deserializer.deserialize_identifier(KeyVisitor(PhantomData))
    }
}

struct KeyVisitor<T>(PhantomData<T>);

impl<T: Described> Visitor<'_> for KeyVisitor<T> {
    type Value = Key<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Key<T>, E> {
        T::FIELDS.iter().find(|field| field.name == name).map(Key).ok_or_else(|| {
            let known: Vec<String> = T::FIELDS.iter().map(|field| format!("`{}`", field.name)).collect();
            E::custom(format_args!("unknown field `{name}`, expected one of {}", known.join(", ")))
        })
    }
}

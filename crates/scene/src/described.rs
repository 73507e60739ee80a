//! The fields of components as keys, by the tables of `halfway_lighting`.

use halfway_lighting::{Described, Field, FieldPlace, FieldValue, Range};

use crate::check::Limits;
use crate::keys::{Fill, Key, Presence, Visit};

/// Passes every field of a component to a visitor.
pub(crate) fn visit<T: Described, V: Visit>(component: &T, visitor: &mut V) -> Result<(), V::Error> {
    T::FIELDS.iter().try_for_each(|field| match field.value(component) {
        FieldValue::Number(number) => visitor.key(&key(field), Some(&number)),
        FieldValue::Optional(number) => visitor.key(&key(field), Some(&number)),
        FieldValue::Three(numbers) => visitor.key(&key(field), Some(&numbers)),
        FieldValue::Flag(flag) => visitor.key(&key(field), Some(&flag)),
    })
}

/// Lets `from` set the fields of a component.
pub(crate) fn fill<T: Described, F: Fill>(component: &mut T, from: &mut F) -> Result<(), F::Error> {
    T::FIELDS.iter().try_for_each(|field| {
        let mut put = |value| field.set(component, value);
        match field.place {
            FieldPlace::Number(_) => from.key(&key(field), |number| put(FieldValue::Number(number))),
            FieldPlace::Optional(_) => from.key(&key(field), |number| put(FieldValue::Optional(number))),
            FieldPlace::Three(..) => from.key(&key(field), |numbers| put(FieldValue::Three(numbers))),
            FieldPlace::Flag(_) => from.key(&key(field), |flag| put(FieldValue::Flag(flag))),
        }
    })
}

fn key<T: Described>(field: &Field<T>) -> Key {
    let whose = match field.place {
        // That a number is finite goes without saying.
        _ if field.range == Range::FINITE => None,
        FieldPlace::Flag(_) => None,
        FieldPlace::Number(_) | FieldPlace::Optional(_) => Some("Expected"),
        FieldPlace::Three(_, ["red", ..]) => Some("Each channel"),
        FieldPlace::Three(..) => Some("Each"),
    };
    let limits = Limits::Numbers(field.range);
    Key { name: field.name, presence: Presence::Optional, limits, meaning: field.meaning, whose }
}

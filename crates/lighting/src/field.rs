//! The fields of a component as a table: what each means and which values it takes, written once.
//!
//! `validate()` runs over the table, and so do the readers and writers of files and the schema that describes them.

use crate::LinearRgba;

use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// One field of a component.
#[derive(Debug)]
pub struct Field<T> {
    /// Its name in Rust and in scene files.
    pub name: &'static str,
    /// Its meaning in few words, without its range.
    pub meaning: &'static str,
    /// The range of the number, or of each of the three.
    pub range: Range,
    /// Its location in the component.
    pub place: FieldPlace<T>,
}

/// The location of a [`Field`] in its component, by its type.
#[derive(Debug)]
pub enum FieldPlace<T> {
    /// A number.
    Number(fn(&mut T) -> &mut f32),
    /// A number or nothing.
    Optional(fn(&mut T) -> &mut Option<f32>),
    /// Three numbers with what each is called in messages: the channels of a color, or a vector.
    Three(fn(&mut T) -> [&mut f32; 3], [&'static str; 3]),
    /// Yes or no; it has no range.
    Flag(fn(&mut T) -> &mut bool),
}

/// The value of a [`Field`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldValue {
    /// A number.
    Number(f32),
    /// A number or nothing.
    Optional(Option<f32>),
    /// Three numbers; of a color: red, green, blue.
    Three([f32; 3]),
    /// Yes or no.
    Flag(bool),
}

/// A component with a table of those fields that are numbers, colors and flags.
pub trait Described: Copy + Default + 'static {
    /// The fields, in the order of the struct.
    const FIELDS: &'static [Field<Self>];
}

/// The channels of a color, as [`FieldPlace::Three`] has them.
pub(crate) fn rgb(color: &mut LinearRgba) -> [&mut f32; 3] {
    [&mut color.red, &mut color.green, &mut color.blue]
}

impl<T: Copy> Field<T> {
    /// A field.
    pub const fn new(name: &'static str, range: Range, meaning: &'static str, place: FieldPlace<T>) -> Self {
        Self { name, meaning, range, place }
    }

    /// A number.
    pub const fn number(
        name: &'static str,
        range: Range,
        meaning: &'static str,
        place: fn(&mut T) -> &mut f32,
    ) -> Self {
        Self::new(name, range, meaning, FieldPlace::Number(place))
    }

    /// A color; its alpha is ignored.
    pub const fn color(name: &'static str, meaning: &'static str, place: fn(&mut T) -> [&mut f32; 3]) -> Self {
        Self::new(name, Range::CHANNEL, meaning, FieldPlace::Three(place, ["red", "green", "blue"]))
    }

    /// The value in a component.
    pub fn value(&self, of: &T) -> FieldValue {
        // The table has one way into the component, which may write.
        let mut copy = *of;
        match self.place {
            FieldPlace::Number(place) => FieldValue::Number(*place(&mut copy)),
            FieldPlace::Optional(place) => FieldValue::Optional(*place(&mut copy)),
            FieldPlace::Three(place, _) => FieldValue::Three(place(&mut copy).map(|number| *number)),
            FieldPlace::Flag(place) => FieldValue::Flag(*place(&mut copy)),
        }
    }

    /// Puts a value into a component. One of another type is left.
    pub fn set(&self, of: &mut T, value: FieldValue) {
        match (&self.place, value) {
            (FieldPlace::Number(place), FieldValue::Number(number)) => *place(of) = number,
            (FieldPlace::Optional(place), FieldValue::Optional(number)) => *place(of) = number,
            (FieldPlace::Flag(place), FieldValue::Flag(flag)) => *place(of) = flag,
            (FieldPlace::Three(place, _), FieldValue::Three(numbers)) => {
                place(of).into_iter().zip(numbers).for_each(|(place, number)| *place = number);
            }
            _ => {}
        }
    }

    /// Its numbers, each with its index where there are three.
    pub fn numbers(&self, of: &T) -> impl Iterator<Item = (Option<usize>, f32)> {
        let (alone, three) = match self.value(of) {
            FieldValue::Number(number) => (Some(number), None),
            FieldValue::Optional(number) => (number, None),
            FieldValue::Three(numbers) => (None, Some(numbers)),
            FieldValue::Flag(_) => (None, None),
        };
        let three = three.into_iter().flatten().enumerate().map(|(i, number)| (Some(i), number));
        alone.map(|number| (None, number)).into_iter().chain(three)
    }
}

/// Expects every field to be in its range.
pub(crate) fn validate<T: Described>(component: &T, fields: Fields) -> Result<(), InvalidValue> {
    for field in T::FIELDS {
        for (index, value) in field.numbers(component) {
            if field.range.contains(value) {
                continue;
            }
            let part = match (index, &field.place) {
                (Some(i), FieldPlace::Three(_, names)) => format!(".{}", names[i]),
                _ => String::new(),
            };
            fields.within(&format!("{}{part}", field.name), value, field.range)?;
        }
    }
    Ok(())
}

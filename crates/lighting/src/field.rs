//! The fields of a component as a table: what each means and which values it takes, written once.
//!
//! `validate()` runs over the table, and so do the readers and writers of files and the schema that describes them.

use bevy_color::{ColorToComponents, LinearRgba};

use crate::invalid::{CHANNEL_MAX, Fields, InvalidValue};

/// The numbers that a field takes. NaN is in none of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Range {
    /// Finite, 0 or more.
    NonNegative,
    /// Finite, above 0.
    Positive,
    /// 0 to 1.
    Unit,
    /// A channel of a color: 0 to [`CHANNEL_MAX`].
    Channel,
}

impl Range {
    /// Whether the number is in the range.
    pub fn contains(self, value: f32) -> bool {
        match self {
            Self::NonNegative => value >= 0.0 && value.is_finite(),
            Self::Positive => value > 0.0 && value.is_finite(),
            Self::Unit => (0.0..=1.0).contains(&value),
            Self::Channel => (0.0..=CHANNEL_MAX).contains(&value),
        }
    }

    /// The range in words that follow "expected".
    pub const fn expected(self) -> &'static str {
        match self {
            Self::NonNegative => "a finite number, 0 or more",
            Self::Positive => "a finite number above 0",
            Self::Unit => "a number from 0 to 1",
            Self::Channel => "a number from 0 to 1e12",
        }
    }

    /// The largest number of the range, where it is not that of `f32`. The least is 0 in all of them.
    pub const fn most(self) -> Option<f32> {
        match self {
            Self::NonNegative | Self::Positive => None,
            Self::Unit => Some(1.0),
            Self::Channel => Some(CHANNEL_MAX),
        }
    }
}

/// One field of a component.
#[derive(Debug)]
pub struct Field<T> {
    /// Its name in Rust and in scene files.
    pub name: &'static str,
    /// What it means, in few words; its range is not part of them.
    pub meaning: &'static str,
    /// The range of the number, or of each channel of the color.
    pub range: Range,
    /// Where it is in the component.
    pub place: FieldPlace<T>,
}

/// Where a [`Field`] is in its component, by its type.
#[derive(Debug)]
pub enum FieldPlace<T> {
    /// A number.
    Number(fn(&mut T) -> &mut f32),
    /// A color; its alpha is ignored.
    Color(fn(&mut T) -> &mut LinearRgba),
}

/// A component whose fields are all numbers and colors.
pub trait Described: Copy + Default + 'static {
    /// All fields, in the order of the struct.
    const FIELDS: &'static [Field<Self>];
}

impl<T: Copy> Field<T> {
    /// A number.
    pub const fn number(
        name: &'static str,
        range: Range,
        meaning: &'static str,
        place: fn(&mut T) -> &mut f32,
    ) -> Self {
        Self { name, meaning, range, place: FieldPlace::Number(place) }
    }

    /// A color.
    pub const fn color(name: &'static str, meaning: &'static str, place: fn(&mut T) -> &mut LinearRgba) -> Self {
        Self { name, meaning, range: Range::Channel, place: FieldPlace::Color(place) }
    }

    /// The number, or the three channels of the color.
    pub fn numbers(&self, of: &T) -> FieldNumbers {
        // The table has one way into the component, which may write.
        let mut copy = *of;
        match self.place {
            FieldPlace::Number(place) => FieldNumbers::One(*place(&mut copy)),
            FieldPlace::Color(place) => FieldNumbers::Three(place(&mut copy).to_f32_array_no_alpha()),
        }
    }

    /// Expects the field to be in its range.
    pub(crate) fn validate(&self, of: &T, fields: Fields) -> Result<(), InvalidValue> {
        match self.numbers(of) {
            FieldNumbers::One(value) => fields.within(self.name, value, self.range),
            FieldNumbers::Three(rgb) => fields.channels(self.name, rgb),
        }
    }
}

/// The value of a [`Field`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldNumbers {
    /// A number.
    One(f32),
    /// The channels of a color: red, green, blue.
    Three([f32; 3]),
}

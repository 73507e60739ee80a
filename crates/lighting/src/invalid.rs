//! Refused values, and their messages.

use crate::LinearRgba;
use thiserror::Error;

use crate::frequency::Frequency;
use crate::range::Range;

/// A value that cannot be used: whose it is, which field, and what is wrong with it.
///
/// The message reads `Material.shininess: the value is -1.0; expected a finite number, 0 or more`.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{owner}.{field}: {problem}")]
pub struct InvalidValue {
    /// The type that holds the value, e.g. `PointLight`.
    pub owner: &'static str,
    /// The path to the value inside that type, e.g. `attenuation.linear`.
    pub field: String,
    /// The fault, with the value and the expected range.
    pub problem: Problem,
}

/// The fault of an [`InvalidValue`].
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Problem {
    /// A number that is not finite or lies outside its range.
    #[error("the value is {value:?}; expected {expected}")]
    Number {
        /// The value as it was given.
        value: f32,
        /// The values that are accepted, in words.
        expected: &'static str,
    },
    /// An attenuation without a single positive constant, which would divide by zero.
    #[error("constant, linear and quadratic are all 0; at least one must be positive")]
    NoAttenuation,
    /// An inner cone that is wider than the cone it lies in.
    #[error("the inner cone of {inner:?} rad is wider than the cutoff of {cutoff:?} rad; expected 0 to the cutoff")]
    InnerOutsideCutoff {
        /// The inner angle in radians.
        inner: f32,
        /// The cutoff in radians.
        cutoff: f32,
    },
    /// A direction of length 0, or one that is not finite.
    #[error("the direction is {value:?}; expected a finite vector that is not 0")]
    NoDirection {
        /// The vector as it was given or computed.
        value: [f32; 3],
    },
    /// A position that is not finite.
    #[error("the position is {value:?}; expected finite coordinates")]
    NoPosition {
        /// The position as it was given or computed.
        value: [f32; 3],
    },
    /// A term that is evaluated once a triangle, beside one that is evaluated at the vertices or fragments.
    #[error("the term is evaluated once a triangle and the other at {other:?}; expected Triangle or Never for both")]
    TriangleBeside {
        /// The frequency of the other term.
        other: Frequency,
    },
    /// A homogeneous position that is neither a point nor a direction.
    #[error("the homogeneous position is {value:?}; expected finite coordinates, not all 0, with a finite xyz/w")]
    NotHomogeneous {
        /// The vector as it was given.
        value: [f32; 4],
    },
}

/// The fields of one value under validation: names the owner and the path in every error.
#[derive(Clone, Copy, Debug)]
pub struct Fields {
    /// The type that holds the value.
    pub owner: &'static str,
    /// The prefix of a field's name: empty, or the path to an inner struct with its dot.
    pub prefix: &'static str,
}

impl Fields {
    /// The fields of a value of the type `owner`.
    pub const fn for_owner(owner: &'static str) -> Self {
        Self { owner, prefix: "" }
    }

    /// The fields of an inner struct; `prefix` is the path to it with its dot.
    #[must_use]
    pub const fn inside(self, prefix: &'static str) -> Self {
        Self { prefix, ..self }
    }

    /// The error of one field.
    pub fn error(self, field: &str, problem: Problem) -> InvalidValue {
        InvalidValue { owner: self.owner, field: format!("{}{field}", self.prefix), problem }
    }

    /// `Err` unless `holds`; NaN fails every comparison and so needs no case of its own.
    ///
    /// # Errors
    /// `holds` is false.
    pub fn number(self, field: &str, value: f32, holds: bool, expected: &'static str) -> Result<(), InvalidValue> {
        if holds { Ok(()) } else { Err(self.error(field, Problem::Number { value, expected })) }
    }

    /// Expects a number in `range`.
    ///
    /// # Errors
    /// It is outside.
    pub fn within(self, field: &str, value: f32, range: Range) -> Result<(), InvalidValue> {
        self.number(field, value, range.contains(value), range.expected)
    }

    /// Expects a finite number, 0 or more.
    ///
    /// # Errors
    /// The value is not so.
    pub fn non_negative(self, field: &str, value: f32) -> Result<(), InvalidValue> {
        self.within(field, value, Range::NON_NEGATIVE)
    }

    /// Expects a finite number above 0.
    ///
    /// # Errors
    /// The value is not so.
    pub fn positive(self, field: &str, value: f32) -> Result<(), InvalidValue> {
        self.within(field, value, Range::POSITIVE)
    }

    /// Expects a number from 0 to 1.
    ///
    /// # Errors
    /// The value is not so.
    pub fn unit_interval(self, field: &str, value: f32) -> Result<(), InvalidValue> {
        self.within(field, value, Range::UNIT)
    }

    /// Expects three channels of a color, each 0 to [`CHANNEL_MAX`](crate::CHANNEL_MAX).
    ///
    /// # Errors
    /// The value is not so.
    pub fn channels(self, field: &str, rgb: [f32; 3]) -> Result<(), InvalidValue> {
        for (name, value) in ["red", "green", "blue"].into_iter().zip(rgb) {
            if !Range::CHANNEL.contains(value) {
                self.within(&format!("{field}.{name}"), value, Range::CHANNEL)?;
            }
        }
        Ok(())
    }

    /// Expects a color whose channels are 0 to [`CHANNEL_MAX`](crate::CHANNEL_MAX); its alpha is ignored.
    ///
    /// # Errors
    /// The value is not so.
    pub fn color(self, field: &str, color: LinearRgba) -> Result<(), InvalidValue> {
        self.channels(field, [color.red, color.green, color.blue])
    }
}

//! The keys of a scene file for lines, points and what explains a scene.

use std::fmt;

use bevy_color::{ColorToComponents as _, LinearRgba};
use halfway_lighting::{HiddenEdges, LineStyle, Range, Show, Width};
use serde::de::{Deserializer, Error, SeqAccess, Unexpected, Visitor};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, Limits, in_range};
use crate::entry::{Entry, number};
use crate::keys::{Object, keys};

keys! {
    /// `line_style`: the looks of a model's lines and points, over the picture.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LineStyleEntry {
        [optional]
        /// The width of lines, above 0: pixels, or world units as in "0.01w".
        line_width: Width = LineStyle::DEFAULT.line_width => Limits::Numbers(Range::POSITIVE),
        /// The diameter of points, above 0: pixels, or world units as in "0.01w".
        point_size: Width = LineStyle::DEFAULT.point_size => Limits::Numbers(Range::POSITIVE),
        /// The color of all of them, linear RGB, unlit. 0 to 1e12. null: the model's own.
        color: Option<[f32; 3]> = None => Limits::Numbers(Range::CHANNEL),
        /// The parts of lines that lie behind surfaces.
        hidden: HiddenEdges = LineStyle::DEFAULT.hidden,
    }
}

impl Object for LineStyleEntry {
    const EXPECTED: &'static str = "an object such as {\"point_size\": 6}";
}

impl LineStyleEntry {
    /// As a component.
    pub(crate) fn component(&self) -> LineStyle {
        let Self { line_width, point_size, color, hidden } = *self;
        LineStyle { line_width, point_size, color: color.map(LinearRgba::from_f32_array_no_alpha), hidden }
    }
}

impl From<LineStyle> for LineStyleEntry {
    fn from(LineStyle { line_width, point_size, color, hidden }: LineStyle) -> Self {
        Self { line_width, point_size, color: color.map(LinearRgba::to_f32_array_no_alpha), hidden }
    }
}

/// A number of pixels, or a text with a number of world units.
impl Entry for Width {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WidthVisitor)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Pixels(width) => serializer.serialize_f32(*width),
            Self::World(_) => serializer.collect_str(self),
        }
    }

    fn schema(_: &mut Map<String, Value>, limits: &Limits) -> Value {
        let in_world = json!({ "type": "string", "pattern": "^[0-9.eE+-]+w$" });
        json!({ "anyOf": [number(&limits.range()), in_world] })
    }

    fn check(&self, limits: &Limits) -> Check {
        in_range("", self.value(), limits.range())
    }
}

struct WidthVisitor;

impl Visitor<'_> for WidthVisitor {
    type Value = Width;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number of pixels, or world units such as \"0.01w\"")
    }

    fn visit_f64<E: Error>(self, pixels: f64) -> Result<Width, E> {
        Ok(Width::Pixels(pixels as f32))
    }

    fn visit_u64<E: Error>(self, pixels: u64) -> Result<Width, E> {
        Ok(Width::Pixels(pixels as f32))
    }

    fn visit_i64<E: Error>(self, pixels: i64) -> Result<Width, E> {
        Ok(Width::Pixels(pixels as f32))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Width, E> {
        text.parse()
            .ok()
            .filter(|width| matches!(width, Width::World(_)))
            .ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

/// The names of what is shown, as a list.
impl Entry for Show {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ShowVisitor)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut show = *self;
        serializer.collect_seq(Self::NAMES.into_iter().filter(|name| show.named(name).is_some_and(|shown| *shown)))
    }

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        json!({ "type": "array", "items": { "type": "string", "enum": Self::NAMES } })
    }
}

struct ShowVisitor;

impl<'de> Visitor<'de> for ShowVisitor {
    type Value = Show;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of names, such as [\"axes\", \"grid\"]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Show, A::Error> {
        let mut show = Show::default();
        while let Some(name) = names.next_element::<String>()? {
            let Some(shown) = show.named(&name) else {
                let known = Show::NAMES.join(", ");
                return Err(A::Error::custom(format_args!("unknown name `{name}`, expected one of {known}")));
            };
            *shown = true;
        }
        Ok(show)
    }
}

//! Tracks of key frames: how a key of an entry changes in time.

use std::ops::Bound::Excluded;

use bevy_math::{DQuat, DVec4};
use halfway_lighting::Range;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within, in_range, unit_rotation};
use crate::entry::{Entry, Written, number};
use crate::keys::{Keys, Object, keys, words};

/// The range of a vertical field of view.
pub(crate) const FIELD_OF_VIEW: Range = Range::new(Excluded(0.0), Excluded(180.0), "degrees above 0 and below 180");

keys! {
    /// How one key of a camera, a light or an object changes in time.
    #[derive(Clone, Debug, PartialEq)]
    pub struct TrackEntry {
        [required]
        /// The key that changes.
        of: AnimatedKey,
        /// A list of pairs `[time, value]`: the time in seconds, 0 or more, each later than the one before; the value as
        /// the key has it. Before the first pair and after the last one the key has their values.
        keys: Vec<KeyFrame>,
        [optional]
        /// How the value gets from a pair to the next.
        interpolation: Interpolation = Interpolation::default(),
        /// Whether it begins again, from time 0, after the last pair.
        repeat: bool = false,
    }
}

/// A value at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyFrame {
    /// In seconds, 0 or more.
    pub time: f32,
    /// The numbers of the key's value.
    pub value: Vec<f64>,
}

/// The keys that change: `translation`, `rotation` and `scale` of an object's transform, and keys of the same names of
/// cameras and lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnimatedKey {
    /// Of an object's transform.
    #[default]
    Translation,
    /// Of an object's transform: quaternions, between which it turns by the shorter way, at an even speed.
    Rotation,
    /// Of an object's transform.
    Scale,
    /// Of a camera or a light.
    Position,
    /// Of a camera.
    Target,
    /// Of a camera.
    Up,
    /// Of a perspective camera.
    FovYDeg,
    /// Of an orthographic camera.
    Height,
    /// Of a light.
    Direction,
    /// Of a light.
    Ambient,
    /// Of a light.
    Diffuse,
    /// Of a light.
    Specular,
    /// Of a hemisphere.
    Sky,
    /// Of a hemisphere.
    Ground,
}

/// How a value gets from a key frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// In proportion to the time.
    #[default]
    Linear,
    /// Not at all: it stays until the next one.
    Step,
}

words! {
    /// The key that changes.
    AnimatedKey {
        /// Of an object's transform.
        translation = Self::Translation,
        /// Of an object's transform: quaternions, between which it turns by the shorter way, at an even speed.
        rotation = Self::Rotation,
        /// Of an object's transform.
        scale = Self::Scale,
        /// Of a camera or a light.
        position = Self::Position,
        /// Of a camera.
        target = Self::Target,
        /// Of a camera.
        up = Self::Up,
        /// Of a perspective camera: one number.
        fov_y_deg = Self::FovYDeg,
        /// Of an orthographic camera: one number.
        height = Self::Height,
        /// Of a light.
        direction = Self::Direction,
        /// Of a light.
        ambient = Self::Ambient,
        /// Of a light.
        diffuse = Self::Diffuse,
        /// Of a light.
        specular = Self::Specular,
        /// Of a hemisphere.
        sky = Self::Sky,
        /// Of a hemisphere.
        ground = Self::Ground,
    }

    /// How a value gets from a pair to the next.
    Interpolation {
        /// In proportion to the time.
        linear = Self::Linear,
        /// Not at all: it stays until the next pair.
        step = Self::Step,
    }
}

impl AnimatedKey {
    pub(crate) fn name(self) -> &'static str {
        Self::WORDS[self as usize].0
    }

    /// How many numbers its value has; of a position in a homogeneous light, which has a fourth, one less.
    pub(crate) fn count(self) -> usize {
        match self {
            Self::Rotation => 4,
            Self::FovYDeg | Self::Height => 1,
            _ => 3,
        }
    }

    /// The range of each of its numbers.
    fn range(self) -> Range {
        match self {
            Self::FovYDeg => FIELD_OF_VIEW,
            Self::Height => Range::POSITIVE,
            Self::Ambient | Self::Diffuse | Self::Specular | Self::Sky | Self::Ground => Range::CHANNEL,
            _ => Range::FINITE,
        }
    }

    /// Whether its value is a direction, or a quaternion.
    fn is_no_zero(self) -> bool {
        matches!(self, Self::Up | Self::Direction)
    }
}

impl Entry for KeyFrame {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let numbers = |value: &Value| match value {
            Value::Array(list) => list.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>(),
            one => one.as_f64().map(|one| vec![one]),
        };
        let pair = value.as_array().and_then(|pair| match pair.as_slice() {
            [time, value] => Some(Self { time: single(time)?, value: numbers(value)? }),
            _ => None,
        });
        pair.ok_or_else(|| {
            D::Error::custom(format_args!("is {value}; expected [time, value], such as [0.5, [1, 0, 0]]"))
        })
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeSeq;
        let mut pair = serializer.serialize_seq(Some(2))?;
        pair.serialize_element(&self.time)?;
        match self.value.as_slice() {
            [one] => pair.serialize_element(one)?,
            _ => pair.serialize_element(&Written(&self.value))?,
        }
        pair.end()
    }

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        let mut any = number(&Range::FINITE);
        any["format"] = json!("double");
        let value = json!({ "anyOf": [any, { "type": "array", "items": any, "minItems": 3, "maxItems": 4 }] });
        let pair = [number(&Range::NON_NEGATIVE), value];
        json!({ "type": "array", "prefixItems": pair, "items": false, "minItems": 2, "maxItems": 2 })
    }

    fn check(&self, _: &Limits) -> Check {
        in_range("[0]", self.time, Range::NON_NEGATIVE)
    }
}

/// A number of JSON; one that is too large for an `f32` is infinite, which its check refuses.
fn single(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32)
}

impl Object for TrackEntry {
    const EXPECTED: &'static str =
        "an object such as {\"of\": \"translation\", \"keys\": [[0, [0, 0, 0]], [2, [1, 0, 0]]]}";

    fn check_whole(&self) -> Check {
        if self.keys.is_empty() {
            return Err(KeyProblem::new("keys", "is empty; expected at least one pair [time, value]"));
        }
        let mut before = -1.0;
        for (i, KeyFrame { time, .. }) in self.keys.iter().enumerate() {
            if *time <= before {
                let message = format!("is {time}; expected a time after {before}, that of the pair before");
                return Err(KeyProblem::new("[0]", message)).within_item(i).within("keys");
            }
            before = *time;
        }
        Ok(())
    }
}

impl TrackEntry {
    /// Checks the values of its key, which has so many numbers.
    fn check_values(&self, count: usize) -> Check {
        for (i, KeyFrame { value, .. }) in self.keys.iter().enumerate() {
            let name = self.of.name();
            let wrong = |message: String| Err(KeyProblem::new("[1]", message)).within_item(i).within("keys");
            if value.len() != count {
                let numbers = if count == 1 { "one number".to_owned() } else { format!("{count} numbers") };
                return wrong(format!("has {} numbers; expected {numbers}, as `{name}` has", value.len()));
            }
            let range = self.of.range();
            if let Some(number) = value.iter().find(|number| !range.contains(**number as f32)) {
                return wrong(format!("has {number}; expected of `{name}` {}", range.expected));
            }
            if self.of.is_no_zero() && value.iter().all(|number| *number == 0.0) {
                return wrong("is [0, 0, 0]; expected a direction, of any length above 0".to_owned());
            }
            if let (AnimatedKey::Rotation, &[x, y, z, w]) = (self.of, value.as_slice()) {
                unit_rotation([x, y, z, w].map(|number| number as f32)).or_else(wrong)?;
            }
        }
        Ok(())
    }

    /// The value at a time in seconds: as many numbers as the key has, and zeros after them. Rotations are of unit length.
    ///
    /// ```
    /// use halfway_scene::SceneFile;
    ///
    /// let scene = SceneFile::from_json(
    ///     r#"{"objects": [{"mesh": {"box": {}}, "animation": [
    ///         {"of": "translation", "keys": [[0, [0, 0, 0]], [2, [4, 0, 0]]], "repeat": true}]}]}"#,
    ///     "moving.json",
    /// )?;
    /// let track = &scene.objects[0].animation[0];
    /// assert_eq!(track.at(0.5), [1.0, 0.0, 0.0, 0.0]);
    /// assert_eq!(track.at(2.5), track.at(0.5));
    /// # Ok::<(), halfway_scene::SceneError>(())
    /// ```
    pub fn at(&self, time: f64) -> [f64; 4] {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else { return [0.0; 4] };
        let period = f64::from(last.time);
        let time = if self.repeat && period > 0.0 { time.rem_euclid(period) } else { time };
        // The first key frame that is later.
        let next = self.keys.partition_point(|key| f64::from(key.time) <= time);
        let before = if next == 0 { first } else { &self.keys[next - 1] };
        let after = self.keys.get(next).unwrap_or(last);
        let span = f64::from(after.time) - f64::from(before.time);
        let share = match self.interpolation {
            Interpolation::Linear if span > 0.0 => ((time - f64::from(before.time)) / span).clamp(0.0, 1.0),
            Interpolation::Linear | Interpolation::Step => 0.0,
        };
        let [a, b] = [before, after].map(|key| {
            let mut four = [0.0; 4];
            four.iter_mut().zip(&key.value).for_each(|(to, from)| *to = *from);
            DVec4::from(four)
        });
        let value = if self.of == AnimatedKey::Rotation {
            let [a, b] = [a, b].map(|v| DQuat::from_vec4(v.normalize_or(DVec4::W)));
            DVec4::from(a.slerp(b, share).normalize())
        } else {
            a + (b - a) * share
        };
        value.to_array()
    }
}

/// An entry with keys that tracks can change.
pub(crate) trait Animate: Clone {
    /// How many numbers a key has; else what the entry is, and why it has no such key.
    fn count(&self, key: AnimatedKey) -> Result<usize, String>;
    /// Sets a key.
    fn set(&mut self, key: AnimatedKey, value: [f64; 4]);

    /// The entry at a time in seconds.
    fn at(&self, tracks: &[TrackEntry], time: f64) -> Self {
        let mut entry = self.clone();
        for track in tracks {
            entry.set(track.of, track.at(time));
        }
        entry
    }

    /// Checks its tracks.
    fn check_tracks(&self, tracks: &[TrackEntry]) -> Check {
        for (i, track) in tracks.iter().enumerate() {
            let count =
                self.count(track.of).map_err(|why| KeyProblem::new("of", format!("is \"{}\"; {why}", track.of.name())));
            let check = count.and_then(|count| track.check_values(count));
            check.within_item(i).within("animation")?;
            if tracks[..i].iter().any(|other| other.of == track.of) {
                let message = format!("is \"{}\", as of a track before; expected each key once", track.of.name());
                return Err(KeyProblem::new("of", message)).within_item(i).within("animation");
            }
        }
        Ok(())
    }
}

pub(crate) fn three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

pub(crate) fn single_precision<const N: usize>(numbers: [f64; N]) -> [f32; N] {
    numbers.map(|number| number as f32)
}

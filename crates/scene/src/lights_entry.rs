//! The value of `lights`: a list, or a rig by its name.

use std::borrow::Cow;
use std::fmt;

use halfway_lighting::{Choices, LightRig};
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, Limits};
use crate::defaults::rig_lights;
use crate::entry::{Entry, Read};
use crate::light::LightEntry;

/// The lights of a scene.
///
/// ```
/// use halfway_lighting::LightRig;
/// use halfway_scene::{LightsEntry, SceneFile};
///
/// let scene = SceneFile { lights: Some(LightRig::Studio.into()), ..SceneFile::for_model("part.stl") };
/// assert!(scene.to_json()?.contains("\"lights\": \"studio\""));
/// # Ok::<(), halfway_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum LightsEntry {
    /// A set of lights that follow the camera.
    Rig(LightRig),
    /// Each light by itself; an empty list: no lights.
    List(Vec<LightEntry>),
}

impl LightsEntry {
    /// The lights, one by one.
    pub fn entries(&self) -> Cow<'_, [LightEntry]> {
        match self {
            Self::Rig(rig) => Cow::Owned(rig_lights(*rig)),
            Self::List(list) => Cow::Borrowed(list),
        }
    }
}

impl From<LightRig> for LightsEntry {
    fn from(rig: LightRig) -> Self {
        Self::Rig(rig)
    }
}

impl From<Vec<LightEntry>> for LightsEntry {
    fn from(list: Vec<LightEntry>) -> Self {
        Self::List(list)
    }
}

fn rigs() -> String {
    LightRig::CHOICES.iter().map(|choice| format!("{:?}", choice.key)).collect::<Vec<_>>().join(", ")
}

impl Entry for LightsEntry {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = LightsEntry;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a list or one of {}", rigs())
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<LightsEntry, E> {
                let unknown =
                    || E::custom(format_args!("unknown value `{name}`, expected a list or one of {}", rigs()));
                LightRig::from_key(name).map(LightsEntry::Rig).ok_or_else(unknown)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<LightsEntry, A::Error> {
                let mut list = Vec::new();
                while let Some(Read(light)) = seq.next_element()? {
                    list.push(light);
                }
                Ok(LightsEntry::List(list))
            }
        }

        deserializer.deserialize_any(Either)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Rig(rig) => serializer.serialize_str(rig.choice().map_or("", |choice| choice.key)),
            Self::List(list) => Entry::write(list, serializer),
        }
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        let rig = |choice: &halfway_lighting::Choice<LightRig>| json!({ "type": "string", "const": choice.key, "description": choice.meaning });
        let mut ways: Vec<Value> = LightRig::CHOICES.iter().map(rig).collect();
        ways.push(Vec::<LightEntry>::schema(definitions, limits));
        json!({ "anyOf": ways })
    }

    fn check(&self, limits: &Limits) -> Check {
        match self {
            Self::Rig(_) => Ok(()),
            Self::List(list) => Entry::check(list, limits),
        }
    }
}

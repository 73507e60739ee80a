//! The materials of a scene file.

use std::fmt;

use bevy_color::{ColorToComponents, LinearRgba};
use halfway_lighting::{CHANNEL_MAX, Material};
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::check::{Check, Problem, colour, not_negative, test};

/// A material: a preset's name, or its values.
#[derive(Serialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(untagged)]
pub enum MaterialEntry {
    /// The name of a preset, such as `brass`. Case, spaces, `-` and `_` make no difference.
    Preset(String),
    /// The values.
    Values(MaterialValues),
}

/// The values of a material.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialValues {
    /// ka, linear RGB: reflects ambient light. 0 to 1e12, normally at most 1.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub ambient: [f32; 3],
    /// kd, linear RGB: reflects light evenly to all sides. 0 to 1e12, normally at most 1.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub diffuse: [f32; 3],
    /// ks, linear RGB: reflects light into the highlight. 0 to 1e12, normally at most 1.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub specular: [f32; 3],
    /// ke, linear RGB: shines by itself, unaffected by lights. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub emission: [f32; 3],
    /// The exponent of the highlight. 0 or more.
    #[schemars(range(min = 0))]
    pub shininess: f32,
    /// 0 (clear) to 1 (opaque); seen only where the object is blended.
    #[schemars(range(min = 0, max = 1))]
    pub opacity: f32,
}

impl Default for MaterialValues {
    fn default() -> Self {
        Self {
            ambient: [0.2; 3],
            diffuse: [0.8; 3],
            specular: [0.0; 3],
            emission: [0.0; 3],
            shininess: 32.0,
            opacity: 1.0,
        }
    }
}

impl Default for MaterialEntry {
    fn default() -> Self {
        Self::Values(MaterialValues::default())
    }
}

impl From<MaterialValues> for Material {
    fn from(values: MaterialValues) -> Self {
        Self {
            ambient: LinearRgba::from_f32_array_no_alpha(values.ambient),
            diffuse: LinearRgba::from_f32_array_no_alpha(values.diffuse),
            specular: LinearRgba::from_f32_array_no_alpha(values.specular),
            emission: LinearRgba::from_f32_array_no_alpha(values.emission),
            shininess: values.shininess,
            opacity: values.opacity,
        }
    }
}

impl MaterialEntry {
    /// The material, or `None` where there is no preset of that name.
    pub fn material(&self) -> Option<Material> {
        match self {
            Self::Preset(name) => Material::named(name),
            Self::Values(values) => Some((*values).into()),
        }
    }

    pub(crate) fn check(&self) -> Check {
        match self {
            Self::Preset(name) if Material::named(name).is_none() => {
                let known: Vec<&str> = Material::PRESETS.iter().map(|(name, _)| *name).collect();
                let known = known.join(", ");
                Err(Problem::new("", format!("no preset is named {name:?}; expected one of {known}")))
            }
            Self::Preset(_) => Ok(()),
            Self::Values(values) => values.check(),
        }
    }
}

impl MaterialValues {
    fn check(&self) -> Check {
        colour("ambient", &self.ambient)?;
        colour("diffuse", &self.diffuse)?;
        colour("specular", &self.specular)?;
        colour("emission", &self.emission)?;
        not_negative("shininess", self.shininess)?;
        test("opacity", self.opacity, (0.0..=1.0).contains(&self.opacity), "a number from 0 to 1")
    }
}

impl<'de> Deserialize<'de> for MaterialEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Shape;

        impl<'de> Visitor<'de> for Shape {
            type Value = MaterialEntry;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a preset's name or an object with the keys of a material")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<MaterialEntry, E> {
                Ok(MaterialEntry::Preset(name.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MaterialEntry, A::Error> {
                MaterialValues::deserialize(MapAccessDeserializer::new(map)).map(MaterialEntry::Values)
            }
        }

        deserializer.deserialize_any(Shape)
    }
}

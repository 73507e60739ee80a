//! The materials of a scene file.

use std::fmt;

use halfway_lighting::Material;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem};
use crate::fields;

/// A material: a preset's name, or its values.
#[derive(Serialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(untagged)]
pub enum MaterialEntry {
    /// The name of a preset, such as `brass`. Case, spaces, `-` and `_` make no difference.
    Preset(String),
    /// The values.
    #[serde(serialize_with = "fields::write")]
    Values(#[schemars(schema_with = "values_schema")] Material),
}

impl Default for MaterialEntry {
    fn default() -> Self {
        Self::Values(Material::default())
    }
}

impl MaterialEntry {
    /// The material, or `None` where there is no preset of that name.
    pub fn material(&self) -> Option<Material> {
        match self {
            Self::Preset(name) => Material::named(name),
            Self::Values(values) => Some(*values),
        }
    }

    pub(crate) fn check(&self) -> Check {
        match self {
            Self::Preset(name) if Material::named(name).is_none() => {
                let known: Vec<&str> = Material::PRESETS.iter().map(|(name, _)| *name).collect();
                let known = known.join(", ");
                Err(KeyProblem::new("", format!("no preset is named {name:?}; expected one of {known}")))
            }
            Self::Preset(_) => Ok(()),
            Self::Values(values) => fields::check(values),
        }
    }
}

fn values_schema(_: &mut SchemaGenerator) -> Schema {
    fields::object(fields::properties(&Material::default()).collect()).try_into().unwrap_or_default()
}

impl<'de> Deserialize<'de> for MaterialEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrValues;

        impl<'de> Visitor<'de> for NameOrValues {
            type Value = MaterialEntry;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a preset's name or an object with the keys of a material")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<MaterialEntry, E> {
                Ok(MaterialEntry::Preset(name.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MaterialEntry, A::Error> {
                fields::read(map).map(MaterialEntry::Values)
            }
        }

        deserializer.deserialize_any(NameOrValues)
    }
}

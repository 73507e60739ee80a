//! The materials of a scene file.

use halfway_lighting::Material;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem};
use crate::described;
use crate::keys::{Fill, Keys, Object, Visit, keys_schema};

/// A material: a preset's name, or its values.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialEntry {
    /// The name of a preset, such as `brass`. Case, spaces, `-` and `_` make no difference.
    Preset(String),
    /// The values.
    Values(Material),
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
}

impl Keys for MaterialEntry {
    const NAME: &'static str = "MaterialEntry";
    const MEANING: &'static str = "A material: a preset's name, or its values.";

    fn from_word(word: &str) -> Option<Self> {
        Some(Self::Preset(word.to_owned()))
    }

    fn word(&self) -> Option<&str> {
        match self {
            Self::Preset(name) => Some(name),
            Self::Values(_) => None,
        }
    }

    fn blank() -> Self {
        Self::Values(Material::DEFAULT)
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match self {
            Self::Preset(_) => Ok(()),
            Self::Values(values) => described::visit(values, visitor),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        match self {
            Self::Preset(_) => Ok(()),
            Self::Values(values) => described::fill(values, from),
        }
    }
}

impl Object for MaterialEntry {
    const EXPECTED: &'static str = "a preset's name or an object with the keys of a material";

    fn definition(definitions: &mut Map<String, Value>) -> Value {
        let name = "The name of a preset, such as `brass`. Case, spaces, `-` and `_` make no difference.";
        let values = keys_schema(&Self::blank(), "The values.", definitions);
        let ways = [json!({ "type": "string", "description": name }), values];
        json!({ "description": Self::MEANING, "anyOf": ways })
    }

    fn check_whole(&self) -> Check {
        if let Self::Preset(name) = self
            && Material::named(name).is_none()
        {
            let known: Vec<&str> = Material::PRESETS.iter().map(|(name, _)| *name).collect();
            let known = known.join(", ");
            return Err(KeyProblem::new("", format!("no preset is named {name:?}; expected one of {known}")));
        }
        Ok(())
    }
}

//! The objects of a scene file.

use halfway_lighting::{Faces, Reflectance, Tolerance, VertexColors};
use halfway_mesh::Normals;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within};
use crate::fields::{self, Keys, keys_or_null, write_keys_or_null};
use crate::maps::MapsEntry;
use crate::material::MaterialEntry;
use crate::mesh::MeshEntry;
use crate::read::{
    JsonObject, Spoken, given, given_word, object, object_or_null, word, word_or_null, write_word, write_word_or_null,
};
use crate::solid::SolidEntry;
use crate::transform::TransformEntry;
use crate::view::ShadingEntry;

/// A mesh somewhere in the scene, with a material.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ObjectEntry {
    /// The name that lights are attached by; no two objects have the same. null: none.
    #[serde(default)]
    pub name: Option<String>,
    /// The shape. Required.
    pub mesh: MeshEntry,
    /// How the mesh gets its normals.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Normals>")]
    pub normals: Normals,
    /// Where the mesh is in the world.
    #[serde(default, deserialize_with = "object")]
    pub transform: TransformEntry,
    /// The material; null: the model's own, or the default values where it has none.
    #[serde(default)]
    pub material: Option<MaterialEntry>,
    /// The material of back faces; null: the same as in front.
    #[serde(default)]
    pub back_material: Option<MaterialEntry>,
    /// Which sides are shown. Left out: `front`, or `both` for parts with a double-sided material of the model's own.
    #[serde(
        default,
        deserialize_with = "given_word",
        serialize_with = "write_word_or_null",
        skip_serializing_if = "Option::is_none"
    )]
    #[schemars(with = "Spoken<Faces>", default)]
    pub faces: Option<Faces>,
    /// The shading of this object; null: the scene's.
    #[serde(default, deserialize_with = "word_or_null")]
    pub shading: Option<ShadingEntry>,
    /// The tolerance of this object; null: the scene's.
    #[serde(default, deserialize_with = "keys_or_null", serialize_with = "write_keys_or_null")]
    #[schemars(with = "Option<Keys<Tolerance>>")]
    pub tolerance: Option<Tolerance>,
    /// The reflectance of this object; null: the scene's.
    #[serde(default, deserialize_with = "word_or_null", serialize_with = "write_word_or_null")]
    #[schemars(with = "Option<Spoken<Reflectance>>")]
    pub reflectance: Option<Reflectance>,
    /// What becomes of the colors at the mesh's vertices, if it has any.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<VertexColors>")]
    pub vertex_colors: VertexColors,
    /// The images on the object; null: the model's own where there is no `material`.
    #[serde(default, deserialize_with = "object_or_null")]
    pub maps: Option<MapsEntry>,
    /// What the object is cut from, whose color multiplies ambient and diffuse light; null: nothing.
    #[serde(default, deserialize_with = "object_or_null")]
    pub solid: Option<SolidEntry>,
    /// The object is not there where its opacity is below this number, 0 or more; 0 cuts nothing away. Left out: no,
    /// except for parts with a masked material of the model's own.
    #[serde(default, deserialize_with = "given", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f32", default)]
    pub mask: Option<f32>,
    /// Whether the material's opacity lets what is behind show through. Left out: no, except for parts with a blended
    /// material of the model's own.
    #[serde(default, deserialize_with = "given", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool", default)]
    pub blend: Option<bool>,
}

impl JsonObject for ObjectEntry {
    const EXPECTED: &'static str = "an object with the keys of a scene's object";
}

impl ObjectEntry {
    /// An object of this shape, and otherwise as a scene file has it that says no more.
    pub fn new(mesh: MeshEntry) -> Self {
        Self {
            name: None,
            mesh,
            normals: Normals::default(),
            transform: TransformEntry::default(),
            material: None,
            back_material: None,
            faces: None,
            shading: None,
            tolerance: None,
            reflectance: None,
            vertex_colors: VertexColors::default(),
            maps: None,
            solid: None,
            mask: None,
            blend: None,
        }
    }

    pub(crate) fn check(&self) -> Check {
        self.mesh.check().within("mesh")?;
        self.transform.check().within("transform")?;
        for (key, material) in [("material", &self.material), ("back_material", &self.back_material)] {
            material.as_ref().map_or(Ok(()), MaterialEntry::check).within(key)?;
        }
        self.maps.as_ref().map_or(Ok(()), MapsEntry::check).within("maps")?;
        self.solid.as_ref().map_or(Ok(()), SolidEntry::check).within("solid")?;
        if let Some(mask) = self.mask.filter(|mask| !(0.0..=f32::MAX).contains(mask)) {
            return Err(KeyProblem::new("mask", format!("is {mask:?}; expected a finite number, 0 or more")));
        }
        self.tolerance.as_ref().map_or(Ok(()), fields::check).within("tolerance")?;
        self.shading.map_or(Ok(()), ShadingEntry::check).within("shading")
    }
}

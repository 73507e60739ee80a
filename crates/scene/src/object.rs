//! The objects of a scene file.

use bevy_math::{DVec4, Mat4, Quat, Vec3};
use halfway_lighting::{Faces, Reflectance, VertexColors};
use halfway_mesh::Normals;
use schemars::JsonSchema;
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within, finite};
use crate::maps::MapsEntry;
use crate::material::MaterialEntry;
use crate::mesh::MeshEntry;
use crate::read::{
    JsonObject, Spoken, given, given_word, object, object_or_null, word, word_or_null, write_word, write_word_or_null,
};
use crate::view::{ShadingEntry, ToleranceEntry};

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
    #[serde(default, deserialize_with = "object_or_null")]
    pub tolerance: Option<ToleranceEntry>,
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
    /// The object is not there where its opacity is below this number, 0 or more; 0 cuts nothing away. Left out: no, except
    /// for parts with a masked material of the model's own.
    #[serde(default, deserialize_with = "given", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f32", default)]
    pub mask: Option<f32>,
    /// Whether the material's opacity lets what is behind show through. Left out: no, except for parts with a blended
    /// material of the model's own.
    #[serde(default, deserialize_with = "given", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool", default)]
    pub blend: Option<bool>,
}

/// Where something is: in parts, or as a matrix.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(untagged)]
pub enum TransformEntry {
    /// Scaled, then turned, then moved.
    Parts(TransformParts),
    /// By a matrix.
    Matrix(TransformMatrix),
}

/// A transform in parts.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct TransformParts {
    /// Moved by.
    pub translation: [f32; 3],
    /// Turned by the quaternion [x, y, z, w]. Its length is 1 within 2 %, and made exactly 1.
    pub rotation: [f32; 4],
    /// Stretched along x, y and z; negative mirrors.
    pub scale: [f32; 3],
}

/// A transform as a matrix.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TransformMatrix {
    /// 16 numbers column by column: the images of x, y and z and of the origin. The last row, numbers 4, 8, 12 and 16,
    /// is 0, 0, 0, 1.
    pub matrix: [f32; 16],
}

impl JsonObject for ObjectEntry {
    const EXPECTED: &'static str = "an object with the keys of a scene's object";
}

impl JsonObject for TransformEntry {
    const EXPECTED: &'static str = "an object with translation, rotation and scale, or with matrix";
}

impl Default for TransformParts {
    fn default() -> Self {
        Self { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
    }
}

impl Default for TransformEntry {
    fn default() -> Self {
        Self::Parts(TransformParts::default())
    }
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
        if let Some(mask) = self.mask.filter(|mask| !(0.0..=f32::MAX).contains(mask)) {
            return Err(KeyProblem::new("mask", format!("is {mask:?}; expected a finite number, 0 or more")));
        }
        self.tolerance.map_or(Ok(()), ToleranceEntry::check).within("tolerance")?;
        self.shading.map_or(Ok(()), ShadingEntry::check).within("shading")
    }
}

impl TransformEntry {
    /// How far from 1 the length of a rotation may be: that of one printed with two digits still is not.
    const ROTATION_SLACK: f64 = 0.02;

    /// The matrix that takes the object into the world.
    pub fn matrix(&self) -> Mat4 {
        match self {
            Self::Parts(TransformParts { translation, rotation, scale }) => {
                Mat4::from_scale_rotation_translation(Vec3::from(*scale), unit(*rotation), Vec3::from(*translation))
            }
            Self::Matrix(TransformMatrix { matrix }) => Mat4::from_cols_array(matrix),
        }
    }

    fn check(&self) -> Check {
        match self {
            Self::Parts(TransformParts { translation, rotation, scale }) => {
                finite("translation", translation)?;
                finite("scale", scale)?;
                finite("rotation", rotation)?;
                let length = DVec4::from(rotation.map(f64::from)).length();
                if (length - 1.0).abs() <= Self::ROTATION_SLACK {
                    return Ok(());
                }
                let message = format!("has the length {length:.3}; expected a quaternion [x, y, z, w] of length 1");
                Err(KeyProblem::new("rotation", message))
            }
            Self::Matrix(TransformMatrix { matrix }) => {
                finite("matrix", matrix)?;
                for (i, expected) in [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)] {
                    #[allow(clippy::float_cmp, reason = "anything else is a projection, however small")]
                    if matrix[i] != expected {
                        let message = format!("is {}; expected {expected}: the last row is 0, 0, 0, 1", matrix[i]);
                        return Err(KeyProblem::new("", message)).within_item("matrix", i);
                    }
                }
                Ok(())
            }
        }
    }
}

/// The rotation of exactly unit length.
pub(crate) fn unit(rotation: [f32; 4]) -> Quat {
    let [x, y, z, w] = DVec4::from(rotation.map(f64::from)).normalize_or(DVec4::W).to_array();
    Quat::from_xyzw(x as f32, y as f32, z as f32, w as f32)
}

/// The keys of both kinds of transform.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TransformKeys {
    #[serde(default, deserialize_with = "given")]
    translation: Option<[f32; 3]>,
    #[serde(default, deserialize_with = "given")]
    rotation: Option<[f32; 4]>,
    #[serde(default, deserialize_with = "given")]
    scale: Option<[f32; 3]>,
    #[serde(default, deserialize_with = "given")]
    matrix: Option<[f32; 16]>,
}

impl<'de> Deserialize<'de> for TransformEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let TransformKeys { translation, rotation, scale, matrix } = TransformKeys::deserialize(deserializer)?;
        if let Some(matrix) = matrix {
            let beside =
                [("translation", translation.is_some()), ("rotation", rotation.is_some()), ("scale", scale.is_some())];
            if let Some((key, _)) = beside.into_iter().find(|(_, present)| *present) {
                return Err(D::Error::custom(format_args!("`{key}` cannot stand beside `matrix`, which says it all")));
            }
            return Ok(Self::Matrix(TransformMatrix { matrix }));
        }
        let default = TransformParts::default();
        Ok(Self::Parts(TransformParts {
            translation: translation.unwrap_or(default.translation),
            rotation: rotation.unwrap_or(default.rotation),
            scale: scale.unwrap_or(default.scale),
        }))
    }
}

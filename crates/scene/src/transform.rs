//! Where something is, as a scene file says it.

use bevy_math::{DVec4, Mat4, Quat, Vec3};
use schemars::JsonSchema;
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within, finite};
use crate::read::{JsonObject, given};

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

    pub(crate) fn check(&self) -> Check {
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

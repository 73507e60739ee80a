//! Transforms in scene files.

use bevy_math::{DMat4, DVec3, DVec4, Mat4, Quat, Vec3};
use bevy_transform::components::Transform;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within, unit_rotation};
use crate::entry::Entry;
use crate::keys::{Fill, Key, Keys, Object, Presence, Visit, keys};
use crate::track::{Animate, AnimatedKey, single_precision, three};

/// Where something is: in parts, or as a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformEntry {
    /// Scaled, then turned, then moved.
    Parts(TransformParts),
    /// By a matrix.
    Matrix(TransformMatrix),
}

keys! {
    /// A transform in parts.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TransformParts {
        [optional]
        /// Moved by.
        translation: [f64; 3] = [0.0; 3],
        /// Turned by the quaternion [x, y, z, w]. Its length is 1 within 2 %, and made exactly 1.
        rotation: [f32; 4] = [0.0, 0.0, 0.0, 1.0],
        /// Stretched along x, y and z; negative mirrors.
        scale: [f32; 3] = [1.0; 3],
    }
}

keys! {
    /// A transform as a matrix.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TransformMatrix {
        [required]
        /// 16 numbers column by column: the images of x, y and z and of the origin. The last row, numbers 4, 8, 12 and
        /// 16, is 0, 0, 0, 1.
        matrix: [f64; 16],
    }
}

impl Object for TransformParts {
    fn check_whole(&self) -> Check {
        unit_rotation(self.rotation).map_err(|message| KeyProblem::new("rotation", message))
    }
}

impl Object for TransformMatrix {
    fn check_whole(&self) -> Check {
        for (i, expected) in [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)] {
            #[allow(clippy::float_cmp, reason = "anything else is a projection, however small")]
            if self.matrix[i] != expected {
                let message = format!("is {}; expected {expected}: the last row is 0, 0, 0, 1", self.matrix[i]);
                return Err(KeyProblem::new("", message)).within_item(i).within("matrix");
            }
        }
        Ok(())
    }
}

impl Default for TransformEntry {
    fn default() -> Self {
        Self::Parts(TransformParts::default())
    }
}

impl TransformEntry {
    /// As a component, of a transform in parts that is counted from an origin.
    pub(crate) fn parts(&self, origin: DVec3) -> Option<Transform> {
        let Self::Parts(TransformParts { translation, rotation, scale }) = self else { return None };
        let translation = (DVec3::from(*translation) - origin).as_vec3();
        Some(Transform { translation, rotation: unit(*rotation), scale: Vec3::from(*scale) })
    }

    /// The matrix that takes the object into the world: translations in `f64`, all else as `f32` has it.
    pub fn matrix(&self) -> DMat4 {
        match self {
            Self::Parts(TransformParts { translation, rotation, scale }) => {
                let turned = Mat4::from_scale_rotation_translation(Vec3::from(*scale), unit(*rotation), Vec3::ZERO);
                DMat4 { w_axis: DVec3::from(*translation).extend(1.0), ..turned.as_dmat4() }
            }
            Self::Matrix(TransformMatrix { matrix }) => {
                let matrix = DMat4::from_cols_array(matrix);
                DMat4 { w_axis: matrix.w_axis, ..matrix.as_mat4().as_dmat4() }
            }
        }
    }
}

/// The rotation of exactly unit length.
fn unit(rotation: [f32; 4]) -> Quat {
    let [x, y, z, w] = DVec4::from(rotation.map(f64::from)).normalize_or(DVec4::W).to_array();
    Quat::from_xyzw(x as f32, y as f32, z as f32, w as f32)
}

impl Keys for TransformEntry {
    const NAME: &'static str = "TransformEntry";
    const MEANING: &'static str = "Where something is: in parts, or as a matrix.";

    fn blank() -> Self {
        Self::default()
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match self {
            Self::Parts(parts) => parts.visit(visitor),
            Self::Matrix(matrix) => matrix.visit(visitor),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        let mut parts = if let Self::Parts(parts) = self { *parts } else { TransformParts::default() };
        parts.fill(from)?;
        let mut given = None;
        let key = Key { presence: Presence::Optional, ..Key::required("matrix", "") };
        from.key(&key, |matrix| given = Some(TransformMatrix { matrix }))?;
        match (given, &self) {
            (Some(matrix), _) => *self = Self::Matrix(matrix),
            (None, Self::Parts(_)) => *self = Self::Parts(parts),
            (None, Self::Matrix(_)) => {}
        }
        Ok(())
    }
}

impl Object for TransformEntry {
    const EXPECTED: &'static str = "an object with translation, rotation and scale, or with matrix";

    fn with_given(self, given: &[&str]) -> Result<Self, String> {
        match (self, given.iter().find(|key| **key != "matrix")) {
            (Self::Matrix(_), Some(key)) => Err(format!("`{key}` cannot stand beside `matrix`, which says it all")),
            _ => Ok(self),
        }
    }

    fn definition(definitions: &mut Map<String, Value>) -> Value {
        let parts = TransformParts::schema(definitions, &Limits::Any);
        let ways = [parts, TransformMatrix::schema(definitions, &Limits::Any)];
        json!({ "description": Self::MEANING, "anyOf": ways })
    }

    fn check_whole(&self) -> Check {
        match self {
            Self::Parts(parts) => parts.check_whole(),
            Self::Matrix(matrix) => matrix.check_whole(),
        }
    }
}

impl Animate for TransformEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        match (key, self) {
            (AnimatedKey::Translation | AnimatedKey::Rotation | AnimatedKey::Scale, Self::Parts(_)) => Ok(key.count()),
            (AnimatedKey::Translation | AnimatedKey::Rotation | AnimatedKey::Scale, Self::Matrix(_)) => {
                Err("the transform is a matrix; expected one with translation, rotation and scale".to_owned())
            }
            _ => Err("expected a key of an object: translation, rotation or scale".to_owned()),
        }
    }

    fn set(&mut self, key: AnimatedKey, value: [f64; 4]) {
        let Self::Parts(parts) = self else { return };
        match key {
            AnimatedKey::Translation => parts.translation = three(value),
            AnimatedKey::Rotation => parts.rotation = single_precision(value),
            AnimatedKey::Scale => parts.scale = single_precision(three(value)),
            _ => {}
        }
    }
}

//! From an entity's transform to a light's place.

use bevy_transform::components::GlobalTransform;
use glam::Vec3;

use crate::direction::direction;
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::lights::LightFrame;

/// The position of a light: the translation of its entity.
///
/// # Errors
/// A coordinate is not finite.
pub fn light_position(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    let position = transform.translation();
    if position.is_finite() {
        Ok(position)
    } else {
        let problem = Problem::NoPosition { value: position.to_array() };
        Err(Fields::for_owner("GlobalTransform").error("translation", problem))
    }
}

/// The direction in which a light shines: its entity's local −Z axis in world space, unit length.
///
/// # Errors
/// The axis has length 0 (a scale of 0 along it, here or in a parent) or is not finite.
pub fn light_direction(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    direction(-Vec3::from(transform.affine().matrix3.z_axis), "GlobalTransform", "local −Z axis")
}

/// The direction of an entity's local +Y axis in world space, unit length.
///
/// # Errors
/// The axis has length 0 (a scale of 0 along it, here or in a parent) or is not finite.
pub fn light_up(transform: &GlobalTransform) -> Result<Vec3, InvalidValue> {
    direction(Vec3::from(transform.affine().matrix3.y_axis), "GlobalTransform", "local +Y axis")
}

impl LightFrame for GlobalTransform {
    fn position(&self) -> Result<[f64; 3], InvalidValue> {
        light_position(self).map(|position| position.as_dvec3().to_array())
    }

    fn forward(&self) -> Result<[f64; 3], InvalidValue> {
        light_direction(self).map(|direction| direction.as_dvec3().to_array())
    }

    fn up(&self) -> Result<[f64; 3], InvalidValue> {
        light_up(self).map(|direction| direction.as_dvec3().to_array())
    }
}
